// SPDX-License-Identifier: MIT
// Ray queries over the wide codecs.
#include "runtime/query/ray_filter.h"
#include "runtime/query/ray_query.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/targets.h"
#include "runtime/walk/walk_tree.h"

#ifndef HWY_TARGET_INCLUDE  // compiled alone
#define HWY_TARGET_INCLUDE "runtime/query/ray_wide.cpp"
#endif
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include "runtime/query/ray_triangles-inl.h"
#include "runtime/walk/prefetch-inl.h"
#include "runtime/walk/traversal_stack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
Errc walk_ray(const BoundTree& tree, RayQuery& query) {
  return traverse_nearest(tree, ErasedCodec{&tree}, query);
}
// Not called: without vectors no ray is filtered.
Errc walk_filtered(const BoundTree&, FilteredRay&) {
  return Errc::kInternal;
}
#else
// The children of an open node along the ray: the parameters of their planes. They are computed
// from those of their parent as planes are in space, so no box is ever decoded.
struct RayChildren {
  HWY_ALIGN float near[3][kWideChildren];
  HWY_ALIGN float far[3][kWideChildren];
  WideLinks links;
};

// The leaves that a ray intersects: the same for both codecs, and compiled once.
class RayLeaves {
 public:
  RayLeaves(const BoundTree& tree, FilteredRay& ray)
      : ray_(ray), leaf_(tree), bound_(ray.filter.bound(ray.t_max)) {}

  /// Parameters above it cannot improve the answer.
  [[nodiscard]] float bound() const { return bound_; }

  /// Whether to go on; if not, because of error().
  HWY_NOINLINE bool visit(std::uint32_t first, std::uint32_t count) {
    const auto test = [&](const Triangle& triangle, std::uint32_t face, std::uint32_t half) {
      ray_.prepared().test(triangle, face, half);
    };
    if (!leaf_.load(first, count) || !test_triangles(leaf_, ray_.filter, bound_, test)) {
      error_ = leaf_.error();
      return false;
    }
    if (ray_.test == nullptr) return true;
    bound_ = ray_.filter.bound(ray_.test->t_max);
    return !ray_.test->is_done();
  }

  /// Of the last leaf.
  [[nodiscard]] Errc error() const { return error_; }

 private:
  FilteredRay& ray_;
  LeafFloats leaf_;
  float bound_;
  Errc error_ = Errc::kOk;
};

template <class Node>
class RayWalk {
 public:
  RayWalk(const BoundTree& tree, const WideCodec<Node>& codec, FilteredRay& ray)
      : codec_(codec),
        ray_(ray),
        filter_(ray.filter),
        prefetch_(tree, codec),
        is_large_(Prefetch<Node>::pays(codec)),
        leaves_(tree, ray) {}

  // The children of a node at depth n are in open_[n + 1]; the root is in open_[0], as if it were a
  // child. Pending children belong to nodes on the path to the current one, each at another depth.
  Errc run(const BoxLanes& root) {
    RayFilter::Lanes near, far;
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) {
      // The sign of the inverse tells which of them is near.
      const float low = (static_cast<float>(root.low[k]) - filter_.origin[k]) * filter_.inverse[k];
      const float high =
          (static_cast<float>(root.high[k]) - filter_.origin[k]) * filter_.inverse[k];
      near[k] = std::min(low, high) - filter_.margin[k];
      far[k] = std::max(low, high) + filter_.margin[k];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      open_[0].near[k][0] = near[k];
      open_[0].far[k][0] = far[k];
    }
    typename decltype(stack_)::Child at{0, 0};
    std::uint32_t number = 0;
    HWY_ALIGN float enter[kWideChildren];
    for (;;) {
      const NodeView<Node> node(codec_, number);
      const WideLinks links = node.links();
      const Errc error = ray_.nodes.count(check_links(codec_, number, links));
      if (error != Errc::kOk) return error;
      if (at.depth + 1 == open_.size()) return Errc::kDepthExceeded;
      RayChildren& children = open_[at.depth + 1];
      const std::uint32_t passing = intersect(node, open_[at.depth], at.number, children, enter) &
                                    ((1u << links.child_count) - 1);
      children.links = links;
      if (is_large_) {
        prefetch_.leaves(links, passing & ~links.inner_mask);
        prefetch_.nodes(links, passing & links.inner_mask);
      }
      for (std::uint32_t leaves = passing & ~links.inner_mask; leaves != 0;) {
        const std::uint32_t i = take_smallest(leaves, enter);
        if (enter[i] > leaves_.bound()) break;
        const std::uint32_t face = first_face(links, i);
        if (!leaves_.visit(face, std::min(kLeafFaces, codec_.face_count - face))) {
          return leaves_.error();
        }
      }
      const std::uint32_t inner = passing & links.inner_mask;
      if (std::popcount(inner) > 2) {
        stack_.push(inner, enter, at.depth + 1);
      } else if (inner != 0) {
        // One or two, as in most nodes: the nearer one is entered at once, the other one is pushed.
        auto nearer = static_cast<std::uint32_t>(std::countr_zero(inner));
        if (const std::uint32_t rest = inner & (inner - 1); rest != 0) {
          const auto other = static_cast<std::uint32_t>(std::countr_zero(rest));
          const bool swap = enter[other] < enter[nearer];
          const std::uint32_t farther = swap ? nearer : other;
          nearer = swap ? other : nearer;
          stack_.push_one(farther, enter[farther], at.depth + 1);
        }
        if (enter[nearer] <= leaves_.bound()) {
          at = {at.depth + 1, nearer};
          number = node_number(links, nearer);
          continue;
        }
      }
      if (!stack_.pop(leaves_.bound(), at)) return Errc::kOk;
      number = node_number(open_[at.depth].links, at.number);
    }
  }

 private:
  // Bit i: the ray intersects child i before the bound, where it enters[i]. The planes of a box are
  // widened by the margins; the steps between its planes are those of the box itself.
  HWY_INLINE std::uint32_t intersect(const NodeView<Node>& node, const RayChildren& parent,
                                     std::uint32_t child, RayChildren& out, float* enters) const {
    const Floats d;
    std::uint32_t passing = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
      FloatVector enter = hn::Zero(d);
      FloatVector leave = hn::Set(d, leaves_.bound());
      for (std::size_t k = 0; k < 3; ++k) {
        const FloatVector near_of_box = hn::Set(d, parent.near[k][child]);
        const FloatVector far_of_box = hn::Set(d, parent.far[k][child]);
        const FloatVector step =
            hn::Mul(hn::Sub(hn::Sub(far_of_box, near_of_box), hn::Set(d, filter_.margins[k])),
                    hn::Set(d, 1 / Node::kStepsOfExtent));
        const std::uint32_t near_high = filter_.near_high[k];
        const FloatVector near = hn::MulAdd(node.steps(near_high, k, part), step, near_of_box);
        const FloatVector far = hn::NegMulAdd(node.steps(1 - near_high, k, part), step, far_of_box);
        hn::Store(near, d, out.near[k] + part * kLanes);
        hn::Store(far, d, out.far[k] + part * kLanes);
        enter = hn::Max(enter, near);
        leave = hn::Min(leave, far);
      }
      hn::Store(enter, d, enters + part * kLanes);
      passing |= bits_of(hn::Le(enter, leave)) << (part * kLanes);
    }
    return passing;
  }

  const WideCodec<Node>& codec_;
  FilteredRay& ray_;
  const RayFilter& filter_;
  const Prefetch<Node> prefetch_;
  const bool is_large_;
  RayLeaves leaves_;
  TraversalStack<WideCodec<Node>::kDepthLimit + 1> stack_;
  std::array<RayChildren, WideCodec<Node>::kDepthLimit + 1> open_;
};

template <class Node>
Errc walk_ray_nodes(const BoundTree& tree, const WideCodec<Node>& codec, FilteredRay& ray) {
  return RayWalk<Node>(tree, codec, ray).run(tree.root_lanes());
}

Errc walk_filtered(const BoundTree& tree, FilteredRay& ray) {
  return with_wide_codec<Errc>(tree,
                               [&](const auto& codec) { return walk_ray_nodes(tree, codec, ray); });
}

Errc walk_ray(const BoundTree& tree, RayQuery& query) {
  const RayFilter filter(query);
  const auto itself = [&]() -> RayTest& { return query; };
  FilteredRay ray{filter, query.t_max, query.nodes, itself, &query};
  return walk_filtered(tree, ray);
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "runtime/walk/dispatch.h"

namespace boxtree {
namespace {

BOXTREE_EXPORT(walk_ray);
BOXTREE_EXPORT(walk_filtered);

}  // namespace

Errc walk_wide(const BoundTree& tree, RayQuery& query) {
  if (tree.has_float_nodes() && RayFilter::is_near(query))
    return BOXTREE_DISPATCH(walk_ray)(tree, query);
  return traverse_nearest(tree, ErasedCodec{&tree}, query);
}

Errc walk_wide(const BoundTree& tree, FilteredRay& ray) {
  return BOXTREE_DISPATCH(walk_filtered)(tree, ray);
}

}  // namespace boxtree
#endif
