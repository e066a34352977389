// SPDX-License-Identifier: MIT
// Counts cache misses: by the processor's counter if the kernel permits it, otherwise by a model.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace boxtree::bench {

/// One set-associative level with LRU replacement.
class CacheLevel {
 public:
  static constexpr std::size_t kLineBytes = 64;

  CacheLevel(std::size_t bytes, std::size_t ways)
      : ways_(ways), sets_(bytes / kLineBytes / ways), lines_(sets_ * ways, kNone) {}

  /// Loads a line; returns whether it was present.
  bool touch(std::uint64_t line) {
    const auto set = lines_.begin() + static_cast<std::ptrdiff_t>(line % sets_ * ways_);
    const auto end = set + static_cast<std::ptrdiff_t>(ways_);
    const auto found = std::find(set, end, line);
    const bool hit = found != end;
    std::rotate(set, hit ? found : end - 1, hit ? found + 1 : end);
    *set = line;
    return hit;
  }

 private:
  static constexpr std::uint64_t kNone = ~std::uint64_t{0};
  std::size_t ways_;
  std::size_t sets_;
  std::vector<std::uint64_t> lines_;  // newest first within a set
};

/// First and second level of the paper's machine (i5-8250U: 32 KiB 8-way, 256 KiB 4-way), fed with
/// the addresses of nodes and geometry that a query reads.
class CacheModel {
 public:
  void read(const void* address, std::size_t bytes) {
    const auto first = reinterpret_cast<std::uintptr_t>(address) / CacheLevel::kLineBytes;
    const auto last =
        (reinterpret_cast<std::uintptr_t>(address) + bytes - 1) / CacheLevel::kLineBytes;
    for (std::uintptr_t line = first; line <= last; ++line) {
      if (level1_.touch(line)) continue;
      ++level1_misses_;
      if (!level2_.touch(line)) ++level2_misses_;
    }
  }
  [[nodiscard]] std::uint64_t level1_misses() const { return level1_misses_; }
  [[nodiscard]] std::uint64_t level2_misses() const { return level2_misses_; }

 private:
  CacheLevel level1_{32 << 10, 8};
  CacheLevel level2_{256 << 10, 4};
  std::uint64_t level1_misses_ = 0;
  std::uint64_t level2_misses_ = 0;
};

/// The processor's own counter of cache misses, for the calling thread in user mode.
class CacheMissCounter {
 public:
  /// Empty if the kernel or the machine has no such counter.
  static std::optional<CacheMissCounter> open();
  ~CacheMissCounter();
  CacheMissCounter(CacheMissCounter&& other) noexcept;
  CacheMissCounter& operator=(CacheMissCounter&&) = delete;

  void start() const;
  [[nodiscard]] std::uint64_t stop() const;

 private:
  explicit CacheMissCounter(int descriptor) : descriptor_(descriptor) {}
  int descriptor_;
};

}  // namespace boxtree::bench
