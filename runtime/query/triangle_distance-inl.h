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

/// Squared distance from the end of `w` to a point of the segment from the origin to `edge`: never
/// too small except for rounding. An edge without length counts as a point.
HWY_INLINE FloatVector squared_to_segment(const Vector3& w, const Vector3& edge) {
  const Floats d;
  const FloatVector length =
      hn::Max(dot(edge, edge), hn::Set(d, std::numeric_limits<float>::min()));
  const FloatVector along =
      hn::Min(hn::Max(hn::Div(dot(w, edge), length), hn::Zero(d)), hn::Set(d, 1.0f));
  Vector3 rest;
  for (std::size_t k = 0; k < 3; ++k) rest.at[k] = hn::NegMulAdd(along, edge.at[k], w.at[k]);
  return dot(rest, rest);
}

/// No point of triangle i of a part is nearer than lane i.
///
/// Where the point certainly projects outside a triangle, the lane is the distance to its closest
/// edge, otherwise the distance to its plane, if that is less. Let u = 2^-24, e = error of the
/// point, c = error of the corners, L and W the largest components of edges and of the vectors w to
/// the point, n = e1 x e2. Rounding differences, products and sums, each bound doubled or more:
///   - an edge is off by 2 (c + u L), a component of n by 16 (c + u L) L; w is off by e + c + u W;
///   - an area n . (edge x w), at most 12 L^3 W, by D = 256 (c + u L) L^2 W + 32 L^3 (e + c + u W);
///   - a distance to an edge by 8 (e + c) + 32 u W: the foot may be off along the edge, which makes
///     the distance larger by its square only;
///   - a height n . w / |n| by 64 (c + u L) L W / |n| + 8 (e + c) + 32 u W.
/// A normal below 256 (c + u L) L has no certain direction; the height then counts as 0.
HWY_INLINE FloatVector triangle_distance(const PointFilter& point, const LeafFloats& leaf,
                                         std::size_t group, std::size_t part) {
  const Floats d;
  const float c = leaf.corner_error();
  Vector3 p, corner[3];
  for (std::size_t k = 0; k < 3; ++k) {
    p.at[k] = hn::Set(d, point.center[k]);
    for (std::size_t i = 0; i < 3; ++i) corner[i].at[k] = leaf.at(i, k, group, part);
  }
  const Vector3 e1 = minus(corner[1], corner[0]), e2 = minus(corner[2], corner[0]);
  const Vector3 e3 = minus(corner[2], corner[1]);
  const Vector3 w = minus(p, corner[0]), w1 = minus(p, corner[1]);
  const Vector3 n = cross(e1, e2);
  const FloatVector length = hn::Max(largest(e1), hn::Max(largest(e2), largest(e3)));
  const FloatVector away = hn::Max(largest(w), largest(w1));
  const FloatVector blur =
      hn::MulAdd(hn::Set(d, static_cast<float>(kRoundoffF32)), length, hn::Set(d, c));  // c + u L
  const FloatVector spread = hn::MulAdd(hn::Set(d, static_cast<float>(kRoundoffF32)), away,
                                        hn::Set(d, point.error + c));  // e + c + u W

  const FloatVector length2 = hn::Mul(length, length);
  const FloatVector doubt =
      hn::Mul(length2, hn::MulAdd(hn::Mul(hn::Set(d, 256.0f), blur), away,
                                  hn::Mul(hn::Mul(hn::Set(d, 32.0f), length), spread)));
  const FloatVector area1 = dot(n, cross(w, e2)), area2 = dot(n, cross(e1, w));
  const FloatVector area3 = dot(n, cross(e3, w1));
  const auto outside = hn::Lt(hn::Min(area1, hn::Min(area2, area3)), hn::Neg(doubt));

  const FloatVector edges = hn::Sqrt(hn::Min(
      squared_to_segment(w, e1), hn::Min(squared_to_segment(w, e2), squared_to_segment(w1, e3))));
  const FloatVector normal = hn::Sqrt(dot(n, n));
  const FloatVector of_normal = hn::Mul(blur, length);
  const auto is_flat = hn::Gt(normal, hn::Mul(hn::Set(d, 256.0f), of_normal));
  const FloatVector height =
      hn::Div(hn::Sub(hn::Abs(dot(n, w)), hn::Mul(hn::Mul(hn::Set(d, 64.0f), of_normal), away)),
              hn::Max(normal, hn::Set(d, std::numeric_limits<float>::min())));
  const FloatVector plane = hn::IfThenElseZero(is_flat, height);
  const FloatVector distance = hn::IfThenElse(outside, edges, hn::Min(edges, plane));
  return hn::Max(hn::NegMulAdd(hn::Set(d, 32.0f), spread, distance), hn::Zero(d));
}

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
