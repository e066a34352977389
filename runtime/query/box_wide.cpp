// SPDX-License-Identifier: MIT
// Box queries over the wide codecs.
#include "runtime/query/shape_query.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/targets.h"
#include "runtime/walk/walk_tree.h"

#ifndef HWY_TARGET_INCLUDE  // compiled alone
#define HWY_TARGET_INCLUDE "runtime/query/box_wide.cpp"
#endif
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include "runtime/query/box_filter-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
Errc walk_box(const BoundTree& tree, FaceWalk<BoxQuery>& faces) {
  return traverse_overlap(tree, ErasedCodec{&tree}, faces);
}
#else
Errc walk_box(const BoundTree& tree, FaceWalk<BoxQuery>& faces) {
  return with_wide_codec<Errc>(
      tree, [&](const auto& codec) { return walk<BoxFilter>(tree, codec, faces); });
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "runtime/walk/dispatch.h"

namespace boxtree {
namespace {

BOXTREE_EXPORT(walk_box);

}  // namespace

Errc walk_wide(const BoundTree& tree, FaceWalk<BoxQuery>& walk) {
  if (tree.has_float_nodes()) {
    return BOXTREE_DISPATCH(walk_box)(tree, walk);
  }
  return traverse_overlap(tree, ErasedCodec{&tree}, walk);
}

}  // namespace boxtree
#endif
