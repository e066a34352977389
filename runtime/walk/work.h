// SPDX-License-Identifier: MIT
// What a query may cost. Each walk ends on any bytes, because an honest walk takes each node apart
// at most once: one that would go on has come to a node twice, and the file is corrupt. A caller
// may allow less than that.
#pragma once

#include <algorithm>
#include <cstdint>

#include <boxtree/query.h>

namespace boxtree {

/// What is left of a query's limit; shared by the walks that it is made of, one after the other.
struct QueryWork {
  explicit QueryWork(const QueryLimits& limits) noexcept : left(limits.nodes) {}

  [[nodiscard]] bool take_one() noexcept {
    if (left == 0) return false;
    --left;
    return true;
  }

  std::uint64_t left;
};

/// Counts the nodes of one walk. Made once a query, outside of the walks, of which there are many.
class WalkBound {
 public:
  /// `most`: what an honest walk takes apart. `work` may be null: no limit.
  explicit WalkBound(std::uint64_t most, QueryWork* work = nullptr) noexcept
      : work_(work),
        most_(most),
        first_(work == nullptr ? most : std::min(most, work->left)),
        left_(first_) {}
  WalkBound(const WalkBound&) = delete;
  WalkBound& operator=(const WalkBound&) = delete;
  ~WalkBound() {
    if (work_ != nullptr) work_->left -= first_ - left_;
  }

  /// Counts one more; false, and nothing counted, when there was none left: see error().
  [[nodiscard]] bool take_one() noexcept {
    if (left_ == 0) return false;
    --left_;
    return true;
  }
  /// Why take_one() failed.
  [[nodiscard]] Errc error() const noexcept {
    return first_ == most_ ? Errc::kNodeCorrupt : Errc::kWorkLimit;
  }

 private:
  QueryWork* work_;
  std::uint64_t most_;
  std::uint64_t first_;
  std::uint64_t left_;
};

}  // namespace boxtree
