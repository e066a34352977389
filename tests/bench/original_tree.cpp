// SPDX-License-Identifier: MIT
// Builds the original tree: splits come from the paper's builder, empty slabs are cut off by its 15
// % rule.
#include "tests/bench/original_tree.h"

#include <algorithm>
#include <cmath>

#include "cooker/encode/encoders.h"
#include "format/binary_node.h"
#include "format/limits.h"

namespace boxtree::bench {
namespace {

Box<float> in_object_space(const cooker::BuildTree& build, std::uint32_t node) {
  const Box<float>& bounds = build.nodes[node].bounds;
  Box<float> box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.low[k] = static_cast<float>(std::ldexp(double{bounds.low[k]}, build.scale_exponent) +
                                    build.origin[k]);
    box.high[k] = static_cast<float>(std::ldexp(double{bounds.high[k]}, build.scale_exponent) +
                                     build.origin[k]);
  }
  return box;
}

// The thickest empty slab as a share of the box.
struct Slab {
  double share = 0;
  std::size_t axis = 0;
  std::size_t side = 0;  // the remaining child: 0 when the slab is on the high side
  float cut = 0;
};

Slab thickest_slab(const Box<float>& box, const Box<float>& content) {
  Slab best;
  for (std::size_t k = 0; k < 3; ++k) {
    const double extent = double{box.high[k]} - double{box.low[k]};
    if (!(extent > 0)) continue;
    const float cuts[2] = {box.high[k] - content.high[k], content.low[k] - box.low[k]};
    for (std::size_t side = 0; side < 2; ++side) {
      if (double{cuts[side]} / extent > best.share) {
        best = {double{cuts[side]} / extent, k, side, cuts[side]};
      }
    }
  }
  return best;
}

}  // namespace

OriginalTree::OriginalTree(const cooker::BuildTree& build, const cooker::SourceMesh& mesh,
                           const std::vector<Eigen::Vector3f>& points) {
  if (build.nodes.empty()) return;
  root_box_ = in_object_space(build, 0);
  root_ = build_node(build, mesh, points.data(), 0, root_box_, 0);
}

OriginalTree::~OriginalTree() {
  free(root_);
}

void OriginalTree::free(OriginalNode* node) {
  if (node == nullptr) return;
  if (!node->is_leaf()) {
    for (OriginalNode* child : node->inner.child) free(child);
  }
  delete node;
}

OriginalNode* OriginalTree::build_node(const cooker::BuildTree& build,
                                       const cooker::SourceMesh& mesh,
                                       const Eigen::Vector3f* points, std::uint32_t source,
                                       const Box<float>& box, std::uint32_t depth) {
  ++node_count_;
  auto* const node = new OriginalNode;
  const cooker::BuildNode& split = build.nodes[source];
  if (split.is_leaf()) {
    node->cutplane = OriginalNode::kLeafFlag;
    node->leaf = {split.face(), 0, {}, points};
    std::copy_n(mesh.faces[split.face()].corner.begin(), 4, node->leaf.point);
    return node;
  }
  const Slab slab = thickest_slab(box, in_object_space(build, source));
  if (slab.share >= cooker::kShrinkShare && depth < kMaxDepth - split.height()) {
    node->cutplane = static_cast<std::uint32_t>(slab.axis);
    node->inner.cut[slab.side] = slab.cut;
    node->inner.child[slab.side] = build_node(
        build, mesh, points, source, child_box(box, slab.axis, slab.side, slab.cut), depth + 1);
    return node;
  }
  const std::size_t axis = split.axis();
  node->cutplane = split.axis();
  node->inner.cut[0] =
      std::max(0.0f, box.high[axis] - in_object_space(build, source + 1).high[axis]);
  node->inner.cut[1] =
      std::max(0.0f, in_object_space(build, split.right).low[axis] - box.low[axis]);
  for (std::size_t side = 0; side < 2; ++side) {
    node->inner.child[side] =
        build_node(build, mesh, points, side == 0 ? source + 1 : split.right,
                   child_box(box, axis, side, node->inner.cut[side]), depth + 1);
  }
  return node;
}

}  // namespace boxtree::bench
