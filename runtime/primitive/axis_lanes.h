// SPDX-License-Identifier: MIT
// One number per axis, laid out so that arithmetic on them is vectorised.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "format/box.h"
#include "runtime/primitive/vector3.h"

namespace boxtree {

/// One number per axis and a copy of the last. Loops over four of them become two vectors of SSE2
/// or NEON, or one of AVX; loops over three stay scalar.
struct alignas(16) AxisLanes {
  static constexpr std::size_t kCount = 4;

  AxisLanes() noexcept = default;  // unspecified numbers
  AxisLanes(double x, double y, double z) noexcept : AxisLanes(x, y, z, z) {}
  AxisLanes(double x, double y, double z, double fourth) noexcept : lane{x, y, z, fourth} {}
  explicit AxisLanes(const Eigen::Vector3d& v) noexcept : AxisLanes(v[0], v[1], v[2]) {}

  template <class Index>
  double& operator[](Index k) noexcept {
    return lane[static_cast<std::size_t>(k)];
  }
  template <class Index>
  const double& operator[](Index k) const noexcept {
    return lane[static_cast<std::size_t>(k)];
  }
  [[nodiscard]] Eigen::Vector3d vector() const noexcept { return {lane[0], lane[1], lane[2]}; }

  std::array<double, kCount> lane;
};

/// Brings numbers, none of them NaN, into [-most, most]. Hardly ever is one outside, so that to
/// look is cheaper: compilers do not see the minimum of vectors in that of their numbers.
inline void clamp_magnitudes(AxisLanes& v, double most) noexcept {
  if (largest_magnitude(v[0], v[1], v[2]) <= most) [[likely]] return;
  for (std::size_t k = 0; k < AxisLanes::kCount; ++k) v[k] = std::clamp(v[k], -most, most);
}

/// A box, laid out alike.
struct BoxLanes {
  BoxLanes() noexcept = default;  // unspecified numbers
  template <class S>
  explicit BoxLanes(const Box<S>& box) noexcept
      : low(box.low[0], box.low[1], box.low[2]), high(box.high[0], box.high[1], box.high[2]) {}

  AxisLanes low;
  AxisLanes high;
};

}  // namespace boxtree
