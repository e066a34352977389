// SPDX-License-Identifier: MIT
// The decoded box: what a reader computes from the stored bits.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>

namespace boxtree {

/// Closed axis-aligned box in tree space (see TreeRecord). S is float, or double for f64 codecs.
template <class S>
struct Box {
  std::array<S, 3> low;
  std::array<S, 3> high;

  friend bool operator==(const Box&, const Box&) = default;
};

/// A box that contains nothing; grows by expand().
template <class S>
[[nodiscard]] constexpr Box<S> empty_box() noexcept {
  constexpr S kInfinity = std::numeric_limits<S>::infinity();
  return {{kInfinity, kInfinity, kInfinity}, {-kInfinity, -kInfinity, -kInfinity}};
}

template <class S>
constexpr void expand(Box<S>& box, const Box<S>& by) noexcept {
  for (std::size_t k = 0; k < 3; ++k) {
    box.low[k] = std::min(box.low[k], by.low[k]);
    box.high[k] = std::max(box.high[k], by.high[k]);
  }
}

/// The same box in another scalar: exact to double, rounded to nearest to float.
template <class To, class From>
[[nodiscard]] constexpr Box<To> box_cast(const Box<From>& box) noexcept {
  Box<To> result{};
  for (std::size_t k = 0; k < 3; ++k) {
    result.low[k] = static_cast<To>(box.low[k]);
    result.high[k] = static_cast<To>(box.high[k]);
  }
  return result;
}

}  // namespace boxtree
