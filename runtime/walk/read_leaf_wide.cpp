// SPDX-License-Identifier: MIT
#include "runtime/walk/read_leaf.h"
#include "runtime/walk/targets.h"

#ifndef HWY_TARGET_INCLUDE  // compiled alone
#define HWY_TARGET_INCLUDE "runtime/walk/read_leaf_wide.cpp"
#endif
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include "runtime/walk/leaf-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if BOXTREE_HAS_EIGHT_LANES
bool read_triangles(const BoundTree& tree, NodeRef leaf, TriangleBatch& out) {
  LeafFloats floats(tree);
  return floats.load(leaf.first, leaf.second) && floats.exact_triangles(out);
}
#else
bool read_triangles(const BoundTree&, NodeRef, TriangleBatch&) {
  return false;
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "runtime/walk/dispatch.h"

namespace boxtree {
namespace {

BOXTREE_EXPORT(read_triangles);

}  // namespace

bool read_leaf_wide(const BoundTree& tree, NodeRef leaf, TriangleBatch& out) noexcept {
  return BOXTREE_DISPATCH(read_triangles)(tree, leaf, out);
}

}  // namespace boxtree
#endif
