// SPDX-License-Identifier: MIT
// A lower bound of the distance from a point to triangles, tight except for rounding.
#if defined(BOXTREE_RUNTIME_QUERY_TRIANGLE_DISTANCE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_QUERY_TRIANGLE_DISTANCE_INL_H
#undef BOXTREE_RUNTIME_QUERY_TRIANGLE_DISTANCE_INL_H
#else
#define BOXTREE_RUNTIME_QUERY_TRIANGLE_DISTANCE_INL_H
#endif

#include "runtime/primitive/rounding.h"
#include "runtime/query/distance-inl.h"
#include "runtime/walk/leaf-inl.h"
#include "runtime/walk/vector3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if HWY_TARGET != HWY_SCALAR

/// From a point of the segment from the origin to `edge` to the end of `w`: never nearer than the
/// segment except for rounding. An edge without length counts as a point.
HWY_INLINE Vector3 from_segment(const Vector3& w, const Vector3& edge) {
  const Floats d;
  const FloatVector length =
      hn::Max(dot(edge, edge), hn::Set(d, std::numeric_limits<float>::min()));
  const FloatVector along =
      hn::Min(hn::Max(hn::Div(dot(w, edge), length), hn::Zero(d)), hn::Set(d, 1.0f));
  Vector3 rest;
  for (std::size_t k = 0; k < 3; ++k) rest.at[k] = hn::NegMulAdd(along, edge.at[k], w.at[k]);
  return rest;
}

/// Triangles of a part, seen from a point, or from one each.
///
/// Let u = 2^-24, e = error of the point, c = error of the corners, L and W the largest components
/// of edges and of the vectors w to the point, n = e1 x e2. Rounding differences, products and
/// sums, each bound doubled or more:
///   - an edge is off by 2 (c + u L), a component of n by 16 (c + u L) L; w is off by e + c + u W;
///   - an area n . (edge x w), at most 12 L^3 W, by D = 256 (c + u L) L^2 W + 32 L^3 (e + c + u W);
///   - a distance to an edge by 8 (e + c) + 32 u W: the foot may be off along the edge, which makes
///     the distance larger by its square only;
///   - a height n . w / |n| by 64 (c + u L) L W / |n| + 8 (e + c) + 32 u W.
/// A normal below 256 (c + u L) L has no certain direction; the height then counts as 0.
struct SeenTriangles {
  HWY_INLINE SeenTriangles(const Vector3& point, float point_error, const LeafFloats& leaf,
                           std::size_t group, std::size_t part) {
    const Floats d;
    const float c = leaf.corner_error();
    Vector3 corner[3];
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < 3; ++i) corner[i].at[k] = leaf.at(i, k, group, part);
    }
    e1 = minus(corner[1], corner[0]);
    e2 = minus(corner[2], corner[0]);
    e3 = minus(corner[2], corner[1]);
    w = minus(point, corner[0]);
    w1 = minus(point, corner[1]);
    n = cross(e1, e2);
    const FloatVector length = hn::Max(largest(e1), hn::Max(largest(e2), largest(e3)));
    const FloatVector away = hn::Max(largest(w), largest(w1));
    const FloatVector blur =
        hn::MulAdd(hn::Set(d, static_cast<float>(kRoundoffF32)), length, hn::Set(d, c));  // c + u L
    spread = hn::MulAdd(hn::Set(d, static_cast<float>(kRoundoffF32)), away,
                        hn::Set(d, point_error + c));  // e + c + u W
    const FloatVector length2 = hn::Mul(length, length);
    const FloatVector doubt =
        hn::Mul(length2, hn::MulAdd(hn::Mul(hn::Set(d, 256.0f), blur), away,
                                    hn::Mul(hn::Mul(hn::Set(d, 32.0f), length), spread)));
    const FloatVector area1 = dot(n, cross(w, e2)), area2 = dot(n, cross(e1, w));
    const FloatVector area3 = dot(n, cross(e3, w1));
    outside = hn::Lt(hn::Min(area1, hn::Min(area2, area3)), hn::Neg(doubt));
    const FloatVector normal = hn::Sqrt(dot(n, n));
    const FloatVector of_normal = hn::Mul(blur, length);
    const auto is_flat = hn::Gt(normal, hn::Mul(hn::Set(d, 256.0f), of_normal));
    const FloatVector height =
        hn::Div(hn::Sub(hn::Abs(dot(n, w)), hn::Mul(hn::Mul(hn::Set(d, 64.0f), of_normal), away)),
                hn::Max(normal, hn::Set(d, std::numeric_limits<float>::min())));
    plane = hn::IfThenElseZero(is_flat, height);
  }

  /// What rounding may add to a computed distance.
  [[nodiscard]] HWY_INLINE FloatVector error() const {
    return hn::Mul(hn::Set(Floats(), 32.0f), spread);
  }

  Vector3 e1, e2, e3;        // from corner 0 to 1, 0 to 2, 1 to 2
  Vector3 w, w1;             // from corners 0 and 1 to the point
  Vector3 n;                 // e1 x e2
  FloatVector spread;        // how far w is off
  FloatVector plane;         // no larger than the distance to the plane, but for error()
  hn::Mask<Floats> outside;  // the point certainly projects outside the triangle
};

/// No point of triangle i of a part is nearer than lane i. Where the point certainly projects
/// outside a triangle, the lane is the distance to its closest edge, otherwise the distance to its
/// plane, if that is less.
HWY_INLINE FloatVector triangle_distance(const PointFilter& point, const LeafFloats& leaf,
                                         std::size_t group, std::size_t part) {
  const Floats d;
  Vector3 p;
  for (std::size_t k = 0; k < 3; ++k) p.at[k] = hn::Set(d, point.center[k]);
  const SeenTriangles seen(p, point.error, leaf, group, part);
  const auto squared = [](const Vector3& v) { return dot(v, v); };
  const FloatVector edges = hn::Sqrt(hn::Min(
      squared(from_segment(seen.w, seen.e1)),
      hn::Min(squared(from_segment(seen.w, seen.e2)), squared(from_segment(seen.w1, seen.e3)))));
  const FloatVector distance = hn::IfThenElse(seen.outside, edges, hn::Min(edges, seen.plane));
  return hn::Max(hn::Sub(distance, seen.error()), hn::Zero(d));
}

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
