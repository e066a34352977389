// SPDX-License-Identifier: MIT
// Ray queries over the wide codecs.
#include "runtime/query/ray_filter.h"
#include "runtime/query/ray_query.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/targets.h"
#include "runtime/walk/walk_tree.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/query/ray_wide.cpp"
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include "runtime/walk/leaf-inl.h"
#include "runtime/walk/prefetch-inl.h"
#include "runtime/walk/traversal_stack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
Errc walk_ray(const BoundTree& tree, RayQuery& query) {
  return traverse_nearest(tree, ErasedCodec{&tree}, query);
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
  RayLeaves(const BoundTree& tree, RayQuery& query, const RayFilter& filter)
      : query_(query), filter_(filter), leaf_(tree), bound_(filter.bound(query.t_max)) {}

  /// Parameters above it cannot improve the answer.
  [[nodiscard]] float bound() const { return bound_; }

  /// Whether to go on.
  HWY_NOINLINE bool visit(std::uint32_t first, std::uint32_t count) {
    if (!leaf_.load(first, count)) {
      query_.error = leaf_.error();
      return false;
    }
    for (std::size_t group = 0; group < leaf_.groups(); ++group) {
      std::uint32_t near = 0;
      for (std::size_t part = 0; part < kParts; ++part) {
        near |= ~missed(group, part) << (part * kLanes);
      }
      near &= leaf_.lanes(group);
      for (; near != 0; near &= near - 1) {
        const auto lane = static_cast<std::uint32_t>(group * kWideChildren) +
                          static_cast<std::uint32_t>(std::countr_zero(near));
        if (!leaf_.with_triangle(
                lane, [&](const Triangle& triangle, std::uint32_t face, std::uint32_t half) {
                  query_.test(triangle, face, half);
                })) {
          query_.error = leaf_.error();
          return false;
        }
      }
    }
    bound_ = filter_.bound(query_.t_max);
    return !query_.is_done();
  }

 private:
  // Bit i: the ray misses triangle i provably. The test of triangle_ray.h in float: an area of
  // corners at most `size` from the ray, each coordinate off by at most 3 error, is off by less
  // than 8 (size + 3 error) 3 error.
  HWY_INLINE std::uint32_t missed(std::size_t group, std::size_t part) const {
    const Floats d;
    FloatVector x[3], y[3];
    FloatVector size = hn::Zero(d);
    FloatVector first = hn::Zero(d), last = hn::Zero(d);
    for (std::size_t c = 0; c < 3; ++c) {
      const FloatVector z = hn::Sub(leaf_.at(c, filter_.axis_z, group, part),
                                    hn::Set(d, filter_.origin[filter_.axis_z]));
      x[c] = hn::NegMulAdd(hn::Set(d, filter_.shear_x), z,
                           hn::Sub(leaf_.at(c, filter_.axis_x, group, part),
                                   hn::Set(d, filter_.origin[filter_.axis_x])));
      y[c] = hn::NegMulAdd(hn::Set(d, filter_.shear_y), z,
                           hn::Sub(leaf_.at(c, filter_.axis_y, group, part),
                                   hn::Set(d, filter_.origin[filter_.axis_y])));
      size = hn::Max(size, hn::Max(hn::Abs(x[c]), hn::Abs(y[c])));
      const FloatVector depth = hn::Mul(z, hn::Set(d, filter_.shear_z));
      first = c == 0 ? depth : hn::Min(first, depth);
      last = c == 0 ? depth : hn::Max(last, depth);
    }
    const auto area = [&](std::size_t from, std::size_t to) {
      return hn::MulSub(x[from], y[to], hn::Mul(y[from], x[to]));
    };
    const FloatVector a = area(2, 1), b = area(0, 2), c = area(1, 0);
    const FloatVector error = hn::Set(d, 3 * filter_.error);
    const FloatVector doubt = hn::Mul(hn::Mul(hn::Set(d, 8.0f), error), hn::Add(size, error));
    const FloatVector smallest = hn::Min(a, hn::Min(b, c));
    const FloatVector largest = hn::Max(a, hn::Max(b, c));
    const auto apart = hn::And(hn::Gt(largest, doubt), hn::Lt(smallest, hn::Neg(doubt)));
    const auto beyond = hn::Or(hn::Gt(first, hn::Add(hn::Set(d, bound_), error)),
                               hn::Lt(last, hn::Neg(hn::Add(error, error))));
    return bits_of(hn::Or(apart, beyond));
  }

  RayQuery& query_;
  const RayFilter& filter_;
  LeafFloats leaf_;
  float bound_;
};

template <class Node>
class RayWalk {
 public:
  RayWalk(const BoundTree& tree, const WideCodec<Node>& codec, RayQuery& query,
          const RayFilter& filter)
      : codec_(codec),
        query_(query),
        filter_(filter),
        prefetch_(tree, codec),
        is_large_(codec.node_count > kLargeTree),
        leaves_(tree, query, filter) {}

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
      const Errc error = query_.nodes.count(check_links(codec_, number, links));
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
        if (!leaves_.visit(face, std::min(kLeafFaces, codec_.face_count - face))) return Errc::kOk;
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
  RayQuery& query_;
  const RayFilter& filter_;
  // Smaller trees are in the caches: there, requesting what comes next costs mispredicted branches
  // and gains nothing. 4096 nodes are some 200 000 triangles.
  static constexpr std::uint32_t kLargeTree = 4096;

  const Prefetch<Node> prefetch_;
  const bool is_large_;
  RayLeaves leaves_;
  TraversalStack<WideCodec<Node>::kDepthLimit + 1> stack_;
  std::array<RayChildren, WideCodec<Node>::kDepthLimit + 1> open_;
};

template <class Node>
Errc walk(const BoundTree& tree, const WideCodec<Node>& codec, RayQuery& query) {
  return RayWalk<Node>(tree, codec, query, RayFilter(query)).run(tree.root_lanes());
}

Errc walk_ray(const BoundTree& tree, RayQuery& query) {
  return with_wide_codec<Errc>(tree, [&](const auto& codec) { return walk(tree, codec, query); });
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

}  // namespace

Errc walk_wide(const BoundTree& tree, RayQuery& query) {
  if (tree.has_float_nodes() && RayFilter::is_near(query))
    return BOXTREE_DISPATCH(walk_ray)(tree, query);
  return traverse_nearest(tree, ErasedCodec{&tree}, query);
}

}  // namespace boxtree
#endif
