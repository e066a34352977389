// SPDX-License-Identifier: MIT
#include "tests/fuzz/query_input.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>

#include "cooker/proof/proof.h"
#include "tests/fuzz/target.h"

namespace boxtree::fuzz {
namespace {

constexpr std::size_t kOptions = 48;  // behind 12 numbers of 4 bytes

Bytes tail(Bytes input) {
  return input.last(std::min(input.size(), kQueryBytes));
}

}  // namespace

QueryInput::QueryInput(Bytes bytes) {
  if (!bytes.empty()) {
    std::memcpy(bytes_.data(), bytes.data(), std::min(bytes.size(), bytes_.size()));
  }
}

double QueryInput::number(std::size_t index) const {
  const std::byte* const at = bytes_.data() + 4 * index;
  const double mantissa = load<std::int16_t>(at);
  const int exponent = load<std::int8_t>(at + 2);
  switch (std::to_integer<unsigned>(at[3]) & 15u) {
    case 1:
      return std::ldexp(mantissa, exponent);
    case 2:
      return std::ldexp(mantissa, 8 * exponent);  // 2^-1024 to 2^1031: infinities, too
    case 3:
      return std::numeric_limits<double>::quiet_NaN();
    case 4:
      return std::copysign(0.0, mantissa);
    case 5:
      return load<float>(at);
    default:
      return mantissa / 256;
  }
}

Eigen::Vector3d QueryInput::vector(std::size_t index) const {
  return {number(index), number(index + 1), number(index + 2)};
}

Pose QueryInput::pose() const {
  Pose pose = Pose::Identity();
  const unsigned kind = option(0) & 3u;
  if (kind != 0) pose.translation() = vector(9);
  if (kind == 3) {
    for (std::size_t i = 0; i < 9; ++i) {
      pose.linear()(static_cast<Eigen::Index>(i / 3), static_cast<Eigen::Index>(i % 3)) = number(i);
    }
  }
  return pose;
}

std::uint8_t QueryInput::option(std::size_t index) const {
  return std::to_integer<std::uint8_t>(bytes_[kOptions + index]);
}

QueryLimits QueryInput::limits() const {
  const std::uint8_t nodes = option(14);
  return nodes == 0 ? QueryLimits() : QueryLimits{nodes};
}

Input::Input(Bytes bytes) : query(tail(bytes)), shift(query.option(15) % 8u) {
  const Bytes file = bytes.first(bytes.size() - std::min(bytes.size(), kQueryBytes));
  memory.resize(shift + file.size());
  memory.shrink_to_fit();
  std::copy(file.begin(), file.end(), memory.begin() + static_cast<std::ptrdiff_t>(shift));
}

bool Check::is_file_valid() const {
  return cooker::verify_file(file_, mesh_).empty();
}

void Check::error(Errc code) const {
  const auto number = static_cast<unsigned>(code);
  const bool is_of_corrupt_bytes = 10 <= number && number < 50;
  const bool is_our_bug = code == Errc::kInternal;
  if (is_our_bug) finding("a query ends with kInternal");
  if (is_of_corrupt_bytes && code != Errc::kCodecUnsupported &&
      code != Errc::kGeometryUnsupported && is_file_valid()) {
    finding(std::string("verify accepts a file on which a query ends with ") +
            std::string(error_info(code).name));
  }
}

void Check::holds(bool is_true, const char* otherwise) const {
  if (!is_true && is_file_valid()) finding(otherwise);
}

}  // namespace boxtree::fuzz
