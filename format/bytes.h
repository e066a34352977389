// SPDX-License-Identifier: MIT
// Reads fixed-width values from mapped bytes, and the one range test that all offsets pass.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <boxtree/kinds.h>

namespace boxtree {

// Records are mapped, not parsed: the bytes of the file are the values of this machine.
static_assert(std::endian::native == std::endian::little, "boxtree reads .bxt files in place");

/// Whether [offset, offset + length) lies in [0, size). Subtracts, so that nothing overflows.
[[nodiscard]] constexpr bool in_range(std::uint64_t offset, std::uint64_t length,
                                      std::uint64_t size) noexcept {
  return length <= size && offset <= size - length;
}

/// The smallest multiple of `alignment` (a power of two) that is not below `value`.
/// Precondition: value <= 2^64 - alignment.
[[nodiscard]] constexpr std::uint64_t align_up(std::uint64_t value,
                                               std::uint64_t alignment) noexcept {
  return (value + alignment - 1) & ~(alignment - 1);
}

/// The `index`-th record of type T in `bytes`; any alignment. Precondition: the record is inside.
template <class T>
[[nodiscard]] inline T load(const std::byte* bytes, std::size_t index = 0) noexcept {
  static_assert(std::is_trivially_copyable_v<T>);
  T value;
  std::memcpy(&value, bytes + index * sizeof(T), sizeof(T));
  return value;
}

}  // namespace boxtree
