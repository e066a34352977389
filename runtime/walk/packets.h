// SPDX-License-Identifier: MIT
// Batches of queries of one tree: in packets that share what they read, or one by one.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <boxtree/query.h>

#include "runtime/primitive/float_state.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {

/// Whether the next packet of a batch is walked together: not as long as its queries share too
/// little. Together is tried again, the more rarely the more often it failed, since queries of one
/// kind follow each other.
class SharedWalks {
 public:
  /// Of the next packet.
  [[nodiscard]] bool is_alone() noexcept {
    if (alone_ == 0) return false;
    --alone_;
    return true;
  }

  /// Whether the walk of a packet together was worth it.
  void note(bool was_shared) noexcept {
    pause_ = was_shared ? kFirstPause : std::min(2 * pause_, kLastPause);
    if (!was_shared) alone_ = pause_;
  }

 private:
  static constexpr std::uint32_t kFirstPause = 4, kLastPause = 128;

  std::uint32_t pause_ = kFirstPause;
  std::uint32_t alone_ = 0;  // the packets that follow and are walked one by one
};

/// Answers a batch of `count` queries. What it needs of a packet:
/// packet.walk_alone(first, count): answers queries of the batch, at most Packet::kMost, one by
/// one. packet.take(first, count): prepares so many; packet.all() -> those that a walk has to
/// answer. packet.answer(error of the walk). And of `walk`, of the packet through the tree: run()
/// -> Errc, was_shared() -> bool.
template <class Packet, class Walk>
void answer_in_packets(std::size_t count, Packet& packet, Walk& walk, bool always_alone = false) {
  SharedWalks walks;
  for (std::size_t first = 0; first < count; first += Packet::kMost) {
    const std::size_t taken = std::min<std::size_t>(count - first, Packet::kMost);
    if (always_alone || walks.is_alone()) {
      packet.walk_alone(first, taken);
      continue;
    }
    packet.take(first, taken);
    if (packet.all() == 0) continue;
    packet.answer(walk.run());
    walks.note(walk.was_shared());
  }
}

/// Answers a batch by vectors (`walk_wide(batch)`), or one by one.
template <class Batch>
void answer_batch(Batch& batch, const QueryLimits& limits) {
  // A packet reads nodes for several queries: what one of them may read cannot be told.
  const bool is_limited = limits.nodes != QueryLimits().nodes;
  if constexpr (kWalksTreesByVectors) {
    if (!is_limited && has_wide_nodes(batch.tree) && batch.tree.has_float_nodes()) {
      const DefaultFloatState state;
      return walk_wide(batch);
    }
  }
  for (std::size_t i = 0; i < batch.results.size(); ++i) batch.answer_alone(i);
}

}  // namespace boxtree
