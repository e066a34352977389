// SPDX-License-Identifier: MIT
// Points and vectors in space, one per lane.
#if defined(BOXTREE_RUNTIME_WALK_VECTOR3_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_WALK_VECTOR3_INL_H
#undef BOXTREE_RUNTIME_WALK_VECTOR3_INL_H
#else
#define BOXTREE_RUNTIME_WALK_VECTOR3_INL_H
#endif

#include "runtime/walk/node-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {

struct Vector3 {
  FloatVector at[3];
};

HWY_INLINE Vector3 minus(const Vector3& a, const Vector3& b) {
  return {{hn::Sub(a.at[0], b.at[0]), hn::Sub(a.at[1], b.at[1]), hn::Sub(a.at[2], b.at[2])}};
}
HWY_INLINE FloatVector dot(const Vector3& a, const Vector3& b) {
  return hn::MulAdd(a.at[0], b.at[0], hn::MulAdd(a.at[1], b.at[1], hn::Mul(a.at[2], b.at[2])));
}
HWY_INLINE Vector3 cross(const Vector3& a, const Vector3& b) {
  return {{hn::MulSub(a.at[1], b.at[2], hn::Mul(a.at[2], b.at[1])),
           hn::MulSub(a.at[2], b.at[0], hn::Mul(a.at[0], b.at[2])),
           hn::MulSub(a.at[0], b.at[1], hn::Mul(a.at[1], b.at[0]))}};
}
/// The largest magnitude of a component.
HWY_INLINE FloatVector largest(const Vector3& a) {
  return hn::Max(hn::Abs(a.at[0]), hn::Max(hn::Abs(a.at[1]), hn::Abs(a.at[2])));
}

}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
