// SPDX-License-Identifier: MIT
// Writes glTF 2.0 as one binary file (GLB). Each tree has a mesh of its triangles and a mesh of
// lines for each level of its boxes, in a colour per level. Each tree or instance has a node.
#pragma once

#include "cooker/export/shown_tree.h"

namespace boxtree::cooker {

class ByteSink;

/// The origin of a tree's positions in glTF, which stores only f32. It is zero for f32 positions,
/// which stay bit for bit. Otherwise it is near the centre of the tree, a multiple of a power of
/// two near its extent, so that grids of up to 24 bits are exact and other positions lose no more
/// than f32 requires. The origin is exact in f32, because many viewers store translations as f32.
[[nodiscard]] Eigen::Vector3d glb_translation(const Tree& tree);

/// Quads are split as in queries: (0,1,2) and (0,2,3). Boxes are rounded outward; `solid_boxes`
/// writes them as triangles. Axes are those of object space or of the world, not glTF's convention.
///
/// A tree without a scene is a node whose children have the meshes. An instance is a node with its
/// tree's triangles; its matrix is the pose, with all digits of f64, after the tree's
/// glb_translation, and its children have the boxes. If the pose shears, the node has a parent, so
/// that both have matrices that glTF allows (node_matrices). Faces are not reversed if a pose
/// mirrors, because glTF requires readers to do that.
///
/// Errors: kMeshUnsupported for positions beyond f32, kMeshTooLarge for more than 4 GiB.
Status write_glb(const Shown& shown, bool solid_boxes, ByteSink& out);

}  // namespace boxtree::cooker
