// SPDX-License-Identifier: MIT
// The original's collision test: descends both trees together and compares boxes on six axes.
// Intervals are updated cut by cut instead of being recomputed.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "runtime/primitive/predicates.h"
#include "tests/bench/original_tree.h"

namespace boxtree::bench {

/// Receives the steps of a walk; this one ignores them.
struct NoTrace {
  void node(const OriginalNode*) {}
  void pair() {}
  void leaf_test(const OriginalNode::Leaf&, const OriginalNode::Leaf&) {}
};

/// One collision test of two trees; a rigid pose places the second one.
/// Visitor: (polygon of the first, polygon of the second) -> whether to go on.
template <class Visitor, class Trace = NoTrace>
class OriginalPairs {
 public:
  OriginalPairs(const OriginalTree& first, const OriginalTree& second, const Pose& pose,
                Visitor visitor, Trace trace = {})
      : pose_(pose), visitor_(std::move(visitor)), trace_(std::move(trace)) {
    to_first_ = pose.linear().cast<float>();
    to_second_ = to_first_.transpose();
    const Eigen::Vector3f back = -(to_second_ * pose.translation().cast<float>());
    const Intervals e = root_intervals(first.root_box(), to_second_, back, 0);
    const Intervals f =
        root_intervals(second.root_box(), to_first_, pose.translation().cast<float>(), 3);
    if (first.root() == nullptr || second.root() == nullptr) return;
    for (std::size_t i = 0; i < 6; ++i) {
      if (e.low[i] > f.high[i] || f.low[i] > e.high[i]) return;
    }
    check(first.root(), e, second.root(), f);
  }

 private:
  // Axes 0-2 are the first tree's, 3-5 the second's.
  struct Intervals {
    std::array<float, 6> low;
    std::array<float, 6> high;
  };
  // For one side: the indices of its own and the other's axes, and its own axes in the other's
  // frame.
  struct Frames {
    std::size_t own;
    std::size_t other;
    const Eigen::Matrix3f* onto_other;
  };
  [[nodiscard]] Frames first_frames() const { return {0, 3, &to_second_}; }
  [[nodiscard]] Frames second_frames() const { return {3, 0, &to_first_}; }

  // Every interval is widened once by the original's 1e-6 of its largest coordinate, its allowance
  // for the rounding of all later updates.
  static Intervals root_intervals(const Box<float>& box, const Eigen::Matrix3f& onto_other,
                                  const Eigen::Vector3f& translation, std::size_t own) {
    constexpr float kInflation = 1e-6f;
    const std::size_t other = 3 - own;
    Intervals out{};
    for (std::size_t i = 0; i < 3; ++i) {
      out.low[own + i] = box.low[i];
      out.high[own + i] = box.high[i];
      float low = translation[static_cast<Eigen::Index>(i)];
      float high = low;
      for (std::size_t j = 0; j < 3; ++j) {
        const float b = onto_other(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        low += std::min(b * box.low[j], b * box.high[j]);
        high += std::max(b * box.low[j], b * box.high[j]);
      }
      out.low[other + i] = low;
      out.high[other + i] = high;
    }
    float largest = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      largest = std::max({largest, std::abs(out.low[i]), std::abs(out.high[i])});
    }
    for (std::size_t i = 0; i < 6; ++i) {
      out.low[i] -= kInflation * largest;
      out.high[i] += kInflation * largest;
    }
    return out;
  }

  // Entering a child moves one bound on its own axis and one on each axis of the other tree.
  static Intervals entered(const Intervals& from, const Frames& frames, std::size_t axis,
                           std::size_t side, float cut) {
    Intervals to = from;
    if (side == 0) {
      to.high[frames.own + axis] -= cut;
    } else {
      to.low[frames.own + axis] += cut;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const float b =
          (*frames.onto_other)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(axis));
      const float step = side == 0 ? -(cut * b) : cut * b;
      if ((b > 0) == (side == 0)) {
        to.high[frames.other + i] += step;
      } else {
        to.low[frames.other + i] += step;
      }
    }
    return to;
  }

  // Whether one of the four bounds that entered() moved has left the other side's interval.
  static bool moved_apart(const Intervals& moved, const Intervals& still, const Frames& frames,
                          std::size_t axis, std::size_t side) {
    const std::size_t own = frames.own + axis;
    bool apart = side == 0 ? moved.high[own] < still.low[own] : moved.low[own] > still.high[own];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t other = frames.other + i;
      const float b =
          (*frames.onto_other)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(axis));
      apart |= (b > 0) == (side == 0) ? moved.high[other] < still.low[other]
                                      : moved.low[other] > still.high[other];
    }
    return apart;
  }

  // Returns whether to continue. The recursion is as deep as both trees together.
  bool check(const OriginalNode* e, const Intervals& ei, const OriginalNode* f,
             const Intervals& fi) {
    trace_.pair();
    trace_.node(e);
    trace_.node(f);
    if (e->is_leaf()) {
      if (f->is_leaf()) return test_leaves(e->leaf, f->leaf);
      for (std::size_t side = 0; side < 2; ++side) {
        const OriginalNode* const child = f->inner.child[side];
        if (child == nullptr) continue;
        const Intervals ci = entered(fi, second_frames(), f->cutplane, side, f->inner.cut[side]);
        if (moved_apart(ci, ei, second_frames(), f->cutplane, side)) continue;
        if (!check(e, ei, child, ci)) return false;
      }
      return true;
    }
    std::array<Intervals, 2> first;
    std::array<bool, 2> first_intersects{};
    for (std::size_t side = 0; side < 2; ++side) {
      if (e->inner.child[side] == nullptr) continue;
      first[side] = entered(ei, first_frames(), e->cutplane, side, e->inner.cut[side]);
      first_intersects[side] = !moved_apart(first[side], fi, first_frames(), e->cutplane, side);
    }
    if (f->is_leaf()) {
      for (std::size_t side = 0; side < 2; ++side) {
        if (first_intersects[side] && !check(e->inner.child[side], first[side], f, fi))
          return false;
      }
      return true;
    }
    for (std::size_t right = 0; right < 2; ++right) {
      const OriginalNode* const child = f->inner.child[right];
      if (child == nullptr) continue;
      const Intervals second =
          entered(fi, second_frames(), f->cutplane, right, f->inner.cut[right]);
      for (std::size_t left = 0; left < 2; ++left) {
        if (!first_intersects[left] ||
            moved_apart(second, first[left], second_frames(), f->cutplane, right)) {
          continue;
        }
        if (!check(e->inner.child[left], first[left], child, second)) return false;
      }
    }
    return true;
  }

  // Transforms the second polygon again for every pair of leaves, as the original does.
  bool test_leaves(const OriginalNode::Leaf& e, const OriginalNode::Leaf& f) {
    trace_.leaf_test(e, f);
    for (std::size_t i = 2; i < 4 && e.point[i] != kNoPoint; ++i) {
      const Triangle here{{point(e, 0), point(e, i - 1), point(e, i)}};
      for (std::size_t j = 2; j < 4 && f.point[j] != kNoPoint; ++j) {
        const Triangle there{{pose_ * point(f, 0), pose_ * point(f, j - 1), pose_ * point(f, j)}};
        if (triangles_intersect(here, there)) return visitor_(e.polygon, f.polygon);
      }
    }
    return true;
  }

  static Eigen::Vector3d point(const OriginalNode::Leaf& leaf, std::size_t i) {
    return leaf.points[leaf.point[i]].cast<double>();
  }

  Pose pose_;
  Eigen::Matrix3f to_first_;
  Eigen::Matrix3f to_second_;
  Visitor visitor_;
  Trace trace_;
};

}  // namespace boxtree::bench
