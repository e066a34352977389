// SPDX-License-Identifier: MIT
// Casts over the wide codecs.
#include "runtime/query/cast_filter.h"
#include "runtime/query/cast_query.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/targets.h"
#include "runtime/walk/walk_tree.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/query/cast_wide.cpp"
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include "runtime/query/triangle_distance-inl.h"
#include "runtime/walk/nearest-inl.h"
#include "runtime/walk/prefetch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
Errc walk_cast(const BoundTree& tree, CastQuery& query) {
  return traverse_nearest(tree, ErasedCodec{&tree}, query);
}
#else
// The leaves that the shape comes upon: the same for both codecs, and compiled once.
class CastLeaves {
 public:
  CastLeaves(const BoundTree& tree, CastQuery& query, const CastFilter& filter)
      : query_(query), filter_(filter), leaf_(tree) {
    set_bound();
  }

  /// Parameters above it cannot improve the answer.
  [[nodiscard]] float bound() const { return bound_; }

  /// Bits of the boxes that the shape's bounds meet before the bound, and from where to where.
  HWY_INLINE std::uint32_t intersect(const VectorBox& box, FloatVector& enter,
                                     FloatVector& leave) const {
    const Floats d;
    enter = hn::Zero(d);
    leave = hn::Set(d, bound_);
    for (std::size_t k = 0; k < 3; ++k) {
      const FloatVector origin = hn::Set(d, filter_.origin[k]);
      const FloatVector inverse = hn::Set(d, filter_.inverse[k]);
      const FloatVector low = hn::Mul(hn::Sub(box.low[k], origin), inverse);
      const FloatVector high = hn::Mul(hn::Sub(box.high[k], origin), inverse);
      const FloatVector margin = hn::Set(d, filter_.margin[k]);
      enter = hn::Max(enter, hn::Sub(hn::Min(low, high), margin));
      leave = hn::Min(leave, hn::Add(hn::Max(low, high), margin));
    }
    return bits_of(hn::Le(enter, leave));
  }

  /// The same for a ball around the shape, by one step from `enter` on; see advance().
  HWY_INLINE std::uint32_t advance_ball(const VectorBox& box, FloatVector& enter) const {
    const Floats d;
    const FloatVector zero = hn::Zero(d);
    FloatVector squared = zero, size = zero, approach = zero;
    for (std::size_t k = 0; k < 3; ++k) {
      const FloatVector direction = hn::Set(d, filter_.direction[k]);
      const FloatVector center = hn::MulAdd(enter, direction, hn::Set(d, filter_.origin[k]));
      const FloatVector way = hn::Sub(hn::Max(zero, hn::Sub(box.low[k], center)),
                                      hn::Max(zero, hn::Sub(center, box.high[k])));
      squared = hn::MulAdd(way, way, squared);
      size = hn::Add(size, hn::Abs(way));
      approach = hn::MulAdd(way, direction, approach);
    }
    const FloatVector reach = hn::MulAdd(hn::Sqrt(squared), hn::Set(d, filter_.outer_radius),
                                         hn::Mul(size, hn::Set(d, 3 * filter_.error)));
    enter = advanced(enter, hn::Sub(squared, reach), size, approach);
    return bits_of(hn::Le(enter, hn::Set(d, bound_)));
  }

  /// Whether to go on.
  HWY_NOINLINE bool visit(std::uint32_t first, std::uint32_t count) {
    if (!leaf_.load(first, count)) {
      query_.error = leaf_.error();
      return false;
    }
    for (std::size_t group = 0; group < leaf_.groups(); ++group) {
      HWY_ALIGN float key[kWideChildren], last[kWideChildren];
      std::uint32_t near = 0;
      for (std::size_t part = 0; part < kParts; ++part) {
        FloatVector enter, leave;
        near |= intersect(leaf_.bounds(group, part), enter, leave) << (part * kLanes);
        hn::Store(enter, Floats(), key + part * kLanes);
        hn::Store(leave, Floats(), last + part * kLanes);
      }
      near &= leaf_.lanes(group);
      if (near != 0 && query_.best.is_hit) near = touched_before_bound(group, near);
      if (near != 0) near = advance(group, near, key, last);
      while (near != 0) {
        const std::uint32_t i = take_smallest(near, key);
        if (key[i] > bound_) break;
        const auto lane = static_cast<std::uint32_t>(group * kWideChildren) + i;
        const double before = query_.t_max;
        if (!leaf_.with_triangle(
                lane, [&](const Triangle& triangle, std::uint32_t face, std::uint32_t half) {
                  query_.test(triangle, face, half);
                })) {
          query_.error = leaf_.error();
          return false;
        }
        if (query_.is_done()) return false;
        if (query_.t_max == before) continue;
        set_bound();
        if (near != 0) near = touched_before_bound(group, near);
      }
    }
    return true;
  }

 private:
  void set_bound() { bound_ = filter_.bound(query_.t_max); }

  // By how much s rises where a vector of magnitudes `size` separates by `missing` more than the
  // shape reaches, and the shape moves along it by `approach`: both times the vector's length.
  // Infinity where it moves away.
  static HWY_INLINE FloatVector advanced(FloatVector s, FloatVector missing, FloatVector size,
                                         FloatVector approach) {
    const Floats d;
    const FloatVector speed =
        hn::MulAdd(size, hn::Set(d, static_cast<float>(8 * kRoundoffF32)), approach);
    const FloatVector touch = hn::MulAdd(hn::Div(missing, speed),
                                         hn::Set(d, static_cast<float>(1 - 8 * kRoundoffF32)), s);
    const FloatVector later = hn::IfThenElse(hn::Gt(speed, hn::Zero(d)), touch,
                                             hn::Set(d, std::numeric_limits<float>::infinity()));
    return hn::IfThenElse(hn::Gt(missing, hn::Zero(d)), later, s);
  }

  // By how much a direction separates the shape and triangles more than rounding may, times the
  // direction's length; its magnitudes, and how fast the shape moves along it, likewise.
  struct Separation {
    FloatVector missing, size, approach;
  };

  // At `s`, by the direction from the point of the core that is closest to the triangle's point
  // that is closest to it, as nearly as one projection after the other gets there; what a direction
  // separates, it does however it was found. `offset`: of that point of the core from the center,
  // the last one and the new one. A projection of a vector v is off by the sum of its magnitudes
  // times what coordinates are off by, see CastFilter, and by 8u of the largest coordinate, which
  // is less.
  HWY_NOINLINE Separation separation(std::size_t group, std::size_t part, FloatVector s,
                                     Vector3& offset) const {
    const Floats d;
    const auto all = [&](float x) { return hn::Set(d, x); };
    const ConvexAxes& core = filter_.core;
    Vector3 direction, center, point;
    for (std::size_t k = 0; k < 3; ++k) {
      direction.at[k] = all(filter_.direction[k]);
      center.at[k] = hn::MulAdd(s, direction.at[k], all(filter_.origin[k]));
      point.at[k] = hn::Add(center.at[k], offset.at[k]);
    }
    Vector3 way = way_to(SeenTriangles(point, filter_.error, leaf_, group, part));
    if (core.count != 0) {
      // To the point of the core that is closest to where that way ends.
      const Vector3 end{{hn::Add(offset.at[0], way.at[0]), hn::Add(offset.at[1], way.at[1]),
                         hn::Add(offset.at[2], way.at[2])}};
      for (std::size_t k = 0; k < 3; ++k) offset.at[k] = hn::Zero(d);
      for (std::uint32_t i = 0; i < core.count; ++i) {
        const Vector3 axis = axis_of(core, i);
        const FloatVector half = all(core.half[i]);
        const FloatVector along = hn::Min(hn::Max(dot(end, axis), hn::Neg(half)), half);
        for (std::size_t k = 0; k < 3; ++k) {
          offset.at[k] = hn::MulAdd(along, axis.at[k], offset.at[k]);
        }
      }
      way = minus(end, offset);
    }
    const FloatVector size =
        hn::Add(hn::Add(hn::Abs(way.at[0]), hn::Abs(way.at[1])), hn::Abs(way.at[2]));
    FloatVector gap = all(std::numeric_limits<float>::infinity());
    for (std::size_t c = 0; c < 3; ++c) {
      Vector3 corner;
      for (std::size_t k = 0; k < 3; ++k) corner.at[k] = leaf_.at(c, k, group, part);
      gap = hn::Min(gap, dot(way, minus(corner, center)));
    }
    const FloatVector error = all(3 * filter_.error + leaf_.corner_error());
    FloatVector reach =
        hn::MulAdd(hn::Sqrt(dot(way, way)), all(filter_.radius), hn::Mul(size, error));
    for (std::uint32_t i = 0; i < core.count; ++i) {
      reach = hn::MulAdd(hn::Abs(dot(way, axis_of(core, i))), all(core.half[i]), reach);
    }
    return {hn::Sub(gap, reach), size, dot(way, direction)};
  }

  // Raises `from`, from which on the shape may touch triangles, by steps of
  // MovingShape::first_touch in single precision. Returns those of `near` that it may touch up to
  // `to`.
  HWY_NOINLINE std::uint32_t advance(std::size_t group, std::uint32_t near, float* from,
                                     const float* to) const {
    const Floats d;
    std::uint32_t bits = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
      std::uint32_t lanes = (near >> (part * kLanes)) & kAllLanes;
      FloatVector s = hn::Load(d, from + part * kLanes);
      Vector3 offset{{hn::Zero(d), hn::Zero(d), hn::Zero(d)}};
      for (int step = 0; step < kSteps && lanes != 0; ++step) {
        const auto [missing, size, approach] = separation(group, part, s, offset);
        s = advanced(s, missing, size, approach);
        lanes &= bits_of(hn::Le(s, hn::Load(d, to + part * kLanes)));
      }
      hn::Store(s, d, from + part * kLanes);
      bits |= lanes << (part * kLanes);
    }
    return bits;
  }

  // Those of `near` that the shape can touch before the bound, as seen from there: not what a
  // direction separates then that it moves along, since the gap was larger before.
  HWY_NOINLINE std::uint32_t touched_before_bound(std::size_t group, std::uint32_t near) const {
    const Floats d;
    for (std::size_t part = 0; part < kParts; ++part) {
      if (((near >> (part * kLanes)) & kAllLanes) == 0) continue;
      Vector3 offset{{hn::Zero(d), hn::Zero(d), hn::Zero(d)}};
      for (std::uint32_t step = 0; step <= filter_.core.count; ++step) {
        const auto [missing, size, approach] = separation(group, part, hn::Set(d, bound_), offset);
        const auto is_ahead = hn::And(
            hn::Gt(missing, hn::Zero(d)),
            hn::Gt(approach, hn::Mul(size, hn::Set(d, static_cast<float>(8 * kRoundoffF32)))));
        near &= ~(bits_of(is_ahead) << (part * kLanes));
        if (((near >> (part * kLanes)) & kAllLanes) == 0) break;
      }
    }
    return near;
  }
  static constexpr std::uint32_t kAllLanes = (1u << kLanes) - 1;

  [[nodiscard]] static HWY_INLINE Vector3 axis_of(const ConvexAxes& core, std::uint32_t i) {
    const Floats d;
    return {
        {hn::Set(d, core.axis[i][0]), hn::Set(d, core.axis[i][1]), hn::Set(d, core.axis[i][2])}};
  }

  // From the point to about the closest of the triangle.
  [[nodiscard]] static HWY_INLINE Vector3 way_to(const SeenTriangles& seen) {
    const Floats d;
    Vector3 rest = from_segment(seen.w, seen.e1);
    FloatVector squared = dot(rest, rest);
    const auto consider = [&](const Vector3& w, const Vector3& edge) {
      const Vector3 other = from_segment(w, edge);
      const FloatVector of_edge = dot(other, other);
      const auto is_nearer = hn::Lt(of_edge, squared);
      squared = hn::IfThenElse(is_nearer, of_edge, squared);
      for (std::size_t k = 0; k < 3; ++k) {
        rest.at[k] = hn::IfThenElse(is_nearer, other.at[k], rest.at[k]);
      }
    };
    consider(seen.w, seen.e2);
    consider(seen.w1, seen.e3);
    const FloatVector height =
        hn::Div(dot(seen.n, seen.w),
                hn::Max(dot(seen.n, seen.n), hn::Set(d, std::numeric_limits<float>::min())));
    Vector3 way;
    for (std::size_t k = 0; k < 3; ++k) {
      way.at[k] = hn::Neg(hn::IfThenElse(seen.outside, rest.at[k], hn::Mul(height, seen.n.at[k])));
    }
    return way;
  }

  // Near a touch each step squares what is left.
  static constexpr int kSteps = 4;

  CastQuery& query_;
  const CastFilter& filter_;
  LeafFloats leaf_;
  float bound_ = 0;
};

// The query of NearestWalk over the faces of one tree.
template <class Node>
class CastFaces {
 public:
  CastFaces(const BoundTree& tree, const WideCodec<Node>& codec, CastQuery& query,
            CastLeaves& leaves)
      : codec_(codec), query_(query), prefetch_(tree, codec), leaves_(leaves) {}

  [[nodiscard]] float bound() const { return leaves_.bound(); }
  [[nodiscard]] WalkBound& nodes() const { return query_.nodes; }
  HWY_INLINE std::uint32_t intersect(const VectorBox& boxes, FloatVector& key) const {
    FloatVector leave;
    return leaves_.intersect(boxes, key, leave) & leaves_.advance_ball(boxes, key);
  }
  [[nodiscard]] bool reads_ahead() const { return false; }
  HWY_INLINE void expanding(const WideLinks& links, std::uint32_t passing) {
    prefetch_.leaves(links, passing & ~links.inner_mask);
    prefetch_.nodes(links, passing & links.inner_mask);
  }
  bool leaf(std::uint32_t number, std::uint32_t) {
    const std::uint32_t first = number * kLeafFaces;
    return leaves_.visit(first, std::min(kLeafFaces, codec_.face_count - first));
  }

 private:
  const WideCodec<Node>& codec_;
  CastQuery& query_;
  const Prefetch<Node> prefetch_;
  CastLeaves& leaves_;
};

template <class Node>
Errc walk(const BoundTree& tree, const WideCodec<Node>& codec, CastQuery& query,
          CastLeaves& leaves) {
  CastFaces<Node> faces(tree, codec, query, leaves);
  return NearestWalk<Node, CastFaces<Node>>(codec, faces).run(root_box<float>(tree));
}

Errc walk_cast(const BoundTree& tree, CastQuery& query) {
  const CastFilter filter(query);
  CastLeaves leaves(tree, query, filter);
  return with_wide_codec<Errc>(tree,
                               [&](const auto& codec) { return walk(tree, codec, query, leaves); });
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxtree {
namespace {

HWY_EXPORT(walk_cast);

}  // namespace

Errc walk_wide(const BoundTree& tree, CastQuery& query) {
  if (tree.has_float_nodes() && CastFilter::is_near(query)) {
    return HWY_DYNAMIC_DISPATCH(walk_cast)(tree, query);
  }
  return traverse_nearest(tree, ErasedCodec{&tree}, query);
}

}  // namespace boxtree
#endif
