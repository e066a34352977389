// SPDX-License-Identifier: MIT
// Limits on the work of a query. Each walk ends on any bytes, because in a valid file it expands
// each node at most once: a walk that would expand more has visited a node twice, and the file is
// corrupt. A caller may allow less than that. Every walk, whatever its order and purpose, continues
// through WalkBound::count or SharedWalkBound::count, the only use of a NodeState. In packed nodes
// cycles cannot be detected otherwise; in plain and wide ones children have larger indices than
// their parents.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include <boxtree/query.h>

#include "format/children.h"

namespace boxtree {

/// What is left of a query's limit; shared by the walks that the query consists of, one after the
/// other.
struct QueryWork {
  explicit QueryWork(const QueryLimits& limits) noexcept : left(limits.nodes) {}

  [[nodiscard]] bool take_one() noexcept {
    if (left == 0) return false;
    --left;
    return true;
  }

  std::uint64_t left;
};

/// Counts the nodes of one walk. Made once per query, outside of the walks, which are compiled many
/// times.
class WalkBound {
 public:
  /// `most`: the nodes that a walk of a valid file expands. `work` may be null: no limit.
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

  /// Counts one more node, or pair, that was decoded. kWorkLimit when the caller's limit is spent;
  /// else kNodeCorrupt if it is corrupt or if no walk of a valid file visits so many; else kOk, and
  /// the walk may go on to its children.
  [[nodiscard]] Errc count(NodeState state) noexcept {
    if (left_ != 0 && state == NodeState::kValid) [[likely]] {
      --left_;
      return Errc::kOk;
    }
    return left_ == 0 && first_ != most_ ? Errc::kWorkLimit : Errc::kNodeCorrupt;
  }

 private:
  QueryWork* work_;
  std::uint64_t most_;
  std::uint64_t first_;
  std::uint64_t left_;
};

/// The same for a walk in several threads, which no caller limits.
class SharedWalkBound {
 public:
  explicit SharedWalkBound(std::uint32_t most) noexcept : left_(most) {}

  /// kNodeCorrupt or kOk.
  [[nodiscard]] Errc count(NodeState state) noexcept {
    std::uint32_t left = left_.load(std::memory_order_relaxed);
    while (state == NodeState::kValid && left > 0) {
      if (left_.compare_exchange_weak(left, left - 1, std::memory_order_relaxed)) return Errc::kOk;
    }
    return Errc::kNodeCorrupt;
  }

 private:
  std::atomic<std::uint32_t> left_;
};

/// The pending entries of a depth-first walk, last in, first out. `kMost`: the most that are
/// pending in a valid file.
template <class Entry, std::size_t kMost>
class WalkStack {
 public:
  [[nodiscard]] bool empty() const noexcept { return size_ == 0; }
  /// kDepthExceeded when it is full: then the tree is deeper than any valid one; else kOk.
  [[nodiscard]] Errc push(const Entry& entry) noexcept {
    if (size_ == kMost) return Errc::kDepthExceeded;
    entries_[size_++] = entry;
    return Errc::kOk;
  }
  /// Precondition: !empty().
  [[nodiscard]] Entry pop() noexcept { return entries_[--size_]; }

 private:
  std::size_t size_ = 0;
  std::array<Entry, kMost> entries_;
};

}  // namespace boxtree
