// SPDX-License-Identifier: MIT
// The search for a closest point that may be stopped after any node.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <limits>

#include "runtime/query/point_query.h"
#include "runtime/tree/root_box.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/frontier.h"

namespace boxtree {

/// How many nodes and leaves a search may visit, and what it left when it ended.
struct SearchBudget {
  std::uint64_t nodes;
  double left = std::numeric_limits<double>::infinity();  // the least key of what was not visited
  bool is_spent = false;
};

/// Visits nodes in the order of their keys until the budget is spent. Like the distance walk it is
/// depth-first at the start, so that a small budget finds something. `Source`, of one tree:
/// Source::Entry, a node or leaf and its box; source.root() and source.key(entry).
/// source.is_leaf(entry); source.read(entry): tests its faces; whether to go on, or the query holds
///   the error.
/// source.expand(entry) -> Errc, kOk once the node is counted; then source.count() of its children,
///   source.key(i) and source.child(i).
/// Keys are the same numbers whatever the source, so that all visit the same nodes.
template <class Source>
class BestFirst {
 public:
  BestFirst(Source& source, PointQuery& query, SearchBudget& budget) noexcept
      : source_(source), query_(query), budget_(budget) {}

  Errc run() noexcept {
    const Errc error = visit();
    budget_.left = std::min(budget_.left, frontier_.least_left());
    return error;
  }

 private:
  using Entry = typename Source::Entry;
  static constexpr std::size_t kQueue = 1024;

  Errc visit() noexcept {
    Entry entry = source_.root();
    double key = source_.key(entry);
    if (!frontier_.push(key, enough(), entry)) return Errc::kInternal;
    while (frontier_.pop(enough(), key, entry)) {
      bool goes_on = true;
      while (goes_on) {
        if (query_.nodes_expanded == budget_.nodes) {
          budget_.left = std::min(budget_.left, key);
          budget_.is_spent = true;
          return Errc::kOk;
        }
        ++query_.nodes_expanded;
        if (source_.is_leaf(entry)) {
          if (!source_.read(entry)) return Errc::kOk;  // the query holds the error
          break;
        }
        Errc error = source_.expand(entry);
        if (error == Errc::kOk) error = queue_children(goes_on, key, entry);
        if (error != Errc::kOk) return error;
      }
    }
    return Errc::kOk;
  }

  // The least key that is too large: equal distances are visited, so that ties end as in the exact
  // query. Keys are not negative, so that the next double is the next number in bits.
  [[nodiscard]] double enough() const noexcept {
    const double bound = query_.bound();
    if (bound == std::numeric_limits<double>::infinity()) return bound;
    return std::bit_cast<double>(std::bit_cast<std::uint64_t>(bound) + 1);
  }

  // Until something is found the nearest child is visited next, and not queued.
  Errc queue_children(bool& goes_on, double& key, Entry& entry) noexcept {
    const std::uint32_t count = source_.count();
    const double limit = enough();
    std::uint32_t nearest = 0;
    for (std::uint32_t i = 1; i < count; ++i) {
      if (source_.key(i) < source_.key(nearest)) nearest = i;
    }
    goes_on = !query_.found && count > 0 && source_.key(nearest) < limit;
    for (std::uint32_t i = 0; i < count; ++i) {
      if (goes_on && i == nearest) continue;
      if (!(source_.key(i) < limit)) {
        budget_.left = std::min(budget_.left, source_.key(i));
      } else if (!frontier_.push(source_.key(i), limit, source_.child(i))) {
        return Errc::kDepthExceeded;
      }
    }
    if (goes_on) {
      key = source_.key(nearest);
      entry = source_.child(nearest);
    }
    return Errc::kOk;
  }

  Source& source_;
  PointQuery& query_;
  SearchBudget& budget_;
  Frontier<Entry, kQueue, Source::kStackSize> frontier_;
};

/// The source for any codec, one box at a time.
class AnyNearNodes {
 public:
  static constexpr std::size_t kStackSize = boxtree::kStackSize<ErasedCodec>;
  struct Entry {
    Box<double> box;
    NodeRef ref;
    bool is_leaf;
  };

  AnyNearNodes(const BoundTree& tree, PointQuery& query) noexcept
      : tree_(tree), codec_{&tree}, query_(query) {}

  [[nodiscard]] Entry root() const noexcept {
    return {root_box<double>(tree_), tree_.root_ref(), tree_.is_leaf()};
  }
  [[nodiscard]] double key(const Entry& entry) const noexcept { return query_.key(entry.box); }
  [[nodiscard]] bool is_leaf(const Entry& entry) const noexcept { return entry.is_leaf; }
  [[nodiscard]] bool read(const Entry& entry) noexcept { return query_.read(entry.ref); }

  Errc expand(const Entry& entry) noexcept {
    const Errc error = query_.nodes.count(codec_.expand(entry.ref, entry.box, children_));
    if (error != Errc::kOk) return error;
    for (std::uint32_t i = 0; i < children_.count; ++i) keys_[i] = query_.key(children_.box(i));
    return Errc::kOk;
  }
  [[nodiscard]] std::uint32_t count() const noexcept { return children_.count; }
  [[nodiscard]] double key(std::uint32_t i) const noexcept { return keys_[i]; }
  [[nodiscard]] Entry child(std::uint32_t i) const noexcept {
    return {children_.box(i), children_.ref[i], children_.is_leaf(i)};
  }

 private:
  const BoundTree& tree_;
  const ErasedCodec codec_;
  PointQuery& query_;
  ErasedCodec::Children children_;
  std::array<double, ErasedCodec::Children::kWidth> keys_;
};

/// By vectors; see walk_tree.h.
Errc walk_wide(const BoundTree& tree, PointQuery& query, SearchBudget& budget);

}  // namespace boxtree
