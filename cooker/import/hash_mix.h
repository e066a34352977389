// SPDX-License-Identifier: MIT
// Hashes of positions and of numbers that differ in few bits.
#pragma once

#include <cstdint>

namespace boxtree::cooker {

/// A hash with one more number. Each number is spread over 64 bits before the next is added. The
/// top bits of a product depend on all lower bits, hence the final fold. Multiplier: 2^64 divided
/// by the golden ratio (Knuth, TAOCP 6.4).
[[nodiscard]] constexpr std::uint64_t hash_with(std::uint64_t hash, std::uint64_t number) noexcept {
  const std::uint64_t product = (hash ^ number) * 0x9e3779b97f4a7c15u;
  return product ^ product >> 32;
}

}  // namespace boxtree::cooker
