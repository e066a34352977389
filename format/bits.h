// SPDX-License-Identifier: MIT
// Fields of run-time width at any bit: one unaligned load, a shift and a mask (paper
// section 3.2.1).
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>

#include "format/bytes.h"

namespace boxtree {

/// Bytes after the last field that read_bits may load.
inline constexpr std::size_t kBitPadding = 8;

/// Bits that one unaligned load has from any bit on.
inline constexpr std::uint32_t kMostBitsRead = 57;

/// The `width` low bits of a word, set. Precondition: width <= 64.
[[nodiscard]] constexpr std::uint64_t low_bits(std::uint32_t width) noexcept {
  return width == 0 ? 0 : ~std::uint64_t{0} >> (64 - width);
}

/// Width in bits of a field for numbers up to `largest`; for writers.
[[nodiscard]] constexpr std::uint8_t field_width(std::uint64_t largest) noexcept {
  return static_cast<std::uint8_t>(largest == 0 ? 1 : std::bit_width(largest));
}

/// Width in bits of a field for numbers below `count`; 0 for a count of 0 or 1. `odd` is never
/// zero, so that no branch is needed. Precondition: count < 2^63.
[[nodiscard]] constexpr std::uint32_t width_below(std::uint64_t count) noexcept {
  const std::uint64_t odd = (2 * count - (count != 0 ? 1u : 0u)) | 1u;
  return static_cast<std::uint32_t>(std::bit_width(odd)) - 1;
}

/// The field of `width` bits that starts `position` bits after `bytes`; the first bit is the least
/// significant one. Precondition: width <= kMostBitsRead, and kBitPadding bytes follow the field.
[[nodiscard]] inline std::uint64_t read_bits(const std::byte* bytes, std::uint64_t position,
                                             std::uint32_t width) noexcept {
  return (load<std::uint64_t>(bytes + position / 8) >> (position % 8)) & low_bits(width);
}

/// The same for fields of up to 64 bits.
[[nodiscard]] inline std::uint64_t read_wide_bits(const std::byte* bytes, std::uint64_t position,
                                                  std::uint32_t width) noexcept {
  constexpr std::uint32_t kHalf = 32;
  if (width <= kHalf) return read_bits(bytes, position, width);
  return read_bits(bytes, position, kHalf) | read_bits(bytes, position + kHalf, width - kHalf)
                                                 << kHalf;
}

/// Sets a field that is zero. The mirror image of read_wide_bits; for writers.
inline void write_bits(std::byte* bytes, std::uint64_t position, std::uint32_t width,
                       std::uint64_t value) noexcept {
  for (std::uint32_t done = 0; done < width;) {
    const std::uint64_t at = position + done;
    const auto offset = static_cast<std::uint32_t>(at % 8);
    const std::uint32_t count = 8 - offset < width - done ? 8 - offset : width - done;
    const std::uint64_t piece = ((value >> done) & low_bits(count)) << offset;
    bytes[at / 8] |= static_cast<std::byte>(piece);
    done += count;
  }
}

/// The same with one load and one store. Precondition: as for read_bits.
inline void write_short_bits(std::byte* bytes, std::uint64_t position, std::uint32_t width,
                             std::uint64_t value) noexcept {
  std::byte* const at = bytes + position / 8;
  const std::uint64_t word = load<std::uint64_t>(at) | (value & low_bits(width)) << (position % 8);
  std::memcpy(at, &word, sizeof(word));
}

}  // namespace boxtree
