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
#include "runtime/walk/pending_children-inl.h"
#include "runtime/walk/prefetch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
Errc walk_ray(const BoundTree& tree, RayQuery& query, const RayFilter&) {
  return traverse_nearest(tree, ErasedCodec{&tree}, query);
}
// Not called: without vectors no ray is filtered.
Errc walk_filtered(const BoundTree&, FilteredRay&) {
  return Errc::kInternal;
}
#else
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
        nodes_(ray.nodes),
        filter_(ray.filter),
        prefetch_(tree, codec),
        is_large_(Prefetch<Node>::pays(codec)),
        leaves_(tree, ray) {
    for (std::size_t k = 0; k < 3; ++k) {
      near_codes_[k] = NodeView<Node>::codes(filter_.near_high[k], k);
      far_codes_[k] = NodeView<Node>::codes(1 - filter_.near_high[k], k);
      hn::Store(hn::Set(Floats(), filter_.margins[k]), Floats(), margins_[k]);
    }
  }

  // The node at depth n is open_[n + 1]; open_[0] has the root for its only child. Pending children
  // belong to nodes on the path to the current one.
  Errc run(const BoxLanes& root) {
    OpenNode* parent = open_.data();
    set_root(root, *parent);
    std::uint32_t child = 0;
    std::uint32_t number = 0;
    OpenNode* next = nullptr;  // the nearest above the current node that has pending children
    for (;;) {
      const NodeView<Node> node(codec_, number);
      const WideLinks links = node.links();
      OpenNode& opened = parent[1];
      // Before its links are checked, so that both are done side by side: any bytes have boxes.
      PendingChildren pending;
      opened.pending = intersect(node, *parent, child, links.child_count, opened, pending);
      opened.links = node.link_bytes();
      opened.next = next;
      const Errc error = nodes_.count(check_links(codec_, number, links));
      if (error != Errc::kOk) return error;
      if (&opened == &open_.back()) return Errc::kDepthExceeded;
      if (is_large_) {
        prefetch_.leaves(links, opened.pending & ~links.inner_mask);
        prefetch_.nodes(links, opened.pending & links.inner_mask);
      }
      // To the next child that is a node; leaves on the way are visited.
      for (OpenNode* of = &opened;;) {
        const std::int32_t nearest = pending.nearest();
        next = of->next;
        if (!PendingChildren::is_beyond(leaves_.bound(), nearest)) {
          child = PendingChildren::number_of(nearest);
          pending.store_without(nearest, of->stored);
          of->pending &= ~(1u << child);
          next = of->pending != 0 ? of : next;
          const WideLinks taken = NodeView<Node>::links(of->links);
          if (((taken.inner_mask >> child) & 1u) != 0) {
            number = node_number(taken, child);
            parent = of;
            break;
          }
          const std::uint32_t face = first_face(taken, child);
          if (!leaves_.visit(face, std::min(kLeafFaces, codec_.face_count - face))) {
            return leaves_.error();
          }
        }
        if (next == nullptr) return Errc::kOk;
        of = next;
        pending.load(of->stored);
      }
    }
  }

 private:
  // The children of a node along the ray: the parameters of their planes, widened by the margins,
  // and of a step between those of a box itself. They are computed from those of their parent as
  // planes are in space, so no box is ever decoded.
  struct OpenNode {
    HWY_ALIGN float near[3][kWideChildren];
    HWY_ALIGN float far[3][kWideChildren];
    HWY_ALIGN float step[3][kWideChildren];
    PendingChildren::Stored stored;
    std::uint32_t pending;  // bit i: child i
    typename NodeView<Node>::LinkBytes links;
    OpenNode* next;  // see run()
  };

  void set_root(const BoxLanes& root, OpenNode& out) const {
    RayFilter::Lanes near, far, step;
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) {
      // The sign of the inverse tells which of them is near.
      const float low = (static_cast<float>(root.low[k]) - filter_.origin[k]) * filter_.inverse[k];
      const float high =
          (static_cast<float>(root.high[k]) - filter_.origin[k]) * filter_.inverse[k];
      near[k] = std::min(low, high) - filter_.margin[k];
      far[k] = std::max(low, high) + filter_.margin[k];
    }
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) {
      step[k] = ((far[k] - near[k]) - filter_.margins[k]) * (1 / Node::kStepsOfExtent);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      out.near[k][0] = near[k];
      out.far[k][0] = far[k];
      out.step[k][0] = step[k];
    }
  }

  // Bit i: the ray intersects child i before the bound; where it enters is its key.
  HWY_INLINE std::uint32_t intersect(const NodeView<Node>& node, const OpenNode& parent,
                                     std::uint32_t child, std::uint32_t child_count, OpenNode& out,
                                     PendingChildren& pending) const {
    const Floats d;
    const float* const limits =
        kLimits + (kWideChildren - std::min<std::size_t>(child_count, kWideChildren));
    std::uint32_t passing = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
      FloatVector near[3], far[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const FloatVector step = hn::Set(d, parent.step[k][child]);
        near[k] =
            hn::MulAdd(node.steps(near_codes_[k], part), step, hn::Set(d, parent.near[k][child]));
        far[k] =
            hn::NegMulAdd(node.steps(far_codes_[k], part), step, hn::Set(d, parent.far[k][child]));
      }
      const FloatVector limit =
          hn::Min(hn::Set(d, leaves_.bound()), hn::LoadU(d, limits + part * kLanes));
      const FloatVector enter = hn::Max(hn::Max(near[0], near[1]), hn::Max(near[2], hn::Zero(d)));
      const FloatVector leave = hn::Min(hn::Min(far[0], far[1]), hn::Min(far[2], limit));
      const auto passes = hn::Le(enter, leave);
      pending.set(part, enter, passes);
      passing |= bits_of(passes) << (part * kLanes);
      for (std::size_t k = 0; k < 3; ++k) {
        const FloatVector extent = hn::Sub(hn::Sub(far[k], near[k]), hn::Load(d, margins_[k]));
        hn::Store(near[k], d, out.near[k] + part * kLanes);
        hn::Store(far[k], d, out.far[k] + part * kLanes);
        hn::Store(hn::Mul(extent, hn::Set(d, 1 / Node::kStepsOfExtent)), d,
                  out.step[k] + part * kLanes);
      }
    }
    return passing;
  }

  // Eight from place 8 - n on: what the first n children leave at or before, if they do before the
  // bound, and what no other does.
  static constexpr float kAny = std::numeric_limits<float>::infinity();
  static constexpr float kLimits[2 * kWideChildren] = {
      kAny, kAny, kAny, kAny, kAny, kAny, kAny, kAny, -1, -1, -1, -1, -1, -1, -1, -1};

  const WideCodec<Node>& codec_;
  WalkBound& nodes_;
  const RayFilter& filter_;
  const Prefetch<Node> prefetch_;
  const bool is_large_;
  RayLeaves leaves_;
  std::size_t near_codes_[3], far_codes_[3];
  HWY_ALIGN float margins_[3][kLanes];
  std::array<OpenNode, WideCodec<Node>::kDepthLimit + 2> open_;
};

template <class Node>
Errc walk_ray_nodes(const BoundTree& tree, const WideCodec<Node>& codec, FilteredRay& ray) {
  return RayWalk<Node>(tree, codec, ray).run(tree.root_lanes());
}

Errc walk_filtered(const BoundTree& tree, FilteredRay& ray) {
  return with_wide_codec<Errc>(tree,
                               [&](const auto& codec) { return walk_ray_nodes(tree, codec, ray); });
}

Errc walk_ray(const BoundTree& tree, RayQuery& query, const RayFilter& filter) {
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
  if (tree.has_float_nodes() && RayFilter::is_near(query)) {
    // Set up here, by the vectors that the query is made of: longer ones that are read where
    // shorter ones have just been written wait for memory.
    return BOXTREE_DISPATCH(walk_ray)(tree, query, RayFilter(query));
  }
  return traverse_nearest(tree, ErasedCodec{&tree}, query);
}

Errc walk_wide(const BoundTree& tree, FilteredRay& ray) {
  return BOXTREE_DISPATCH(walk_filtered)(tree, ray);
}

}  // namespace boxtree
#endif
