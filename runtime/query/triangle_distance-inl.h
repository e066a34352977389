// SPDX-License-Identifier: MIT
// A lower bound of the distance from a point to triangles, tight except for rounding; what depends
// on the triangles alone is computed once for several points.
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

/// 1 / the squared length of an edge; of one without length that of a very short one.
HWY_INLINE FloatVector inverse_square(const Vector3& edge) {
  const Floats d;
  return hn::Div(hn::Set(d, 1.0f),
                 hn::Max(dot(edge, edge), hn::Set(d, std::numeric_limits<float>::min())));
}

/// From a point of the segment from the origin to `edge` to the end of `w`: never nearer than the
/// segment except for rounding. An edge without length counts as a point. `inverse`: its
/// inverse_square().
HWY_INLINE Vector3 from_segment(const Vector3& w, const Vector3& edge, FloatVector inverse) {
  const Floats d;
  const FloatVector along =
      hn::Min(hn::Max(hn::Mul(dot(w, edge), inverse), hn::Zero(d)), hn::Set(d, 1.0f));
  Vector3 rest;
  for (std::size_t k = 0; k < 3; ++k) rest.at[k] = hn::NegMulAdd(along, edge.at[k], w.at[k]);
  return rest;
}
HWY_INLINE Vector3 from_segment(const Vector3& w, const Vector3& edge) {
  return from_segment(w, edge, inverse_square(edge));
}

/// What of the distance from a point to the triangles of a part depends on the triangles alone.
///
/// Let u = 2^-24, e = error of the point, c = error of the corners, L and W the largest components
/// of edges and of the vectors w to the point, n = e1 x e2. Rounding differences, products and
/// sums, each bound doubled or more:
///   - an edge is off by 2 (c + u L), a component of n, at most 2 L^2, by 16 (c + u L) L; w is off
///     by e + c + u W;
///   - a side, an edge x n, at most 4 L^3, by 96 (c + u L) L^2;
///   - side . w by D = 512 (c + u L) L^2 W + 128 L^3 (e + c + u W);
///   - a distance to an edge by 8 (e + c) + 32 u W: the foot may be off along the edge, which makes
///     the distance larger by its square only;
///   - a height n . w / |n| by 64 (c + u L) L W / |n| + 8 (e + c) + 32 u W.
/// A normal below 256 (c + u L) L has no certain direction; the height then counts as 0.
struct PreparedTriangles {
  PreparedTriangles() = default;
  HWY_INLINE PreparedTriangles(const LeafFloats& leaf, std::size_t group, std::size_t part) {
    const Floats d;
    corner_error = leaf.corner_error();
    Vector3 corner2;
    for (std::size_t k = 0; k < 3; ++k) {
      corner0.at[k] = leaf.at(0, k, group, part);
      corner1.at[k] = leaf.at(1, k, group, part);
      corner2.at[k] = leaf.at(2, k, group, part);
    }
    e1 = minus(corner1, corner0);
    e2 = minus(corner2, corner0);
    e3 = minus(corner2, corner1);
    n = cross(e1, e2);
    side1 = cross(e2, n);
    side2 = cross(n, e1);
    side3 = cross(n, e3);
    inverse1 = inverse_square(e1);
    inverse2 = inverse_square(e2);
    inverse3 = inverse_square(e3);
    const FloatVector length = hn::Max(largest(e1), hn::Max(largest(e2), largest(e3)));
    const FloatVector blur = hn::MulAdd(hn::Set(d, static_cast<float>(kRoundoffF32)), length,
                                        hn::Set(d, corner_error));  // c + u L
    const FloatVector length2 = hn::Mul(length, length);
    doubt_away = hn::Mul(hn::Mul(hn::Set(d, 512.0f), blur), length2);
    doubt_spread = hn::Mul(hn::Mul(hn::Set(d, 128.0f), length), length2);
    const FloatVector normal = hn::Sqrt(dot(n, n));
    const FloatVector of_normal = hn::Mul(blur, length);
    const auto is_certain = hn::Gt(normal, hn::Mul(hn::Set(d, 256.0f), of_normal));
    off_normal = hn::Mul(hn::Set(d, 64.0f), of_normal);
    per_normal = hn::IfThenElseZero(
        is_certain,
        hn::Div(hn::Set(d, 1.0f), hn::Max(normal, hn::Set(d, std::numeric_limits<float>::min()))));
  }

  Vector3 corner0, corner1;
  Vector3 e1, e2, e3;                        // from corner 0 to 1, 0 to 2, 1 to 2
  Vector3 n;                                 // e1 x e2
  Vector3 side1, side2, side3;               // e2 x n, n x e1, n x e3
  FloatVector inverse1, inverse2, inverse3;  // of the squared lengths of edges
  FloatVector doubt_away, doubt_spread;      // D per W, and per e + c + u W
  FloatVector off_normal;                    // how far n . w is off, per W
  FloatVector per_normal;                    // 1 / |n|, or 0 where its direction is uncertain
  float corner_error;
};

/// No point of triangle i is nearer than lane i. Where the point certainly projects outside a
/// triangle, the lane is the distance to its closest edge, otherwise the distance to its plane, if
/// that is less.
HWY_INLINE FloatVector triangle_distance(const PointFilter& point, const PreparedTriangles& of) {
  const Floats d;
  Vector3 p;
  for (std::size_t k = 0; k < 3; ++k) p.at[k] = hn::Set(d, point.center[k]);
  const Vector3 w = minus(p, of.corner0), w1 = minus(p, of.corner1);
  const FloatVector away = hn::Max(largest(w), largest(w1));
  const FloatVector spread = hn::MulAdd(hn::Set(d, static_cast<float>(kRoundoffF32)), away,
                                        hn::Set(d, point.error + of.corner_error));  // e + c + u W
  const FloatVector doubt = hn::MulAdd(of.doubt_away, away, hn::Mul(of.doubt_spread, spread));
  const FloatVector sides = hn::Min(dot(w, of.side1), hn::Min(dot(w, of.side2), dot(w1, of.side3)));
  const auto is_outside = hn::Lt(sides, hn::Neg(doubt));
  const FloatVector plane =
      hn::Mul(hn::Sub(hn::Abs(dot(of.n, w)), hn::Mul(of.off_normal, away)), of.per_normal);
  const auto squared = [](const Vector3& v) { return dot(v, v); };
  const FloatVector edges =
      hn::Sqrt(hn::Min(squared(from_segment(w, of.e1, of.inverse1)),
                       hn::Min(squared(from_segment(w, of.e2, of.inverse2)),
                               squared(from_segment(w1, of.e3, of.inverse3)))));
  const FloatVector distance = hn::IfThenElse(is_outside, edges, hn::Min(edges, plane));
  // What rounding may add to a computed distance.
  const FloatVector error = hn::Mul(hn::Set(d, 32.0f), spread);
  return hn::Max(hn::Sub(distance, error), hn::Zero(d));
}

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
