// SPDX-License-Identifier: MIT
// The search for the distance of two trees, over any pair of codecs. Behind
// runtime/query/distance.h.
//
// Every pair of nodes has a key, the squared lower bound of its boxes' distance, never above that
// of anything inside. Pairs are taken apart in the order of their keys, so a walk that may err more
// takes the same pairs apart in the same order and stops sooner. The answer's lower bound is the
// least of the keys of all pairs that were left alone and of the bounds of all triangles compared.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include <boxtree/runtime/primitive/predicates.h>
#include <boxtree/runtime/query/distance.h>
#include <boxtree/runtime/query/frontier.h>
#include <boxtree/runtime/query/pair_walk.h>
#include <boxtree/runtime/query/relative_pose.h>
#include <boxtree/runtime/query/traversal.h>
#include <boxtree/runtime/query/world_metric.h>

namespace boxtree {

/// The nearest pair of triangles so far, in the metric's units.
struct NearestPair {
  double lower = std::numeric_limits<double>::infinity();  // of all triangles compared
  double upper = std::numeric_limits<double>::infinity();
  FacePair faces{};
  Eigen::Vector3d origin;  // first tree's space; the points are differences from here
  Eigen::Vector3d first;
  Eigen::Vector3d second;
};

/// One query. Everything passed by reference must outlive it.
template <Codec A, Codec B>
class DistanceWalk {
 public:
  /// `approximation` is in the metric's units.
  DistanceWalk(const Tree& first, const A& first_codec, const Tree& second, const B& second_codec,
               const RelativePose& pose, const WorldMetric& metric,
               const Approximation& approximation) noexcept
      : first_(first),
        second_(second),
        first_codec_(first_codec),
        second_codec_(second_codec),
        pose_(pose),
        metric_(metric),
        approximation_(approximation),
        unmet_(most_pairs(first.record(), second.record())) {
    set_enough();
  }

  Errc run() noexcept {
    const Entry root{root_box<typename A::Scalar>(first_),
                     root_box<typename B::Scalar>(second_),
                     first_.root_ref(),
                     second_.root_ref(),
                     first_.record().root == RootKind::kLeaf,
                     second_.record().root == RootKind::kLeaf};
    const Box<double> image = pose_.hull_in_first(root.second_box);
    face(metric_.to_world(center(image) - center(root.first_box)));
    const double root_key =
        std::max({metric_.in_first().squared_distance(root.first_box, image),
                  metric_.in_second().squared_distance(pose_.to_second().hull(root.first_box),
                                                       root.second_box),
                  direction_.squared_distance(direction_.end_of_first(root.first_box),
                                              direction_.end_of_second(root.second_box))});
    if (!frontier_.push(root_key, enough_, root)) return Errc::kInternal;
    double key = 0;
    Entry entry;
    while (take(key, entry)) {
      if (visited_ == approximation_.node_budget) {
        left_ = std::min(left_, key);
        is_spent_ = true;
        break;
      }
      ++visited_;
      if (unmet_-- == 0) return Errc::kNodeCorrupt;
      const Errc error = visit(entry);
      if (error != Errc::kOk) return error;
    }
    return Errc::kOk;
  }

  [[nodiscard]] const NearestPair& nearest() const noexcept { return nearest_; }
  [[nodiscard]] std::uint64_t visited() const noexcept { return visited_; }
  [[nodiscard]] bool is_spent() const noexcept { return is_spent_; }
  /// The lower bound of the distance. The root of a rounded square may be above the square by a
  /// factor of 1 + u.
  [[nodiscard]] double lower() const noexcept {
    constexpr double kLess = 1 - std::numeric_limits<double>::epsilon();
    const double left = std::sqrt(std::min(left_, frontier_.least_left())) * kLess;
    return std::min({left, nearest_.lower, nearest_.upper});
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
  // One side goes down at a time: a path is as long as both trees are deep, and a step leaves all
  // but one child of a node pending.
  static constexpr std::size_t kQueue = 2048;
  static constexpr std::size_t kStack =
      A::kDepthLimit * (A::Children::kWidth - 1) + B::kDepthLimit * (B::Children::kWidth - 1) + 1;
  static constexpr std::size_t kWidth = std::max(A::Children::kWidth, B::Children::kWidth);

  // Until some triangles have been compared the walk goes straight down, to the nearest child of
  // the pair taken apart last; from then on the nearest pair of all is next.
  bool take(double& key, Entry& entry) noexcept {
    if (has_next_ && next_key_ < enough_) {
      has_next_ = false;
      key = next_key_;
      entry = next_;
      return true;
    }
    return frontier_.pop(enough_, key, entry);
  }

  // Squares of what need not be looked at: what is near enough to the best, or too far.
  void set_enough() noexcept {
    const double enough = approximation_.enough(nearest_.upper);
    // The neighbour above: what is exactly at the maximal distance counts.
    const double most = std::nextafter(approximation_.max_distance * approximation_.max_distance,
                                       std::numeric_limits<double>::infinity());
    enough_ = std::min(enough * enough, most);
    best_ = std::min(nearest_.upper * nearest_.upper, most);
  }

  Errc visit(const Entry& entry) noexcept {
    if (entry.first_leaf && entry.second_leaf) return compare(entry);
    // The larger box is taken apart, a leaf never. A pair (a, b) is met once: only one of the pairs
    // (parent of a, b) and (a, parent of b) arises, by what their common parent pair chose.
    const Box<double> image = pose_.hull_in_first(entry.second_box);
    if (!entry.first_leaf && (entry.second_leaf || extent(entry.first_box) > extent(image))) {
      if (!first_codec_.expand(entry.first, entry.first_box, first_children_)) {
        return Errc::kNodeCorrupt;
      }
      const double second_end = direction_.end_of_second(entry.second_box);
      return meet_children(
          first_children_,
          [&](const Box<typename A::Scalar>& box) {
            double key = direction_.squared_distance(direction_.end_of_first(box), second_end);
            if (!(key < enough_)) return key;
            key = std::max(key, metric_.in_first().squared_distance(box, image));
            if (!(key < enough_)) return key;
            return std::max(key, metric_.in_second().squared_distance(pose_.to_second().hull(box),
                                                                      entry.second_box));
          },
          [&](std::uint32_t i) {
            return Entry{first_children_.box(i), entry.second_box,           first_children_.ref[i],
                         entry.second,           first_children_.is_leaf(i), entry.second_leaf};
          });
    }
    if (!second_codec_.expand(entry.second, entry.second_box, second_children_)) {
      return Errc::kNodeCorrupt;
    }
    const Box<double> first_image = pose_.to_second().hull(entry.first_box);
    const double first_end = direction_.end_of_first(entry.first_box);
    return meet_children(
        second_children_,
        [&](const Box<typename B::Scalar>& box) {
          double key = direction_.squared_distance(first_end, direction_.end_of_second(box));
          if (!(key < enough_)) return key;
          key = std::max(key, metric_.in_second().squared_distance(first_image, box));
          if (!(key < enough_)) return key;
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
  Errc meet_children(const Children& children, Key key_of, Make make) noexcept {
    std::array<double, kWidth> key;
    std::array<std::uint32_t, kWidth> order;  // children that count, nearest first
    std::size_t passed = 0;
    for (std::uint32_t i = 0; i < children.count; ++i) {
      const double k = key_of(children.box(i));
      if (!(k < enough_)) {
        left_ = std::min(left_, k);
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
    const bool goes_down = passed > 0 && nearest_.upper == std::numeric_limits<double>::infinity();
    // Farthest first: of equal keys the one pushed last is taken first.
    for (std::size_t n = passed; n-- > (goes_down ? 1u : 0u);) {
      if (!frontier_.push(key[n], enough_, make(order[n]))) return Errc::kDepthExceeded;
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

  // The triangles of two leaves; those whose bounds are as far as the best are left alone. Not
  // those that are near enough to it: then what is found in a leaf would depend on the error
  // allowed, and a walk that may err more could miss what ends another one early.
  Errc compare(const Entry& entry) noexcept {
    if (const Errc error = read(entry); error != Errc::kOk) return error;
    const GapWeights& gaps = metric_.in_first();
    set_ends();
    for (std::uint32_t i = 0; i < first_batch_.count; ++i) {
      const double to_leaf = gaps.squared_distance(first_bounds_[i], second_bounds_);
      if (!(to_leaf < best_)) {
        left_ = std::min(left_, to_leaf);
        continue;
      }
      const Triangle triangle = first_batch_.triangle(i);
      for (std::uint32_t j = 0; j < second_batch_.count; ++j) {
        const double key = std::max(direction_.squared_distance(first_end_[i], second_end_[j]),
                                    gaps.squared_distance(first_bounds_[i], moved_bounds_[j]));
        if (!(key < best_)) {
          left_ = std::min(left_, key);
          continue;
        }
        compare(triangle, i, moved_[j], j);
      }
    }
    return Errc::kOk;
  }

  // Where the triangles of the leaves at hand end along the direction.
  void set_ends() noexcept {
    for (std::uint32_t i = 0; i < first_batch_.count; ++i) {
      first_end_[i] = direction_.end_of_first(first_batch_.triangle(i));
    }
    for (std::uint32_t j = 0; j < second_batch_.count; ++j) {
      second_end_[j] = direction_.end_of_moved(moved_[j]);
    }
  }

  // From now on boxes are compared along this vector of the world, too.
  void face(const Eigen::Vector3d& along) noexcept { direction_ = metric_.direction(along, pose_); }

  // Corners are taken as differences from one of them, so that rounding is that of the triangles'
  // size and distance and not of their place.
  void compare(const Triangle& p, std::uint32_t i, const Triangle& q, std::uint32_t j) noexcept {
    const Eigen::Vector3d& origin = p.corner[0];
    Triangle p_world, q_world;
    double reach = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Vector3d to_p = p.corner[c] - origin;
      const Eigen::Vector3d to_q = q.corner[c] - origin;
      reach = std::max({reach, to_p.cwiseAbs().maxCoeff(), to_q.cwiseAbs().maxCoeff()});
      p_world.corner[c] = metric_.to_world(to_p);
      q_world.corner[c] = metric_.to_world(to_q);
    }
    TriangleDistance found = triangle_distance(p_world, q_world);
    // Both triangles may lie off by the error of their corners.
    const double error = 2 * metric_.image_error() * reach;
    found.lower = std::max(0.0, found.lower - error);
    found.upper += error;
    if (!(found.lower > 0) && triangles_intersect(p, q)) found.lower = found.upper = 0;
    nearest_.lower = std::min(nearest_.lower, found.lower);
    if (!(found.upper < nearest_.upper)) return;
    nearest_.upper = found.upper;
    nearest_.faces = {face_ref(first_, first_batch_.face[i]),
                      face_ref(second_, second_batch_.face[j])};
    nearest_.origin = origin;
    nearest_.first = found.first;
    nearest_.second = found.second;
    set_enough();
    face(found.second - found.first);
    set_ends();
  }

  // Leaves are often met several times in a row; what was read of the last ones stays.
  Errc read(const Entry& entry) noexcept {
    if (!(entry.first == first_read_)) {
      first_read_ = kNone;
      const Errc error = first_.leaves().read(entry.first.first, entry.first.second, first_batch_);
      if (error != Errc::kOk) return error;
      for (std::uint32_t i = 0; i < first_batch_.count; ++i) {
        first_bounds_[i] = bounds_of(first_batch_.triangle(i));
      }
      first_read_ = entry.first;
    }
    if (entry.second == second_read_) return Errc::kOk;
    second_read_ = kNone;
    const Errc error =
        second_.leaves().read(entry.second.first, entry.second.second, second_batch_);
    if (error != Errc::kOk) return error;
    second_bounds_ = empty_box<double>();
    for (std::uint32_t j = 0; j < second_batch_.count; ++j) {
      const Triangle triangle = second_batch_.triangle(j);
      for (std::size_t c = 0; c < 3; ++c) {
        moved_[j].corner[c] = pose_.to_first().apply(triangle.corner[c]);
        if (!is_within_reach(moved_[j].corner[c])) return Errc::kVertexNotFinite;
      }
      moved_bounds_[j] = bounds_of(moved_[j]);
      boxtree::expand(second_bounds_, moved_bounds_[j]);
    }
    second_read_ = entry.second;
    return Errc::kOk;
  }

  const Tree& first_;
  const Tree& second_;
  const A first_codec_;
  const B second_codec_;
  const RelativePose& pose_;
  const WorldMetric& metric_;
  const Approximation& approximation_;
  std::uint64_t unmet_;
  std::uint64_t visited_ = 0;
  bool is_spent_ = false;
  double enough_ = 0;                                      // squared
  double best_ = 0;                                        // likewise, were no error allowed
  double left_ = std::numeric_limits<double>::infinity();  // least key left alone, squared
  NearestPair nearest_;
  Direction direction_;  // between the nearest points so far; first, between the trees
  bool has_next_ = false;
  double next_key_ = 0;
  Entry next_;
  typename A::Children first_children_;
  typename B::Children second_children_;
  static constexpr NodeRef kNone{0xffffffffu, 0xffffffffu};
  NodeRef first_read_ = kNone;  // the leaf that first_batch_ holds
  NodeRef second_read_ = kNone;
  TriangleBatch first_batch_;
  TriangleBatch second_batch_;
  std::array<Box<double>, kMaxLeafTriangles> first_bounds_;
  std::array<Triangle, kMaxLeafTriangles> moved_;  // the second leaf in the first tree's space
  std::array<Box<double>, kMaxLeafTriangles> moved_bounds_;
  Box<double> second_bounds_;
  std::array<double, kMaxLeafTriangles> first_end_;
  std::array<double, kMaxLeafTriangles> second_end_;
  Frontier<Entry, kQueue, kStack> frontier_;
};

}  // namespace boxtree
