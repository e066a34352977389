// SPDX-License-Identifier: MIT
// Batches of spheres over the wide codecs.
#include "runtime/query/overlap_batch_query.h"
#include "runtime/walk/targets.h"

#ifndef HWY_TARGET_INCLUDE  // compiled alone
#define HWY_TARGET_INCLUDE "runtime/query/sphere_batch_wide.cpp"
#endif
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include "runtime/query/sphere_filter-inl.h"
#include "runtime/walk/overlap_packets-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

void walk_sphere_batch(SphereBatch& batch) {
#if HWY_TARGET == HWY_SCALAR
  for (std::size_t i = 0; i < batch.shapes.size(); ++i) batch.answer_alone(i);
#else
  walk_packets<SphereFilter>(batch);
#endif
}

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "runtime/walk/dispatch.h"

namespace boxtree {
namespace {

BOXTREE_EXPORT(walk_sphere_batch);

}  // namespace

void walk_wide(SphereBatch& batch) {
  BOXTREE_DISPATCH(walk_sphere_batch)(batch);
}

}  // namespace boxtree
#endif
