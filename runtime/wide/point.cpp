// SPDX-License-Identifier: MIT
// The closest point over the wide codecs.
#include <boxtree/runtime/query/erased_codec.h>
#include <boxtree/runtime/query/point_query.h>
#include <boxtree/runtime/wide/point_filter.h>
#include <boxtree/runtime/wide/targets.h>
#include <boxtree/runtime/wide/walks.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "boxtree/runtime/wide/point.cpp"
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include <boxtree/runtime/wide/prefetch-inl.h>
#include <boxtree/runtime/wide/triangle_distance-inl.h>
#include <boxtree/runtime/wide/waiting-inl.h>

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
Errc walk_point(const Tree& tree, PointQuery& query) {
  return traverse_nearest(tree, ErasedCodec{&tree}, query);
}
#else
// The children of an open node.
struct PointChildren {
  ChildBoxes boxes;
  WideLinks links;
};

template <class Node>
class PointWalk {
 public:
  PointWalk(const Tree& tree, const WideCodec<Node>& codec, PointQuery& query)
      : codec_(codec),
        query_(query),
        filter_(tree, query.point),
        prefetch_(tree, codec),
        leaf_(tree) {
    set_bound();
  }

  // The children of a node at depth n are in open_[n]. Leaves wait among the nodes: what is nearer
  // comes first.
  Errc run(const Box<float>& root) {
    Box<float> box = root;
    std::size_t depth = 0;
    std::uint32_t number = 0;
    std::uint64_t unexpanded = codec_.node_count;
    for (;;) {
      const Node* node = reinterpret_cast<const Node*>(codec_.nodes) + number;
      const WideLinks links = links_of(*node);
      ++query_.nodes_expanded;
      if (unexpanded-- == 0 || !is_sound(codec_, number, links)) return Errc::kNodeCorrupt;
      if (depth == open_.size()) return Errc::kDepthExceeded;
      open_[depth].links = links;
      const std::uint32_t passing =
          meet(*node, box, open_[depth].boxes, depth, (1u << links.child_count) - 1);
      prefetch_.leaves(links, passing & ~links.inner_mask);
      prefetch_.nodes(links, passing & links.inner_mask);
      for (;;) {
        typename decltype(waiting_)::Child at;
        if (!waiting_.pop(bound_, at)) return Errc::kOk;
        const PointChildren& of = open_[at.depth];
        if (((of.links.inner_mask >> at.number) & 1u) != 0) {
          box = of.boxes.box(at.number);
          number = node_number(of.links, at.number);
          depth = at.depth + 1;
          break;
        }
        const std::uint32_t face = first_face(of.links, at.number);
        if (!visit_leaf(face, std::min(kLeafFaces, codec_.face_count - face))) return Errc::kOk;
      }
    }
  }

 private:
  void set_bound() {
    bound_ = PointFilter::above(query_.best);
    distance_ = float_above(std::sqrt(query_.best)) * (1 + std::numeric_limits<float>::epsilon());
  }

  // Lets those of a node's children wait that may be near enough; bit i is child i.
  HWY_INLINE std::uint32_t meet(const Node& node, const Box<float>& box, ChildBoxes& children,
                                std::size_t depth, std::uint32_t all) {
    HWY_ALIGN float key[kWideChildren];
    std::uint32_t passing = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
      const FloatVector bound = nearest_squared(filter_, decode(node, box, part, children));
      hn::Store(bound, Floats(), key + part * kLanes);
      passing |= bits_of(hn::Le(bound, hn::Set(Floats(), bound_))) << (part * kLanes);
    }
    passing &= all;
    waiting_.push(passing, key, depth);
    return passing;
  }

  bool visit_leaf(std::uint32_t first, std::uint32_t count) {
    ++query_.nodes_expanded;
    if (!leaf_.load(first, count)) {
      query_.error = leaf_.error();
      return false;
    }
    for (std::size_t group = 0; group < leaf_.groups(); ++group) {
      HWY_ALIGN float distance[kWideChildren];
      std::uint32_t near = 0;
      for (std::size_t part = 0; part < kParts; ++part) {
        const FloatVector bound = triangle_distance(filter_, leaf_, group, part);
        hn::Store(bound, Floats(), distance + part * kLanes);
        near |= bits_of(hn::Not(hn::Gt(bound, hn::Set(Floats(), distance_)))) << (part * kLanes);
      }
      near &= leaf_.lanes(group);
      while (near != 0) {
        const std::uint32_t i = take_smallest(near, distance);
        if (distance[i] > distance_) break;
        const auto lane = static_cast<std::uint32_t>(group * kWideChildren) + i;
        const bool read = leaf_.with_triangle(
            lane, [&](const Triangle& triangle, std::uint32_t face, std::uint32_t half) {
              query_.test(triangle, face, half);
            });
        if (!read) {
          query_.error = leaf_.error();
          return false;
        }
        set_bound();
      }
    }
    return true;
  }

  const WideCodec<Node>& codec_;
  PointQuery& query_;
  const PointFilter filter_;
  const Prefetch<Node> prefetch_;
  float bound_;     // of squared distances
  float distance_;  // of distances
  LeafFloats leaf_;
  Waiting<WideCodec<Node>::kDepthLimit> waiting_;
  std::array<PointChildren, WideCodec<Node>::kDepthLimit> open_;
};

template <class Node>
Errc walk(const Tree& tree, const WideCodec<Node>& codec, PointQuery& query) {
  const Box<float> root = root_box<float>(tree);
  if (query.key(root) > query.bound()) return Errc::kOk;
  return PointWalk<Node>(tree, codec, query).run(root);
}
Errc walk_point(const Tree& tree, PointQuery& query) {
  return with_wide_codec<Errc>(tree, [&](const auto& codec) { return walk(tree, codec, query); });
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxtree {
namespace {

HWY_EXPORT(walk_point);

}  // namespace

Errc walk_wide(const Tree& tree, PointQuery& query) {
  if (tree.has_nodes() && PointFilter::is_near(tree, query.point)) {
    return HWY_DYNAMIC_DISPATCH(walk_point)(tree, query);
  }
  return traverse_nearest(tree, ErasedCodec{&tree}, query);
}

}  // namespace boxtree
#endif
