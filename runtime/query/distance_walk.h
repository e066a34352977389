// SPDX-License-Identifier: MIT
// The search for the distance of two trees. Implements boxtree/distance.h.
//
// Every pair of nodes has a key, the squared lower bound of its boxes' distance, never above that
// of anything inside. Pairs are expanded in the order of their keys, so a larger allowed error
// expands the same pairs in the same order and stops sooner. The answer's lower bound is the least
// of the keys of all skipped pairs and of the bounds of all triangles compared.
//
// What makes the search short are axes along and across the line between the nearest points so far.
// Boxes reach far beyond what they hold along them; so the extents of nodes and leaves are learnt
// from what was read below them (KnownExtents), and the keys of waiting pairs grow with them. A
// leaf that may matter is read when it is first met. And the first pair is near already
// (nearby_leaves.h), so that the axes hardly change after it.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "runtime/query/child_gaps.h"
#include "runtime/query/known_extents.h"
#include "runtime/query/nearby_leaves.h"
#include "runtime/query/nearest_triangles.h"
#include "runtime/query/pair_walk.h"
#include "runtime/query/relative_pose.h"
#include "runtime/query/world_metric.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/tree/root_box.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/frontier.h"

namespace boxtree {

/// One query. Everything passed by reference must outlive it. Most of its time goes into distances
/// of boxes, so one walk serves all codecs.
class DistanceWalk {
 public:
  /// `approximation` is in the metric's units.
  DistanceWalk(const BoundTree& first, const BoundTree& second, const RelativePose& pose,
               const WorldMetric& metric, const Approximation& approximation) noexcept
      : sides_{{{first, pose.to_second(), metric.in_first()},
                {second, pose.to_first(), metric.in_second()}}},
        metric_(metric),
        node_budget_(approximation.node_budget),
        bound_(first, second, nullptr),
        nearest_(first, second, pose, metric, approximation) {}

  /// `root_distance`: WorldMetric::squared_distance() of the root boxes; `nearby`: leaves to begin
  /// with, if there are any.
  Errc run(double root_distance, const std::optional<NearbyLeaves>& nearby) noexcept {
    Entry root;
    for (std::size_t s = 0; s < 2; ++s) {
      const BoundTree& tree = sides_[s].tree;
      root.box[s] = root_box<double>(tree);
      root.ref[s] = tree.root_ref();
      root.is_leaf[s] = tree.is_leaf();
    }
    const Box<double> image = sides_[1].to_other.hull(root.box[1]);
    nearest_.face(metric_.to_world(center(image) - center(root.box[0])));
    const double root_key = std::max(
        root_distance, nearest_.axes().squared_distance(extent_of(root, 0), extent_of(root, 1)));
    if (nearby && root_key < nearest_.enough()) {
      const Errc error = nearest_.begin_with(nearby->first, nearby->second);
      if (error != Errc::kOk) return error;
    }
    if (!frontier_.push(root_key, nearest_.enough(), root)) return Errc::kInternal;
    double key = 0;
    Entry entry;
    while (take(key, entry)) {
      if (visited_ == node_budget_) {
        nearest_.leave(key);
        is_spent_ = true;
        break;
      }
      ++visited_;
      const Errc error = visit(entry, key);
      if (error != Errc::kOk) return error;
    }
    return Errc::kOk;
  }

  [[nodiscard]] const NearestPair& nearest() const noexcept { return nearest_.pair(); }
  /// Whether there is one, within the maximal distance.
  [[nodiscard]] bool has_found() const noexcept { return nearest_.is_within(); }
  [[nodiscard]] std::uint64_t visited() const noexcept { return visited_; }
  [[nodiscard]] bool is_spent() const noexcept { return is_spent_; }
  /// The lower bound of the distance.
  [[nodiscard]] double lower() const noexcept {
    const double left = root_below(std::min(nearest_.left(), frontier_.least_left()));
    return std::min({left, nearest_.pair().lower, nearest_.pair().upper});
  }

 private:
  // What is of one tree. Its boxes are compared in its own space with those of the other tree, and
  // moved in the other's.
  struct Side {
    const BoundTree& tree;
    const AffineMap& to_other;
    const GapWeights& gaps;
  };
  // A subtree of each tree.
  struct Entry {
    std::array<Box<double>, 2> box;
    std::array<NodeRef, 2> ref;
    std::array<bool, 2> is_leaf;
  };

  // One side is expanded at a time: a path is as long as the depths of both trees together, and
  // each step leaves all but one child of a node pending.
  static constexpr std::size_t kWidth = ErasedCodec::Children::kWidth;
  static constexpr std::size_t kQueue = 2048;
  static constexpr std::size_t kStack = 2 * ErasedCodec::kDepthLimit * (kWidth - 1) + 1;

  // Until some triangles have been compared the walk is depth-first, to the nearest child of the
  // pair expanded last; from then on the nearest pair of all is next.
  bool take(double& key, Entry& entry) noexcept {
    if (has_next_ && next_key_ < nearest_.enough()) {
      has_next_ = false;
      key = next_key_;
      entry = next_;
      return true;
    }
    return frontier_.pop(nearest_.enough(), key, entry, [&](const Entry& waiting) {
      return nearest_.axes().squared_distance(extent_of(waiting, 0), extent_of(waiting, 1));
    });
  }

  // The extent of a subtree along the axes: what is known of it, or that of its box.
  [[nodiscard]] Box<double> extent_of(std::size_t side, NodeRef ref, bool is_leaf,
                                      const Box<double>& box) noexcept {
    const Box<double>* const known = nearest_.known(side).find(ref, is_leaf);
    return known ? *known : nearest_.axes().extent_of(side, box);
  }
  [[nodiscard]] Box<double> extent_of(const Entry& entry, std::size_t side) noexcept {
    return extent_of(side, entry.ref[side], entry.is_leaf[side], entry.box[side]);
  }

  Errc visit(const Entry& entry, double key) noexcept {
    if (entry.is_leaf[0] && entry.is_leaf[1]) {
      const Errc error = bound_.compare(entry.ref[0], entry.ref[1]);
      return error != Errc::kOk ? error : nearest_.compare(entry.ref[0], entry.ref[1], key);
    }
    // The larger box is expanded, a leaf never. A pair (a, b) is visited once: only one of the
    // pairs (parent of a, b) and (a, parent of b) arises, the one that their common parent pair
    // chose.
    const std::size_t s =
        !entry.is_leaf[0] && (entry.is_leaf[1] ||
                              extent(entry.box[0]) > extent(sides_[1].to_other.hull(entry.box[1])))
            ? 0
            : 1;
    const Side& side = sides_[s];
    const Side& other = sides_[1 - s];
    const OtherSubtree subtree{entry.box[1 - s], other.to_other.hull(entry.box[1 - s]),
                               extent_of(entry, 1 - s)};
    const Errc error = expand_with_gaps(side.tree, bound_, entry.ref[s], entry.box[s],
                                        {side.to_other, side.gaps, other.gaps, nearest_.axes(), s},
                                        subtree, children_, gaps_);
    return error != Errc::kOk ? error : queue_children(entry, s, key, subtree.extent);
  }

  // Puts child i in the place of its parent.
  void descend(Entry& entry, std::size_t s, std::uint32_t i) const noexcept {
    entry.box[s] = children_.box(i);
    entry.ref[s] = children_.ref[i];
    entry.is_leaf[s] = children_.is_leaf(i);
  }

  // A child is no nearer than its parent, of which more may be known: it was compared along other
  // axes, too. `other_extent`: of the other subtree.
  Errc queue_children(const Entry& entry, std::size_t s, double parent_key,
                      const Box<double>& other_extent) noexcept {
    const AlignedAxes& axes = nearest_.axes();
    // What is learnt does not depend on the allowed error: with a larger one, keys are the same.
    const double best = nearest_.best(), enough = nearest_.enough();
    // Before anything is found no axes are worth it.
    const bool has_axes = nearest_.has_any();
    Box<double> all = empty_box<double>();
    std::array<double, kWidth> key;
    std::array<std::uint32_t, kWidth> order;  // children that can matter, nearest first
    std::size_t passed = 0;
    for (std::uint32_t i = 0; i < children_.count; ++i) {
      double k = std::max(parent_key, gaps_.apart[i]);
      const NodeRef ref = children_.ref[i];
      const bool is_leaf = children_.is_leaf(i);
      Box<double> extent = gaps_.extent(i);
      bool is_known = true;
      if (has_axes) {
        const Box<double>* const known = nearest_.known(s).find(ref, is_leaf);
        is_known = known != nullptr;
        if (is_known) extent = *known;
        k = std::max(k, is_known ? axes.squared_distance(extent, other_extent) : gaps_.along[i]);
      }
      // A leaf that may matter is read now: it will meet many others.
      if (k < best && is_leaf && !is_known) {
        const Errc error = nearest_.find_extent(s, ref, extent);
        if (error != Errc::kOk) return error;
        k = std::max(k, axes.squared_distance(extent, other_extent));
      }
      if (has_axes) expand(all, extent);
      if (!(k < enough)) {
        nearest_.leave(k);
        continue;
      }
      std::size_t place = passed++;
      for (; place > 0 && key[place - 1] > k; --place) {
        key[place] = key[place - 1];
        order[place] = order[place - 1];
      }
      key[place] = k;
      order[place] = i;
    }
    // The node holds nothing but its children.
    if (has_axes) nearest_.known(s).keep(entry.ref[s], false, all);
    const bool goes_down = passed > 0 && !has_axes;
    // Farthest first: of equal keys the one pushed last is taken first.
    Entry child = entry;
    for (std::size_t n = passed; n-- > 0;) {
      descend(child, s, order[n]);
      if (n == 0 && goes_down) {
        next_ = child;
        next_key_ = key[0];
        has_next_ = true;
      } else if (!frontier_.push(key[n], enough, child)) {
        return Errc::kDepthExceeded;
      }
    }
    return Errc::kOk;
  }

  [[nodiscard]] static double extent(const Box<double>& box) noexcept {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += box.high[k] - box.low[k];
    return sum;
  }

  std::array<Side, 2> sides_;
  const WorldMetric& metric_;
  const std::uint64_t node_budget_;
  PairBound bound_;
  std::uint64_t visited_ = 0;
  bool is_spent_ = false;
  NearestTriangles nearest_;
  ErasedCodec::Children children_;  // of the node that was expanded last
  ChildGaps gaps_;
  bool has_next_ = false;
  double next_key_ = 0;
  Entry next_;
  Frontier<Entry, kQueue, kStack> frontier_;
};

}  // namespace boxtree
