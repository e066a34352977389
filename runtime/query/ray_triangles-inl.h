// SPDX-License-Identifier: MIT
// A ray against the triangles of a leaf, in single precision first.
#if defined(BOXTREE_RUNTIME_QUERY_RAY_TRIANGLES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_QUERY_RAY_TRIANGLES_INL_H
#undef BOXTREE_RUNTIME_QUERY_RAY_TRIANGLES_INL_H
#else
#define BOXTREE_RUNTIME_QUERY_RAY_TRIANGLES_INL_H
#endif

#include "runtime/query/ray_filter.h"
#include "runtime/walk/leaf-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if HWY_TARGET != HWY_SCALAR

/// Bit i: the ray misses triangle i of a group and part of a leaf provably, or meets it beyond
/// `bound`. The test of triangle_ray.h in float: an area of corners at most `size` from the ray,
/// each coordinate off by at most 3 error, is off by less than 8 (size + 3 error) 3 error.
HWY_INLINE std::uint32_t missed_triangles(const LeafFloats& leaf, const RayFilter& filter,
                                          float bound, std::size_t group, std::size_t part) {
  const Floats d;
  FloatVector x[3], y[3];
  FloatVector size = hn::Zero(d);
  FloatVector first = hn::Zero(d), last = hn::Zero(d);
  for (std::size_t c = 0; c < 3; ++c) {
    const FloatVector z =
        hn::Sub(leaf.at(c, filter.axis_z, group, part), hn::Set(d, filter.origin[filter.axis_z]));
    x[c] = hn::NegMulAdd(
        hn::Set(d, filter.shear_x), z,
        hn::Sub(leaf.at(c, filter.axis_x, group, part), hn::Set(d, filter.origin[filter.axis_x])));
    y[c] = hn::NegMulAdd(
        hn::Set(d, filter.shear_y), z,
        hn::Sub(leaf.at(c, filter.axis_y, group, part), hn::Set(d, filter.origin[filter.axis_y])));
    size = hn::Max(size, hn::Max(hn::Abs(x[c]), hn::Abs(y[c])));
    const FloatVector depth = hn::Mul(z, hn::Set(d, filter.shear_z));
    first = c == 0 ? depth : hn::Min(first, depth);
    last = c == 0 ? depth : hn::Max(last, depth);
  }
  const auto area = [&](std::size_t from, std::size_t to) {
    return hn::MulSub(x[from], y[to], hn::Mul(y[from], x[to]));
  };
  const FloatVector a = area(2, 1), b = area(0, 2), c = area(1, 0);
  const FloatVector error = hn::Set(d, 3 * filter.error);
  const FloatVector doubt = hn::Mul(hn::Mul(hn::Set(d, 8.0f), error), hn::Add(size, error));
  const FloatVector smallest = hn::Min(a, hn::Min(b, c));
  const FloatVector largest = hn::Max(a, hn::Max(b, c));
  const auto apart = hn::And(hn::Gt(largest, doubt), hn::Lt(smallest, hn::Neg(doubt)));
  const auto beyond = hn::Or(hn::Gt(first, hn::Add(hn::Set(d, bound), error)),
                             hn::Lt(last, hn::Neg(hn::Add(error, error))));
  return bits_of(hn::Or(apart, beyond));
}

/// Calls test(triangle, face, half) with the triangles of the leaf that was loaded that single
/// precision leaves in doubt up to `bound`, filter.bound() of the ray. False when a triangle's
/// bytes are corrupt.
template <class Test>
HWY_INLINE bool test_triangles(LeafFloats& leaf, const RayFilter& filter, float bound,
                               const Test& test) {
  for (std::size_t group = 0; group < leaf.groups(); ++group) {
    std::uint32_t near = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
      near |= ~missed_triangles(leaf, filter, bound, group, part) << (part * kLanes);
    }
    near &= leaf.lanes(group);
    for (; near != 0; near &= near - 1) {
      const auto lane = static_cast<std::uint32_t>(group * kWideChildren) +
                        static_cast<std::uint32_t>(std::countr_zero(near));
      if (!leaf.with_triangle(lane, test)) return false;
    }
  }
  return true;
}

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
