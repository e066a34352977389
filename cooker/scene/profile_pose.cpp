// SPDX-License-Identifier: MIT
// Poses go into files, whose bytes are the same on every machine. This code therefore uses no sine
// or cosine of a library and no sums of Eigen, whose order depends on the instruction set.
#include "cooker/scene/profile_pose.h"

#include <array>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "runtime/primitive/rounding.h"

namespace boxtree::cooker {
namespace {

// Largest deviation of a quaternion's length from 1; beyond it the value is an error.
constexpr double kQuaternionDrift = 1e-3;

struct SineCosine {
  double sine;
  double cosine;
};

// Taylor series, in radians of at most pi / 4: the first omitted term is below 2^-56 of the sum.
SineCosine of_small(double x) noexcept {
  const double square = x * x;
  double sine = 1, cosine = 1;
  for (int n = 18; n >= 2; n -= 2) {
    cosine = 1 - square / ((n - 1) * n) * cosine;
    sine = 1 - square / (n * (n + 1)) * sine;
  }
  return {x * sine, cosine};
}

// Whole quarters are subtracted exactly.
SineCosine of_degrees(double degrees) noexcept {
  constexpr double kRadiansADegree = 0x1.1df46a2529d39p-6;  // pi / 180
  int quarters = 0;
  const double rest = std::remquo(degrees, 90.0, &quarters);
  const SineCosine small = of_small(rest * kRadiansADegree);
  switch (quarters & 3) {
    case 0:
      return small;
    case 1:
      return {small.cosine, -small.sine};
    case 2:
      return {-small.sine, -small.cosine};
    default:
      return {-small.cosine, small.sine};
  }
}

// Divides a vector by its largest magnitude, so that squares neither overflow nor vanish, then by
// its length.
template <int N>
Eigen::Matrix<double, N, 1> unit(Eigen::Matrix<double, N, 1> v) noexcept {
  double largest = 0;
  for (int k = 0; k < N; ++k) largest = std::max(largest, std::abs(v[k]));
  double square = 0;
  for (int k = 0; k < N; ++k) {
    v[k] /= largest;
    square += v[k] * v[k];
  }
  const double length = std::sqrt(square);
  for (int k = 0; k < N; ++k) v[k] /= length;
  return v;
}

double length_of(const Eigen::Vector4d& v) noexcept {
  return std::sqrt((v[0] * v[0] + v[1] * v[1]) + (v[2] * v[2] + v[3] * v[3]));
}

template <int N>
Eigen::Matrix<double, N, 1> vector_of(const std::vector<double>& values) noexcept {
  Eigen::Matrix<double, N, 1> v;
  for (int k = 0; k < N; ++k) v[k] = values[static_cast<std::size_t>(k)];
  return v;
}

std::optional<Eigen::Matrix3d> read_rotation(Fields& fields) {
  fields.exclude("rotation", "axis");
  fields.exclude("rotation", "degrees");
  const auto rotation =
      fields.numbers("rotation", 4, "the four numbers x, y, z, w of a quaternion");
  const auto axis = fields.numbers("axis", 3, "three numbers");
  const auto degrees = fields.number("degrees", kAnyNumber);
  if (rotation) {
    const Eigen::Vector4d quaternion = vector_of<4>(rotation->value);
    const double length = length_of(quaternion);
    if (std::abs(length - 1) <= kQuaternionDrift) return rotation_of(quaternion);
    fields.complaints().expected(rotation->line, "rotation", "a quaternion x, y, z, w of length 1",
                                 fmt::format("one of length {:.4g}", length));
  }
  const TomlEntry* axis_entry = fields.find("axis");
  const TomlEntry* degrees_entry = fields.find("degrees");
  const bool is_one = (axis_entry == nullptr) != (degrees_entry == nullptr);
  if (is_one && !fields.is_misspelt(axis_entry == nullptr ? "axis" : "degrees")) {
    const TomlEntry& alone = axis_entry != nullptr ? *axis_entry : *degrees_entry;
    fields.complaints().expected(alone.line, alone.key, "\"axis\" and \"degrees\" together",
                                 "one of them");
  }
  if (axis && degrees) {
    const Eigen::Vector3d direction = vector_of<3>(axis->value);
    if (direction != Eigen::Vector3d::Zero()) return rotation_about(direction, degrees->value);
    fields.complaints().expected(axis->line, "axis", "a direction", "0, 0, 0");
  }
  return std::nullopt;
}

std::optional<Eigen::Vector3d> read_scale(Fields& fields) {
  const TomlEntry* entry = fields.find("scale");
  if (entry == nullptr) return std::nullopt;
  Eigen::Vector3d scale;
  if (std::holds_alternative<TomlArray>(entry->node.value)) {
    const auto values = fields.numbers("scale", 3, "a number or three");
    if (!values) return std::nullopt;
    scale = vector_of<3>(values->value);
  } else {
    const auto value = fields.number("scale", {"a number or three", kAnyNumber.low, true});
    if (!value) return std::nullopt;
    scale.setConstant(value->value);
  }
  for (int k = 0; k < 3; ++k) {
    if (scale[k] != 0) continue;
    fields.complaints().expected(entry->line, "scale", "numbers other than 0", "0");
    return std::nullopt;
  }
  return scale;
}

std::optional<Pose> read_matrix(Fields& fields) {
  for (const char* key : {"translation", "rotation", "axis", "degrees", "scale"}) {
    fields.exclude("matrix", key);
  }
  const auto values = fields.numbers("matrix", 12, "twelve numbers, three rows of four");
  if (!values) return std::nullopt;
  Pose pose = Pose::Identity();
  auto value = values->value.begin();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) pose(row, column) = *value++;
  }
  if (is_invertible(pose.linear())) return pose;
  fields.complaints().expected(values->line, "matrix", "an invertible matrix", "a singular one");
  return std::nullopt;
}

}  // namespace

Eigen::Matrix3d rotation_about(const Eigen::Vector3d& axis, double degrees) noexcept {
  const Eigen::Vector3d n = unit<3>(axis);
  const auto [sine, cosine] = of_degrees(degrees);
  const double rest = 1 - cosine;
  Eigen::Matrix3d result;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    result(i, i) = n[i] * n[i] * rest + cosine;
    result(i, j) = n[i] * n[j] * rest - n[k] * sine;
    result(i, k) = n[i] * n[k] * rest + n[j] * sine;
  }
  return result;
}

Eigen::Matrix3d rotation_of(const Eigen::Vector4d& quaternion) noexcept {
  const Eigen::Vector4d q = unit<4>(quaternion);
  const double w = q[3];
  Eigen::Matrix3d result;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    result(i, i) = 1 - 2 * (q[j] * q[j] + q[k] * q[k]);
    result(i, j) = 2 * (q[i] * q[j] - w * q[k]);
    result(i, k) = 2 * (q[i] * q[k] + w * q[j]);
  }
  return result;
}

// A determinant is six products of three; its rounding error is below gamma_6 of the sum of their
// magnitudes (Higham, "Accuracy and Stability", lemma 3.1). Rows are divided by their largest
// magnitude first, so that none of it over- or underflows.
bool is_invertible(const Eigen::Matrix3d& linear) noexcept {
  constexpr double kGamma8 = 8 * kRoundoffF64 * (1 + 1e-14);
  Eigen::Matrix3d m = linear;
  for (int row = 0; row < 3; ++row) {
    double largest = 0;
    for (int k = 0; k < 3; ++k) largest = std::max(largest, std::abs(m(row, k)));
    if (!(largest > 0) || !std::isfinite(largest)) return false;
    for (int k = 0; k < 3; ++k) m(row, k) /= largest;
  }
  double determinant = 0, magnitude = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    const double plus = m(0, i) * m(1, j) * m(2, k);
    const double minus = m(0, i) * m(1, k) * m(2, j);
    determinant += plus - minus;
    magnitude += std::abs(plus) + std::abs(minus);
  }
  return std::abs(determinant) > kGamma8 * magnitude;
}

Pose read_pose(Fields& fields) {
  const std::optional<Pose> matrix = read_matrix(fields);
  const auto translation = fields.numbers("translation", 3, "three numbers");
  const std::optional<Eigen::Matrix3d> rotation = read_rotation(fields);
  const std::optional<Eigen::Vector3d> scale = read_scale(fields);
  if (matrix) return *matrix;
  Pose pose = Pose::Identity();
  if (rotation) pose.linear() = *rotation;
  for (int column = 0; scale && column < 3; ++column) {
    for (int row = 0; row < 3; ++row) pose(row, column) *= (*scale)[column];
  }
  if (translation) pose.translation() = vector_of<3>(translation->value);
  return pose;
}

}  // namespace boxtree::cooker
