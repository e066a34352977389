// SPDX-License-Identifier: MIT
// Batches of closest points over the wide codecs. Points go through a tree in packets: a node or
// leaf is decoded once for all points of a packet that reach it, and a box meets sixteen points
// side by side. The closest point does not depend on the order of a walk, so answers are those of
// points alone.
#include <algorithm>
#include <bit>
#include <iterator>
#include <optional>

#include "runtime/query/point_batch_query.h"
#include "runtime/query/point_filter.h"
#include "runtime/walk/packets.h"
#include "runtime/walk/targets.h"
#include "runtime/walk/walk_tree.h"

#ifndef HWY_TARGET_INCLUDE  // compiled alone
#define HWY_TARGET_INCLUDE "runtime/query/point_batch_wide.cpp"
#endif
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include "runtime/query/point_triangles-inl.h"
#include "runtime/walk/decode-inl.h"
#include "runtime/walk/prefetch-inl.h"
#include "runtime/walk/traversal_stack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
void walk_point_batch(PointBatch& batch) {
  for (std::size_t i = 0; i < batch.points.size(); ++i) batch.answer_alone(i);
}
#else
// A set of points of a packet: bit p is point p.
using PointSet = std::uint32_t;
constexpr std::uint32_t kMostPoints = 16;
static_assert(kMostPoints % kLanes == 0 && kMostPoints < 32);

// Of the children of a node: which points they may be near to, and lower bounds of the squared
// distances.
struct NearPoints {
  HWY_ALIGN float key[kWideChildren][kMostPoints];
  HWY_ALIGN float least[kWideChildren];  // of those points
  PointSet points[kWideChildren];
};

// The points that are in flight, and what of them does not depend on the codec.
class PointPacket {
 public:
  static constexpr std::size_t kMost = kMostPoints;

  explicit PointPacket(PointBatch& batch)
      : batch_(batch), root_(root_box<float>(batch.tree)), unused_(0), leaf_(batch.tree) {}

  // Takes the points of the batch from `first` on, `count` of them; those that are not valid, or so
  // far away that single precision resolves nothing, get their answers.
  HWY_NOINLINE void take(std::size_t first, std::size_t count) {
    first_ = first;
    points_ = found_ = 0;
    std::fill(std::begin(bound_), std::end(bound_), kNothing);
    const BoundTree& tree = batch_.tree;
    for (std::uint32_t p = 0; p < count; ++p) {
      const QueriedPoint in_tree(tree, batch_.points[first + p], batch_.max_distance);
      if (in_tree.invalid != nullptr || !PointFilter::is_near(tree.largest_abs(), in_tree.point)) {
        batch_.answer_alone(first + p);
        continue;
      }
      points_ |= 1u << p;
      filters_[p].emplace(tree.largest_abs(), in_tree.point);
      queries_[p].emplace(tree, unused_, in_tree.point, in_tree.most);
      bounds_[p].set(in_tree.most);
      bound_[p] = bounds_[p].squared;
      for (std::size_t k = 0; k < 3; ++k) {
        low_[k][p] = filters_[p]->low[k];
        high_[k][p] = filters_[p]->high[k];
      }
    }
    if (points_ != 0) bound_by(witnesses_, witness_count_);
  }

  // Those that are in flight, and those of them that the tree may be near to.
  [[nodiscard]] PointSet all() const { return points_; }
  [[nodiscard]] PointSet near_root() const {
    PointSet near = 0;
    for (PointSet rest = points_; rest != 0; rest &= rest - 1) {
      const auto p = static_cast<std::uint32_t>(std::countr_zero(rest));
      const PointQuery& query = *queries_[p];
      if (query.key(root_) <= query.bound()) near |= 1u << p;
    }
    return near;
  }
  [[nodiscard]] const Box<float>& root() const { return root_; }

  // Walks the tree for each point by itself.
  HWY_NOINLINE void walk_alone(std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i) batch_.answer_alone(i);
  }

  // Every point's answer, once the walk is over. `walked`: its error, which any of them may have
  // come upon.
  HWY_NOINLINE void answer(Errc walked) {
    witness_count_ = 0;
    for (PointSet rest = points_; rest != 0; rest &= rest - 1) {
      const auto p = static_cast<std::uint32_t>(std::countr_zero(rest));
      if (walked != Errc::kOk) {
        batch_.answer_alone(first_ + p);
        continue;
      }
      note_witness(*queries_[p]);
      batch_.answer(first_ + p, *queries_[p]);
    }
  }

  // Those of the points whose keys are not above their bounds.
  HWY_INLINE PointSet before_bound(PointSet points, const float* key) const {
    const Floats d;
    PointSet left = 0;
    for (std::size_t p = 0; p < kMostPoints; p += kLanes) {
      left |= bits_of(hn::Le(hn::Load(d, key + p), hn::Load(d, bound_ + p))) << p;
    }
    return points & left;
  }

  // Returns those of the `child_count` children of a node that one of `points`, those that may be
  // near to the node, may be near to. The keys are those of nearest_squared().
  HWY_INLINE std::uint32_t meet(const ChildBoxes& boxes, std::uint32_t child_count, PointSet points,
                                NearPoints& near) {
    if ((points & ~found_) != 0) bound_by(boxes, child_count);
    const Floats d;
    std::uint32_t passing = 0;
    for (std::uint32_t child = 0; child < kWideChildren; ++child) {
      PointSet bits = 0;
      FloatVector least = hn::Set(d, std::numeric_limits<float>::infinity());
      for (std::size_t p = 0; p < kMostPoints; p += kLanes) {
        FloatVector sum = hn::Zero(d);
        for (std::size_t k = 0; k < 3; ++k) {
          const FloatVector below =
              hn::Sub(hn::Set(d, boxes.low[k][child]), hn::Load(d, high_[k] + p));
          const FloatVector above =
              hn::Sub(hn::Load(d, low_[k] + p), hn::Set(d, boxes.high[k][child]));
          const FloatVector outside = hn::Max(hn::Zero(d), hn::Max(below, above));
          sum = hn::MulAdd(outside, outside, sum);
        }
        const auto is_near = hn::Le(sum, hn::Load(d, bound_ + p));
        bits |= bits_of(is_near) << p;
        least = hn::Min(least, hn::IfThenElse(is_near, sum, least));
        hn::Store(sum, d, near.key[child] + p);
      }
      near.points[child] = bits & points;
      near.least[child] = hn::GetLane(hn::MinOfLanes(d, least));
      if (near.points[child] != 0) passing |= 1u << child;
    }
    return passing & ((1u << child_count) - 1);
  }

  HWY_NOINLINE Errc visit_leaf(std::uint32_t first, std::uint32_t count, PointSet points) {
    if (!leaf_.load(first, count)) return leaf_.error();
    for (std::size_t group = 0; group < leaf_.groups(); ++group) {
      for (std::size_t part = 0; part < kParts; ++part) {
        prepared_[group][part] = PreparedTriangles(leaf_, group, part);
      }
    }
    const auto prepared = [&](std::size_t group, std::size_t part) -> const PreparedTriangles& {
      return prepared_[group][part];
    };
    const PointQuery* nearest = nullptr;
    for (PointSet rest = points; rest != 0; rest &= rest - 1) {
      const auto p = static_cast<std::uint32_t>(std::countr_zero(rest));
      bounds_[p].tighten(bound_[p]);
      if (!test_triangles(leaf_, prepared, *filters_[p], *queries_[p], bounds_[p]))
        return leaf_.error();
      if (!queries_[p]->found) continue;
      if ((found_ >> p & 1u) == 0) nearest = &*queries_[p];
      found_ |= 1u << p;
      bound_[p] = bounds_[p].squared;
    }
    if (nearest != nullptr && (points_ & ~found_) != 0) {
      witness_count_ = 0;
      note_witness(*nearest);
      bound_by(witnesses_, witness_count_);
    }
    return Errc::kOk;
  }

 private:
  // Of one packet, for the next one, whose points are likely to be near. The point of a face is off
  // as in approximate_point.cpp.
  void note_witness(const PointQuery& query) {
    if (!query.found || witness_count_ == kWideChildren) return;
    const double off = 26 * kRoundoffF64 * batch_.tree.largest_abs();
    for (std::size_t k = 0; k < 3; ++k) {
      const double at = query.found->point[static_cast<Eigen::Index>(k)];
      witnesses_.low[k][witness_count_] = float_below(at - off);
      witnesses_.high[k][witness_count_] = float_above(at + off);
    }
    ++witness_count_;
  }

  // No point is farther from the surface than from the farthest corner of a box: before a face is
  // found, that keeps points from what others of the packet are near to.
  HWY_NOINLINE void bound_by(const ChildBoxes& boxes, std::uint32_t child_count) {
    const Floats d;
    for (std::size_t p = 0; p < kMostPoints; p += kLanes) {
      FloatVector least = hn::Set(d, std::numeric_limits<float>::infinity());
      for (std::uint32_t child = 0; child < child_count; ++child) {
        FloatVector sum = hn::Zero(d);
        for (std::size_t k = 0; k < 3; ++k) {
          const FloatVector across =
              hn::Max(hn::Sub(hn::Set(d, boxes.high[k][child]), hn::Load(d, low_[k] + p)),
                      hn::Sub(hn::Load(d, high_[k] + p), hn::Set(d, boxes.low[k][child])));
          sum = hn::MulAdd(across, across, sum);
        }
        least = hn::Min(least, sum);
      }
      // As PointFilter::above() of a square of which sums and products here have lost up to 8 u.
      const FloatVector bound =
          hn::MulAdd(least, hn::Set(d, static_cast<float>(1 + 32 * kRoundoffF32)),
                     hn::Set(d, std::numeric_limits<float>::min()));
      hn::Store(hn::Min(hn::Load(d, bound_ + p), bound), d, bound_ + p);
    }
  }

  PointBatch& batch_;
  const Box<float> root_;
  WalkBound unused_;                 // of queries: the packet counts nodes
  std::size_t first_ = 0;            // the place of point 0 in the batch
  PointSet points_ = 0, found_ = 0;  // found_: those that have an answer so far
  // The bound of points that are not in flight: no key is below zero.
  static constexpr float kNothing = -1;
  HWY_ALIGN float bound_[kMostPoints];  // squared distances above it cannot improve the answer
  HWY_ALIGN float low_[3][kMostPoints] = {};
  HWY_ALIGN float high_[3][kMostPoints] = {};
  PointBounds bounds_[kMostPoints];
  std::optional<PointFilter> filters_[kMostPoints];
  std::optional<PointQuery> queries_[kMostPoints];
  ChildBoxes witnesses_;  // boxes around points of the surface, so many
  std::uint32_t witness_count_ = 0;
  LeafFloats leaf_;
  PreparedTriangles prepared_[kMaxLeafTriangles / kWideChildren][kParts];  // of leaf_
};

template <class Node>
class PointPacketWalk {
 public:
  PointPacketWalk(const BoundTree& tree, const WideCodec<Node>& codec, PointPacket& packet)
      : codec_(codec), packet_(packet), prefetch_(tree, codec) {}

  // Whether a walk together pays: it does from some 4 points a node or leaf on
  // (docs/MEASUREMENTS.md).
  [[nodiscard]] bool was_shared() const { return meets_ >= 4 * visits_; }

  // The children of a node at depth n are in open_[n]. Pending children belong to nodes on the path
  // to the current one, each at another depth.
  Errc run() {
    WalkBound nodes(codec_.node_count);
    Box<float> box = packet_.root();
    std::size_t depth = 0;
    std::uint32_t number = 0;
    PointSet points = packet_.near_root();
    stack_ = {};
    meets_ = visits_ = 0;
    if (points == 0) return Errc::kOk;
    for (;;) {
      const NodeView<Node> node(codec_, number);
      const WideLinks links = node.links();
      const Errc error = nodes.count(check_links(codec_, number, links));
      if (error != Errc::kOk) return error;
      if (depth == open_.size()) return Errc::kDepthExceeded;
      note_visit(points);
      Children& children = open_[depth];
      children.links = links;
      for (std::size_t part = 0; part < kParts; ++part) decode(node, box, part, children.boxes);
      const std::uint32_t passing =
          packet_.meet(children.boxes, links.child_count, points, children.near);
      prefetch_.leaves(links, passing & ~links.inner_mask);
      prefetch_.nodes(links, passing & links.inner_mask);
      stack_.push(passing, children.near.least, depth);
      for (;;) {
        typename Stack::Child at;
        if (!stack_.pop(std::numeric_limits<float>::infinity(), at)) return Errc::kOk;
        const Children& of = open_[at.depth];
        points = packet_.before_bound(of.near.points[at.number], of.near.key[at.number]);
        if (points == 0) continue;
        if (((of.links.inner_mask >> at.number) & 1u) != 0) {
          box = of.boxes.box(at.number);
          number = node_number(of.links, at.number);
          depth = at.depth + 1;
          break;
        }
        note_visit(points);
        const std::uint32_t first = first_face(of.links, at.number);
        const Errc failed =
            packet_.visit_leaf(first, std::min(kLeafFaces, codec_.face_count - first), points);
        if (failed != Errc::kOk) return failed;
      }
    }
  }

 private:
  struct Children {
    ChildBoxes boxes;
    WideLinks links;
    NearPoints near;
  };
  using Stack = TraversalStack<WideCodec<Node>::kDepthLimit>;

  void note_visit(PointSet points) {
    meets_ += static_cast<std::uint64_t>(std::popcount(points));
    ++visits_;
  }

  const WideCodec<Node>& codec_;
  PointPacket& packet_;
  const Prefetch<Node> prefetch_;
  // By the last walk: nodes and leaves, and points at them.
  std::uint64_t visits_ = 0, meets_ = 0;
  Stack stack_;
  std::array<Children, WideCodec<Node>::kDepthLimit> open_;
};

template <class Node>
Errc walk_packets_of_points(const WideCodec<Node>& codec, PointBatch& batch) {
  PointPacket packet(batch);
  // Its nodes take as much of the stack as a point's own walk: they are there while it runs alone.
  struct Walks {
    [[nodiscard]] bool was_shared() const { return is_shared; }
    HWY_NOINLINE Errc run() {
      PointPacketWalk<Node> walk(tree, codec, packet);
      const Errc error = walk.run();
      is_shared = walk.was_shared();
      return error;
    }
    const BoundTree& tree;
    const WideCodec<Node>& codec;
    PointPacket& packet;
    bool is_shared = false;
  };
  Walks walks{batch.tree, codec, packet};
  answer_in_packets(batch.points.size(), packet, walks);
  return Errc::kOk;
}

void walk_point_batch(PointBatch& batch) {
  static_cast<void>(with_wide_codec<Errc>(
      batch.tree, [&](const auto& codec) { return walk_packets_of_points(codec, batch); }));
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "runtime/walk/dispatch.h"

namespace boxtree {
namespace {

BOXTREE_EXPORT(walk_point_batch);

}  // namespace

void walk_wide(PointBatch& batch) {
  BOXTREE_DISPATCH(walk_point_batch)(batch);
}

}  // namespace boxtree
#endif
