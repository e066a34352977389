// SPDX-License-Identifier: MIT
// Casts over the wide codecs.
#include "runtime/query/cast_filter.h"
#include "runtime/query/cast_query.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/targets.h"
#include "runtime/walk/walk_tree.h"

#ifndef HWY_TARGET_INCLUDE  // compiled alone
#define HWY_TARGET_INCLUDE "runtime/query/cast_wide.cpp"
#endif
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include "runtime/query/moving_separation-inl.h"
#include "runtime/query/sphere_contacts-inl.h"
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
      : query_(query), filter_(filter), shape_(filter), leaf_(tree) {
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

  /// The same for the shape itself, as far as a few directions tell, from `enter` on.
  HWY_NOINLINE std::uint32_t advance_to_boxes(const VectorBox& box, FloatVector& enter) const {
    const MovingBoxes boxes(shape_, box, enter);
    MovingInterval interval;
    if (shape_.axes() == 3) {
      boxes.cut_by_axes(interval);
    } else {
      interval.cut(boxes.gap_along_way());
    }
    enter = hn::Add(enter, interval.enter());
    return bits_of(hn::And(interval.is_left(), hn::Le(enter, hn::Set(Floats(), bound_))));
  }

  /// Whether to go on.
  HWY_NOINLINE bool visit(std::uint32_t first, std::uint32_t count) {
    if (!leaf_.load(first, count)) return fail();
    for (std::size_t group = 0; group < leaf_.groups(); ++group) {
#if BOXTREE_FINDS_SPHERE_CONTACTS
      if (contacts_.are_wanted()) {
        if (!visit_contacts(group)) return false;
        continue;
      }
#endif
      HWY_ALIGN float key[kWideChildren], last[kWideChildren];
      std::uint32_t near = 0;
      for (std::size_t part = 0; part < kParts; ++part) {
        FloatVector enter, leave;
        near |= intersect(leaf_.bounds(group, part), enter, leave) << (part * kLanes);
        hn::Store(enter, Floats(), key + part * kLanes);
        hn::Store(leave, Floats(), last + part * kLanes);
      }
      near &= leaf_.lanes(group);
      const std::uint32_t sure = filter_.inside.is_known ? near & surely_touched(group) : 0;
      if (near != sure) near = sure | advance(group, near & ~sure, key, last);
      while (near != 0) {
        const std::uint32_t i = take_smallest(near, key);
        if (key[i] > bound_) break;
        const auto lane = static_cast<std::uint32_t>(group * kWideChildren) + i;
        if (((sure >> i) & 1u) != 0) {
          query_.take_face(leaf_.face(lane), leaf_.half(lane));
          if (query_.is_done()) return false;
          continue;
        }
        const double before = query_.t_max;
        if (!leaf_.with_triangle(
                lane, [&](const Triangle& triangle, std::uint32_t face, std::uint32_t half) {
                  query_.test(triangle, face, half);
                })) {
          return fail();
        }
        if (query_.is_done()) return false;
        if (query_.t_max == before) continue;
        set_bound();
        if (near != 0) near = touched_before_bound(group, near);
      }
    }
    return true;
  }

  /// Once nothing is left to walk: gives the query what was put off. `walked`: how that ended.
  [[nodiscard]] Errc finish(Errc walked) {
#if BOXTREE_FINDS_SPHERE_CONTACTS
    contacts_.visit_all();
    if (query_.faces.stopped) return Errc::kOk;
#endif
    return walked;
  }

 private:
  // For bytes that are corrupt: what comes before them is still visited.
  HWY_NOINLINE bool fail() {
    const Errc error = leaf_.error();
    if (finish(error) == error) query_.error = error;
    return false;
  }

  // Lanes of triangles that surely have a corner inside the shape.
  HWY_NOINLINE std::uint32_t surely_touched(std::size_t group) const {
    // More than coordinates less than 16 times as large as the largest that matter round by.
    const float error = shape_.error() + leaf_.corner_error();
    const FloatVector zero = hn::Zero(Floats());
    std::uint32_t bits = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
      const MovingTriangles triangles(filter_, leaf_, group, part, zero);
      FloatVector sum = zero;
      std::uint32_t held = 0;
      for (std::size_t c = 0; c < 3; ++c) {
        const Vector3& corner = triangles.corner(c);
        for (std::size_t k = 0; k < 3; ++k) sum = hn::Add(sum, corner.at[k]);
        held |= bits_of(shape_.hold(corner, error));
      }
      // A corner that is not finite, of corrupt bytes, is for the exact test to find.
      held &= bits_of(hn::Eq(hn::Mul(sum, zero), zero));
      bits |= held << (part * kLanes);
    }
    return bits;
  }

  void set_bound() {
    bound_ = filter_.bound(query_.t_max);
  }

#if BOXTREE_FINDS_SPHERE_CONTACTS
  // Visits contacts of a sphere with the triangles whose bounds it may touch, in their order: that
  // of `key` in visit(), since what stays where it is touches at once. Bounds of triangles are off
  // by leaf_.corner_error() besides, at most 2u of the largest coordinate: a way to them by 5u and
  // its projection by less than 30u, of 96u that advance_to_boxes() leaves (MovingFloats::error()).
  HWY_NOINLINE bool visit_contacts(std::size_t group) {
    std::uint32_t near = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
      FloatVector enter = hn::Zero(Floats());
      near |= advance_to_boxes(leaf_.bounds(group, part), enter) << (part * kLanes);
    }
    near &= leaf_.lanes(group);
    if (near == 0) return true;
    const bool is_read = for_each_bit(near, [&](std::uint32_t i) {
      return leaf_.with_triangle(static_cast<std::uint32_t>(group * kWideChildren) + i,
                                 [&](const Triangle& triangle, std::uint32_t face,
                                     std::uint32_t half) { contacts_.add(triangle, face, half); });
    });
    if (!is_read) return fail();
    contacts_.visit();
    return !query_.is_done();
  }
#endif

  // Raises `from`, from which on the shape may touch triangles, up to where it does. Returns those
  // of `near` that it may touch up to `to`.
  HWY_NOINLINE std::uint32_t advance(std::size_t group, std::uint32_t near, float* from,
                                     const float* to) const {
    std::uint32_t bits = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::uint32_t lanes = (near >> (part * kLanes)) & kAllLanes;
      if (lanes == 0) continue;
      const FloatVector last = hn::Load(Floats(), to + part * kLanes);
      FloatVector s = hn::Load(Floats(), from + part * kLanes);
      bits |= advance(group, part, lanes, s, last) << (part * kLanes);
      hn::Store(s, Floats(), from + part * kLanes);
    }
    return bits;
  }

  HWY_INLINE std::uint32_t advance(std::size_t group, std::size_t part, std::uint32_t lanes,
                                   FloatVector& s, FloatVector last) const {
    const FloatVector start = s;
    const auto cut = [&](const MovingInterval& interval) {
      s = hn::Add(start, interval.enter());
      lanes &= bits_of(hn::And(interval.is_left(), hn::Le(s, last)));
    };
    // What is round is not worth it: the line to the core tells more than all of these.
    const bool is_round = filter_.radius > 0;
    if (shape_.axes() == 3 || (shape_.axes() != 0 && !is_round)) {
      const MovingTriangles triangles(filter_, leaf_, group, part, start);
      MovingInterval interval;
      triangles.cut_by_faces(interval);
      cut(interval);
      if (lanes == 0) return 0;
      triangles.cut_by_edges(interval);
      cut(interval);
    }
    if (is_round) {
      if (query_.best.is_hit) lanes = touched_before_bound(group, part, lanes);
      if (lanes != 0) lanes = advance_round(group, part, lanes, s, last);
    }
    return lanes;
  }

  // The same for what is round, by steps of MovingShape::first_touch.
  HWY_NOINLINE std::uint32_t advance_round(std::size_t group, std::size_t part, std::uint32_t lanes,
                                           FloatVector& s, FloatVector last) const {
    const Floats d;
    Vector3 offset{{hn::Zero(d), hn::Zero(d), hn::Zero(d)}};
    for (int step = 0; step < kSteps && lanes != 0; ++step) {
      const MovingTriangles triangles(filter_, leaf_, group, part, s);
      MovingInterval interval;
      interval.cut(triangles.gap_along(triangles.way_from_core(offset)));
      const FloatVector later = interval.enter();
      s = hn::Add(s, later);
      lanes &= bits_of(hn::And(interval.is_left(), hn::Le(s, last)));
      if ((lanes & bits_of(hn::Gt(later, hn::Set(d, kSettled * filter_.error)))) == 0) break;
    }
    return lanes;
  }

  // Those of `near` that the shape can touch before the bound, as seen from there: not what a
  // direction separates then that it moves along, since the gap was larger before.
  HWY_NOINLINE std::uint32_t touched_before_bound(std::size_t group, std::uint32_t near) const {
    if (!(filter_.radius > 0)) return near;
    std::uint32_t bits = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::uint32_t lanes = (near >> (part * kLanes)) & kAllLanes;
      if (lanes != 0) bits |= touched_before_bound(group, part, lanes) << (part * kLanes);
    }
    return bits;
  }
  HWY_NOINLINE std::uint32_t touched_before_bound(std::size_t group, std::size_t part,
                                                  std::uint32_t lanes) const {
    const Floats d;
    Vector3 offset{{hn::Zero(d), hn::Zero(d), hn::Zero(d)}};
    const FloatVector s = hn::Set(d, bound_);
    const MovingTriangles triangles(filter_, leaf_, group, part, s);
    for (std::uint32_t step = 0; step <= shape_.axes() && lanes != 0; ++step) {
      lanes &= ~bits_of(triangles.gap_along(triangles.way_from_core(offset)).is_ahead());
    }
    return lanes;
  }
  static constexpr std::uint32_t kAllLanes = (1u << kLanes) - 1;

  // Near a touch each step squares what is left, and ends once it is about what rounding hides.
  static constexpr int kSteps = 4;
  static constexpr float kSettled = 64;

  CastQuery& query_;
  const CastFilter& filter_;
  MovingFloats shape_;
  LeafFloats leaf_;
#if BOXTREE_FINDS_SPHERE_CONTACTS
  SphereContacts contacts_{query_};
#endif
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
    return leaves_.intersect(boxes, key, leave) & leaves_.advance_to_boxes(boxes, key);
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
Errc walk_cast_nodes(const BoundTree& tree, const WideCodec<Node>& codec, CastQuery& query,
                     CastLeaves& leaves) {
  CastFaces<Node> faces(tree, codec, query, leaves);
  return NearestWalk<Node, CastFaces<Node>>(codec, faces).run(root_box<float>(tree));
}

Errc walk_cast(const BoundTree& tree, CastQuery& query) {
  const CastFilter filter(query);
  CastLeaves leaves(tree, query, filter);
  return leaves.finish(with_wide_codec<Errc>(
      tree, [&](const auto& codec) { return walk_cast_nodes(tree, codec, query, leaves); }));
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "runtime/walk/dispatch.h"

namespace boxtree {
namespace {

BOXTREE_EXPORT(walk_cast);

}  // namespace

Errc walk_wide(const BoundTree& tree, CastQuery& query) {
  if (tree.has_float_nodes() && CastFilter::is_near(query)) {
    return BOXTREE_DISPATCH(walk_cast)(tree, query);
  }
  return traverse_nearest(tree, ErasedCodec{&tree}, query);
}

}  // namespace boxtree
#endif
