// SPDX-License-Identifier: MIT
// Walks that end when two objects are known to be close. Every box holds a part of its surface, so
// two boxes whose farthest points are within a distance hold parts that are, too; likewise
// triangles with corners that are.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <boxtree/overlap.h>

#include "runtime/primitive/float_state.h"
#include "runtime/primitive/predicates.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/vector3.h"
#include "runtime/query/invalid_query.h"
#include "runtime/query/pair_walk.h"
#include "runtime/query/scaled_length.h"
#include "runtime/query/shape_query.h"
#include "runtime/query/world_metric.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/read_leaf.h"

namespace boxtree {
namespace {

// Rounding of a sum of three squares and its root, upward.
constexpr double kRoundedUp = 1 + 16 * kRoundoffF64;

// The parameters of a watched pair walk, and why it ended.
struct Watch {
  const RelativePose& pose;
  const WorldMetric& metric;
  double distance;  // in the metric's units
  std::uint64_t budget;
  std::uint64_t visited = 0;
  Overlap why = Overlap::kDisjoint;
};

struct Watcher {
  Watch* watch;

  void node_pair(NodeRef, bool, NodeRef, bool) noexcept {}
  void leaf_pair(NodeRef, NodeRef) noexcept {}

  template <class S, class T>
  [[nodiscard]] bool stops(const Box<S>& first, const Box<T>& second) noexcept {
    if (watch->metric.farthest(first, watch->pose.hull_in_first(second)) * kRoundedUp <
        watch->distance) {
      watch->why = Overlap::kUndecided;
      return true;
    }
    if (watch->visited == watch->budget) {
      watch->why = Overlap::kBudgetSpent;
      return true;
    }
    ++watch->visited;
    return false;
  }

  // Compares one corner of each; their bounds are close already.
  [[nodiscard]] bool stops(const Triangle& first, const Triangle& second) const noexcept {
    const Eigen::Vector3d between = second.corner[0] - first.corner[0];
    const double error =
        watch->metric.image_error() * between.cwiseAbs().maxCoeff() + kLengthUnderflow;
    if (!(std::sqrt(squared_length(watch->metric.to_world(between))) * kRoundedUp + error <
          watch->distance))
      return false;
    watch->why = Overlap::kUndecided;
    return true;
  }
};

// Whether nodes have at most two children; a tree without nodes counts as either.
bool is_binary(const BoundTree& tree) noexcept {
  return tree.codec_functions().width <= ErasedBinaryCodec::Children::kWidth;
}

template <NodeDecoder C>
Result<Visit> walk(const BoundTree& first, const BoundTree& second, Watch& watch,
                   PairVisitor visitor) {
  PairBound bound(first, second, nullptr);
  return PairWalk<C, C, Watcher>(first, C{&first}, second, C{&second}, watch.pose, visitor, bound,
                                 Watcher{&watch})
      .run();
}

// A box among the nodes of one tree, in tree space.
struct BoxSearch {
  const BoundTree& tree;
  const BoxQuery& box;
  double distance;
  std::uint64_t budget;
  BoxOverlap result;
  TriangleBatch batch;

  // Distance of the farthest point of a node's box from the query's box.
  template <class S>
  [[nodiscard]] double farthest(const Box<S>& node) const noexcept {
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      const double outside =
          std::max({0.0, box.low[axis] - node.low[k], node.high[k] - box.high[axis]});
      sum += outside * outside;
    }
    return std::sqrt(sum) * kRoundedUp + kLengthUnderflow;
  }

  // Whether the search is over before this node or leaf is visited.
  template <class S>
  [[nodiscard]] bool stops(const Box<S>& node) noexcept {
    if (farthest(node) < distance) {
      result.overlap = Overlap::kUndecided;
      return true;
    }
    if (result.nodes_expanded == budget) {
      result.overlap = Overlap::kBudgetSpent;
      return true;
    }
    ++result.nodes_expanded;
    return false;
  }

  [[nodiscard]] Errc leaf(NodeRef ref) noexcept {
    const Errc error = read_leaf(tree, ref, batch);
    if (error != Errc::kOk) return error;
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      const Triangle triangle = batch.triangle(i);
      const Box<double> bounds = bounds_of(triangle);
      if (!box.overlaps(bounds)) continue;
      if (!triangle_intersects_box(triangle, box.low, box.high)) {
        const Eigen::Vector3d& c = triangle.corner[0];
        const std::array<double, 3> corner{c[0], c[1], c[2]};
        if (!(farthest(Box<double>{corner, corner}) < distance)) continue;
        result.overlap = Overlap::kUndecided;
        break;
      }
      result.overlap = Overlap::kOverlapping;
      result.face = face_ref(tree, batch.face[i]);
      break;
    }
    return Errc::kOk;
  }

  [[nodiscard]] Errc run() noexcept {
    const ErasedCodec codec{&tree};
    struct Entry {
      Box<double> node;
      NodeRef ref;
      bool is_leaf;
    };
    WalkStack<Entry, kStackSize<ErasedCodec>> stack;
    const Box<double> root = root_box<double>(tree);
    if (!box.overlaps(root)) return Errc::kOk;
    Errc error = stack.push({root, tree.root_ref(), tree.is_leaf()});
    WalkBound bound(tree.node_count());
    ErasedCodec::Children children;
    while (error == Errc::kOk && !stack.empty()) {
      const Entry entry = stack.pop();
      if (stops(entry.node)) return Errc::kOk;
      if (entry.is_leaf) {
        error = leaf(entry.ref);
        if (error != Errc::kOk || result.overlap != Overlap::kDisjoint) return error;
        continue;
      }
      error = bound.count(codec.expand(entry.ref, entry.node, children));
      if (error != Errc::kOk) return error;
      for (std::uint32_t i = 0; i < children.count; ++i) {
        const Box<double> child = children.box(i);
        if (!box.overlaps(child)) continue;
        error = stack.push({child, children.ref[i], children.is_leaf(i)});
        if (error != Errc::kOk) return error;
      }
    }
    return error;
  }
};

}  // namespace

Result<PairOverlap> overlap_within(const Tree& first_tree, const Pose& first_pose,
                                   const Tree& second_tree, const Pose& second_pose,
                                   double distance, std::uint64_t node_budget) {
  const DefaultFloatState state;
  const BoundTree& first = BoundTree::of(first_tree);
  const BoundTree& second = BoundTree::of(second_tree);
  if (!(distance >= 0)) return invalid_query("distance");
  const std::optional<RelativePose> pose =
      RelativePose::make(first, first_pose, second, second_pose);
  if (!pose) return Errc::kInvalidPose;
  const std::optional<WorldMetric> metric = WorldMetric::make(first, first_pose, second, *pose);
  if (!metric) return Errc::kInvalidPose;
  PairOverlap result;
  Watch watch{*pose, *metric, metric->from_world_below(distance), node_budget};
  const auto visitor = [&result](const FacePair& pair) {
    result.contact = pair;
    return false;
  };
  const bool binary = is_binary(first) && is_binary(second);
  const Result<Visit> visit = binary ? walk<ErasedBinaryCodec>(first, second, watch, visitor)
                                     : walk<ErasedCodec>(first, second, watch, visitor);
  if (!visit) return visit.error();
  result.overlap = result.contact ? Overlap::kOverlapping : watch.why;
  result.nodes_expanded = watch.visited;
  return result;
}

Result<BoxOverlap> overlap_box_within(const Tree& queried, const Eigen::AlignedBox3d& box,
                                      double distance, std::uint64_t node_budget) {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(queried);
  if (!is_finite_box(box)) return invalid_query("box");
  if (!(distance >= 0)) return invalid_query("distance");
  if (tree.empty()) return BoxOverlap();
  // Beyond kMaxCoordinate there is nothing to touch, and the predicates could overflow.
  const auto clamped = [&](const Eigen::Vector3d& corner) -> Eigen::Vector3d {
    return tree.frame().to_tree(corner).cwiseMax(-kMaxCoordinate).cwiseMin(kMaxCoordinate);
  };
  const BoxQuery query{clamped(box.min()), clamped(box.max())};
  BoxSearch search{tree,        query, scaled_below(distance, -tree.scale_exponent()),
                   node_budget, {},    {}};
  const Errc error = search.run();
  if (error != Errc::kOk) return error;
  return search.result;
}

}  // namespace boxtree
