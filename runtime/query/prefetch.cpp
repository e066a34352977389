// SPDX-License-Identifier: MIT
// Reads the upper nodes of a tree ahead of its queries. Nodes of a level are scattered over the
// section in every codec, so they are found as a query finds them: from the root down.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include <boxtree/tree.h>

#include "format/codec_wide.h"
#include "format/limits.h"
#include "runtime/primitive/float_state.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/work.h"

namespace boxtree {
namespace {

// A node to read, and how many levels to read from it on.
struct Pending {
  NodeRef ref;
  std::uint32_t levels;
};

// All but one child of each node on a path, and the root.
constexpr std::size_t kMostPending =
    std::max<std::size_t>(kMaxWideDepth * (kWideChildren - 1), kMaxDepth) + 1;

}  // namespace

std::uint32_t Tree::prefetch(std::uint32_t levels) const noexcept {
  const DefaultFloatState state;
  const BoundTree& tree = BoundTree::of(*this);
  if (levels == 0 || !tree.has_nodes()) return 0;
  std::uint32_t read = 0;
  WalkBound bound(tree.node_count());
  WalkStack<Pending, kMostPending> stack;
  Errc error = stack.push({tree.root_ref(), levels});
  AnyChildren children;
  while (error == Errc::kOk && !stack.empty()) {
    const Pending node = stack.pop();
    // Only references are followed, and they do not depend on boxes: any box will do.
    const NodeState read_node =
        tree.codec_functions().expand(tree.nodes(), node.ref, tree.root_f64(), children);
    error = bound.count(read_node);
    if (error != Errc::kOk) break;
    ++read;
    if (node.levels == 1) continue;
    for (std::uint32_t i = 0; i < children.count && error == Errc::kOk; ++i) {
      if (!children.is_leaf(i)) error = stack.push({children.ref[i], node.levels - 1});
    }
  }
  return read;
}

}  // namespace boxtree
