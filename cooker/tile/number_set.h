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
  [[nodiscard]] bool contains(std::uint32_t number) const noexcept {
    const Page* const page = pages_[number / kPageBits].get();
    return page != nullptr && ((*page)[number % kPageBits / 64] >> number % 64 & 1) != 0;
  }
  void insert(std::uint32_t number) {
    std::unique_ptr<Page>& page = pages_[number / kPageBits];
    if (page == nullptr) page = std::make_unique<Page>();
    (*page)[number % kPageBits / 64] |= std::uint64_t{1} << number % 64;
  }

 private:
  static constexpr std::uint32_t kPageBits = 1u << 16;
  using Page = std::array<std::uint64_t, kPageBits / 64>;

  std::vector<std::unique_ptr<Page>> pages_ = std::vector<std::unique_ptr<Page>>(kPageBits);
};

}  // namespace boxtree::cooker
