// SPDX-License-Identifier: MIT
// How a tree stores arrays of numbers (face ids, originals of copies, materials): the widths that
// exist, the size of an array, reading a number.
#pragma once

#include <cstddef>
#include <cstdint>

#include "format/bytes.h"

namespace boxtree {

/// Bytes of each number in an array of numbers up to `largest`: 1, 2 or 4.
[[nodiscard]] constexpr std::uint8_t number_bytes(std::uint32_t largest) noexcept {
  if (largest <= 0xff) return 1;
  return largest <= 0xffff ? 2 : 4;
}

/// Whether `width` is a width that arrays can have.
[[nodiscard]] constexpr bool is_number_width(std::uint8_t width) noexcept {
  return width == 1 || width == 2 || width == 4;
}

/// Bytes of an array of `count` numbers. Precondition: is_number_width(width), or width is 0 for no
/// array.
[[nodiscard]] constexpr std::uint64_t number_array_bytes(std::uint32_t count,
                                                         std::uint8_t width) noexcept {
  return std::uint64_t{count} * width;
}

/// A view of an array of numbers, or of none.
class NumberView {
 public:
  NumberView() noexcept = default;
  /// Precondition: is_number_width(width).
  NumberView(const std::byte* numbers, std::uint8_t width) noexcept
      : numbers_(numbers), width_(width) {}

  explicit operator bool() const noexcept { return numbers_ != nullptr; }

  /// Precondition: index is inside the array.
  [[nodiscard]] std::uint32_t operator[](std::size_t index) const noexcept {
    switch (width_) {
      case 1:
        return load<std::uint8_t>(numbers_, index);
      case 2:
        return load<std::uint16_t>(numbers_, index);
      default:
        return load<std::uint32_t>(numbers_, index);
    }
  }

 private:
  const std::byte* numbers_ = nullptr;
  std::uint8_t width_ = 0;
};

}  // namespace boxtree
