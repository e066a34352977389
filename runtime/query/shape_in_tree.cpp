// SPDX-License-Identifier: MIT
// Scaling, and what makes a shape invalid.
#include "runtime/query/shape_in_tree.h"

#include <algorithm>
#include <cmath>

#include "runtime/primitive/expansion.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {
namespace {

bool is_unsigned(double x) noexcept {
  return x >= 0 && std::isfinite(x);
}

// Squares and products of coordinates must not overflow.
void check_size(ShapeInTree& out) noexcept {
  if (out.invalid == nullptr && !(largest_magnitude(out.shape.half_extents()) <= kMaxCoordinate)) {
    out.invalid = out.shape.axes == 3 ? "half_extents" : "radius";
  }
}

}  // namespace

ShapeInTree in_tree(const Frame& frame, const Sphere& sphere) noexcept {
  ShapeInTree out;
  out.center = sphere.center;
  out.shape.radius = sphere.radius * frame.inverse_scale;
  if (!is_within_range(frame.to_tree(sphere.center))) out.invalid = "center";
  if (!is_unsigned(sphere.radius)) out.invalid = "radius";
  check_size(out);
  return out;
}

ShapeInTree in_tree(const Frame& frame, const Capsule& capsule) noexcept {
  ShapeInTree out;
  const Eigen::Vector3d start = frame.to_tree(capsule.start);
  const Eigen::Vector3d end = frame.to_tree(capsule.end);
  if (!is_within_range(start)) out.invalid = "start";
  if (!is_within_range(end)) out.invalid = "end";
  if (!is_unsigned(capsule.radius)) out.invalid = "radius";
  if (out.invalid != nullptr) return out;
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Rounded middle = two_sum(capsule.start[k] / 2, capsule.end[k] / 2);
    out.center[k] = middle.value;
    out.shape.error = std::max(out.shape.error, std::abs(middle.error) * frame.inverse_scale);
  }
  out.shape.axes = 1;
  out.shape.axis[0] = end / 2 - start / 2;
  out.shape.half[0] = 1;
  out.shape.radius = capsule.radius * frame.inverse_scale;
  check_size(out);
  return out;
}

ShapeInTree in_tree(const Frame& frame, const OrientedBox& box) noexcept {
  ShapeInTree out;
  out.center = box.center;
  out.shape.axes = 3;
  const auto& q = box.rotation.coeffs();  // x, y, z, w
  const double largest = std::max(largest_magnitude(q[0], q[1], q[2]), std::abs(q[3]));
  if (!is_within_range(frame.to_tree(box.center))) out.invalid = "center";
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (!is_unsigned(box.half_extents[k])) out.invalid = "half_extents";
  }
  if (!(largest > 0) || !std::isfinite(largest)) out.invalid = "rotation";
  if (out.invalid != nullptr) return out;
  const double x = q[0] / largest, y = q[1] / largest, z = q[2] / largest, w = q[3] / largest;
  const double length = ((x * x + y * y) + z * z) + w * w;
  const double s = 2 / length;
  out.shape.axis[0] = {1 - s * (y * y + z * z), s * (x * y + w * z), s * (x * z - w * y)};
  out.shape.axis[1] = {s * (x * y - w * z), 1 - s * (x * x + z * z), s * (y * z + w * x)};
  out.shape.axis[2] = {s * (x * z + w * y), s * (y * z - w * x), 1 - s * (x * x + y * y)};
  for (std::size_t k = 0; k < 3; ++k) {
    out.shape.half[k] = box.half_extents[static_cast<Eigen::Index>(k)] * frame.inverse_scale;
  }
  check_size(out);
  return out;
}

}  // namespace boxtree
