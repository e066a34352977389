// SPDX-License-Identifier: MIT
// A set of numbers of faces: a bit each, in pages for what is near to each other.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace boxtree::cooker {

/// Takes 8 KB for each 65536 numbers of which it has one, and half a megabyte for itself.
class NumberSet {
 public:
  /// Whether it was not in the set.
  bool insert(std::uint32_t number) {
    std::unique_ptr<Page>& page = pages_[number / kPageBits];
    if (page == nullptr) page = std::make_unique<Page>();
    std::uint64_t& word = (*page)[number % kPageBits / 64];
    const std::uint64_t bit = std::uint64_t{1} << number % 64;
    const bool is_new = (word & bit) == 0;
    word |= bit;
    return is_new;
  }

 private:
  static constexpr std::uint32_t kPageBits = 1u << 16;
  using Page = std::array<std::uint64_t, kPageBits / 64>;

  std::vector<std::unique_ptr<Page>> pages_ = std::vector<std::unique_ptr<Page>>(kPageBits);
};

}  // namespace boxtree::cooker
