// SPDX-License-Identifier: MIT
// The triangles of a leaf before a point: a filter by vectors, then the exact test.
#if defined(BOXTREE_RUNTIME_QUERY_POINT_TRIANGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_QUERY_POINT_TRIANGLES_INL_H
#undef BOXTREE_RUNTIME_QUERY_POINT_TRIANGLES_INL_H
#else
#define BOXTREE_RUNTIME_QUERY_POINT_TRIANGLES_INL_H
#endif

#include <cmath>

#include "runtime/primitive/rounding.h"
#include "runtime/query/point_query.h"
#include "runtime/query/triangle_distance-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if HWY_TARGET != HWY_SCALAR

/// What cannot improve the answer of a query, in single precision.
struct PointBounds {
  /// `best`: the squared distance of the answer so far.
  HWY_INLINE void set(double best) {
    squared = PointFilter::above(best);
    set_distance(best);
  }
  /// The same, of a bound in single precision; where it is not below what is known, nothing.
  HWY_INLINE void tighten(float to_squared) {
    if (!(to_squared < squared)) return;
    squared = to_squared;
    set_distance(double{to_squared});
  }

  float squared;   // squared distances above it
  float distance;  // distances above it

 private:
  HWY_INLINE void set_distance(double best) {
    distance = float_above(std::sqrt(best)) * static_cast<float>(1 + 2 * kRoundoffF32);
  }
};

/// Tests those triangles of a leaf that can matter. False when its bytes are corrupt: see
/// leaf.error(). `prepared(group, part)`: PreparedTriangles of the leaf.
template <class Prepared>
HWY_INLINE bool test_triangles(LeafFloats& leaf, const Prepared& prepared,
                               const PointFilter& filter, PointQuery& query, PointBounds& bounds) {
  for (std::size_t group = 0; group < leaf.groups(); ++group) {
    HWY_ALIGN float distance[kWideChildren];
    std::uint32_t near = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
      const FloatVector bound = triangle_distance(filter, prepared(group, part));
      hn::Store(bound, Floats(), distance + part * kLanes);
      near |= bits_of(hn::Not(hn::Gt(bound, hn::Set(Floats(), bounds.distance))))
              << (part * kLanes);
    }
    near &= leaf.lanes(group);
    while (near != 0) {
      const std::uint32_t i = take_smallest(near, distance);
      if (distance[i] > bounds.distance) break;
      const auto lane = static_cast<std::uint32_t>(group * kWideChildren) + i;
      const bool is_read =
          leaf.with_triangle(lane, [&](const Triangle& triangle, std::uint32_t face,
                                       std::uint32_t half) { query.test(triangle, face, half); });
      if (!is_read) return false;
      bounds.set(query.best);
    }
  }
  return true;
}

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
