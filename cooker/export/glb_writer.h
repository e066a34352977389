// SPDX-License-Identifier: MIT
// glTF 2.0 in one binary file (GLB): for each tree a mesh of its triangles and one of lines for
// each level of its boxes, each level in a colour of its own; a node for each tree or instance.
#pragma once

#include "cooker/export/shown_tree.h"

namespace boxtree::cooker {

class ByteSink;

/// Where positions of a tree are counted from, as glTF holds f32 alone: zero for f32 positions,
/// which stay bit for bit; else near the middle of the tree, in steps of a power of two near its
/// extent, so that a grid of up to 24 bits loses nothing and others no more than f32 must. Exact in
/// f32 itself, as many viewers hold translations so.
[[nodiscard]] Eigen::Vector3d glb_translation(const Tree& tree);

/// Quads are split as queries see them: (0,1,2) and (0,2,3). Boxes are rounded outward;
/// `solid_boxes` makes triangles of them. Axes stay those of object space, or of the world,
/// whatever glTF says of its own.
///
/// A tree by itself is a node, below which each mesh has its own. An instance is a node with its
/// tree's triangles, in all digits of f64 the matrix of its pose, after the tree's glb_translation,
/// and children with the boxes. Where the pose shears, the node stands below another, so that both
/// have matrices that glTF allows (node_matrices). Faces stay as they are where a pose mirrors:
/// glTF has readers turn them round.
///
/// Errors: kMeshUnsupported for positions beyond f32, kMeshTooLarge for more than 4 GiB.
Status write_glb(const Shown& shown, bool solid_boxes, ByteSink& out);

}  // namespace boxtree::cooker
