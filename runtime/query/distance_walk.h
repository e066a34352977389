// SPDX-License-Identifier: MIT
// The search for the distance of two trees, over any pair of codecs. Implements boxtree/distance.h.
//
// Every pair of nodes has a key, the squared lower bound of its boxes' distance, never above that
// of anything inside. Pairs are expanded in the order of their keys, so a larger allowed error
// expands the same pairs in the same order and stops sooner. The answer's lower bound is the least
// of the keys of all skipped pairs and of the bounds of all triangles compared.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "runtime/primitive/rounding.h"
#include "runtime/query/nearest_triangles.h"
#include "runtime/query/pair_walk.h"
#include "runtime/query/relative_pose.h"
#include "runtime/query/world_metric.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/frontier.h"
#include "runtime/walk/traversal.h"

namespace boxtree {

/// One query. Everything passed by reference must outlive it.
template <NodeDecoder A, NodeDecoder B>
class DistanceWalk {
 public:
  /// `approximation` is in the metric's units.
  DistanceWalk(const BoundTree& first, const A& first_codec, const BoundTree& second,
               const B& second_codec, const RelativePose& pose, const WorldMetric& metric,
               const Approximation& approximation) noexcept
      : first_(first),
        second_(second),
        first_codec_(first_codec),
        second_codec_(second_codec),
        pose_(pose),
        metric_(metric),
        node_budget_(approximation.node_budget),
        bound_(first, second, nullptr),
        nearest_(first, second, pose, metric, approximation) {}

  Errc run() noexcept {
    const Entry root{root_box<typename A::Scalar>(first_),
                     root_box<typename B::Scalar>(second_),
                     first_.root_ref(),
                     second_.root_ref(),
                     first_.is_leaf(),
                     second_.is_leaf()};
    const Box<double> image = pose_.hull_in_first(root.second_box);
    nearest_.face(metric_.to_world(center(image) - center(root.first_box)));
    const double root_key = std::max({metric_.in_first().squared_distance(root.first_box, image),
                                      metric_.in_second().squared_distance(
                                          pose_.to_second().hull(root.first_box), root.second_box),
                                      nearest_.direction().squared_distance(
                                          nearest_.direction().end_of_first(root.first_box),
                                          nearest_.direction().end_of_second(root.second_box))});
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
      const Errc error = visit(entry);
      if (error != Errc::kOk) return error;
    }
    return Errc::kOk;
  }

  [[nodiscard]] const NearestPair& nearest() const noexcept { return nearest_.pair(); }
  [[nodiscard]] std::uint64_t visited() const noexcept { return visited_; }
  [[nodiscard]] bool is_spent() const noexcept { return is_spent_; }
  /// The lower bound of the distance. The root of a rounded square may be above the square by a
  /// factor of 1 + u.
  [[nodiscard]] double lower() const noexcept {
    constexpr double kLess = 1 - 2 * kRoundoffF64;
    const double left = std::sqrt(std::min(nearest_.left(), frontier_.least_left())) * kLess;
    return std::min({left, nearest_.pair().lower, nearest_.pair().upper});
  }

 private:
  struct Entry {
    Box<typename A::Scalar> first_box;
    Box<typename B::Scalar> second_box;
    NodeRef first;
    NodeRef second;
    bool first_leaf;
    bool second_leaf;
  };
  // One side is expanded at a time: a path is as long as the depths of both trees together, and
  // each step leaves all but one child of a node pending.
  static constexpr std::size_t kQueue = 2048;
  static constexpr std::size_t kStack =
      A::kDepthLimit * (A::Children::kWidth - 1) + B::kDepthLimit * (B::Children::kWidth - 1) + 1;
  static constexpr std::size_t kWidth = std::max(A::Children::kWidth, B::Children::kWidth);

  // Until some triangles have been compared the walk is depth-first, to the nearest child of the
  // pair expanded last; from then on the nearest pair of all is next.
  bool take(double& key, Entry& entry) noexcept {
    if (has_next_ && next_key_ < nearest_.enough()) {
      has_next_ = false;
      key = next_key_;
      entry = next_;
      return true;
    }
    return frontier_.pop(nearest_.enough(), key, entry);
  }

  Errc visit(const Entry& entry) noexcept {
    if (entry.first_leaf && entry.second_leaf) {
      const Errc error = bound_.compare(entry.first, entry.second);
      return error != Errc::kOk ? error : nearest_.compare(entry.first, entry.second);
    }
    // The larger box is expanded, a leaf never. A pair (a, b) is visited once: only one of the
    // pairs (parent of a, b) and (a, parent of b) arises, the one that their common parent pair
    // chose.
    const Box<double> image = pose_.hull_in_first(entry.second_box);
    if (!entry.first_leaf && (entry.second_leaf || extent(entry.first_box) > extent(image))) {
      const Errc error =
          bound_.count(first_codec_.expand(entry.first, entry.first_box, first_children_));
      if (error != Errc::kOk) return error;
      const double second_end = nearest_.direction().end_of_second(entry.second_box);
      return intersect_children(
          first_children_,
          [&](const Box<typename A::Scalar>& box) {
            double key = nearest_.direction().squared_distance(
                nearest_.direction().end_of_first(box), second_end);
            if (!(key < nearest_.enough())) return key;
            key = std::max(key, metric_.in_first().squared_distance(box, image));
            if (!(key < nearest_.enough())) return key;
            return std::max(key, metric_.in_second().squared_distance(pose_.to_second().hull(box),
                                                                      entry.second_box));
          },
          [&](std::uint32_t i) {
            return Entry{first_children_.box(i), entry.second_box,           first_children_.ref[i],
                         entry.second,           first_children_.is_leaf(i), entry.second_leaf};
          });
    }
    const Errc error =
        bound_.count(second_codec_.expand(entry.second, entry.second_box, second_children_));
    if (error != Errc::kOk) return error;
    const Box<double> first_image = pose_.to_second().hull(entry.first_box);
    const double first_end = nearest_.direction().end_of_first(entry.first_box);
    return intersect_children(
        second_children_,
        [&](const Box<typename B::Scalar>& box) {
          double key = nearest_.direction().squared_distance(
              first_end, nearest_.direction().end_of_second(box));
          if (!(key < nearest_.enough())) return key;
          key = std::max(key, metric_.in_second().squared_distance(first_image, box));
          if (!(key < nearest_.enough())) return key;
          return std::max(
              key, metric_.in_first().squared_distance(entry.first_box, pose_.hull_in_first(box)));
        },
        [&](std::uint32_t i) {
          return Entry{entry.first_box,  second_children_.box(i),
                       entry.first,      second_children_.ref[i],
                       entry.first_leaf, second_children_.is_leaf(i)};
        });
  }

  template <class Children, class Key, class Make>
  Errc intersect_children(const Children& children, Key key_of, Make make) noexcept {
    std::array<double, kWidth> key;
    std::array<std::uint32_t, kWidth> order;  // children that can matter, nearest first
    std::size_t passed = 0;
    for (std::uint32_t i = 0; i < children.count; ++i) {
      const double k = key_of(children.box(i));
      if (!(k < nearest_.enough())) {
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
    const bool goes_down = passed > 0 && !nearest_.has_any();
    // Farthest first: of equal keys the one pushed last is taken first.
    for (std::size_t n = passed; n-- > (goes_down ? 1u : 0u);) {
      if (!frontier_.push(key[n], nearest_.enough(), make(order[n]))) return Errc::kDepthExceeded;
    }
    if (goes_down) {
      next_ = make(order[0]);
      next_key_ = key[0];
      has_next_ = true;
    }
    return Errc::kOk;
  }

  template <class S>
  [[nodiscard]] static Eigen::Vector3d center(const Box<S>& box) noexcept {
    Eigen::Vector3d middle;
    for (std::size_t k = 0; k < 3; ++k) {
      middle[static_cast<Eigen::Index>(k)] = 0.5 * double{box.low[k]} + 0.5 * double{box.high[k]};
    }
    return middle;
  }

  template <class S>
  [[nodiscard]] static double extent(const Box<S>& box) noexcept {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += double{box.high[k]} - double{box.low[k]};
    return sum;
  }

  const BoundTree& first_;
  const BoundTree& second_;
  const A first_codec_;
  const B second_codec_;
  const RelativePose& pose_;
  const WorldMetric& metric_;
  const std::uint64_t node_budget_;
  PairBound bound_;
  std::uint64_t visited_ = 0;
  bool is_spent_ = false;
  NearestTriangles nearest_;
  bool has_next_ = false;
  double next_key_ = 0;
  Entry next_;
  typename A::Children first_children_;
  typename B::Children second_children_;
  Frontier<Entry, kQueue, kStack> frontier_;
};

}  // namespace boxtree
