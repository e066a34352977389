// SPDX-License-Identifier: MIT
// Edges where instances of a scene meet (reader: format/instance_edges.h).
#pragma once

#include <span>

#include <boxtree/tree.h>

#include "cooker/encode/encoded_scene.h"

namespace boxtree::cooker {

/// Finds the edges that one face of a tree has alone, but not where an instance at rest is placed:
/// there they are also such edges of one other face, or sheet, of the scene, and the surface goes
/// on flat or rises, seen from the front of the instance's face. Lists them in `parts`. Corners are
/// one if their positions in the world, as a reader computes them, are equal. `arrays`: of the
/// trees with external geometry, by tree. O(n log n + m), with n instances and m pairs of those
/// whose boxes overlap, and O(faces) of trees that are placed. Errors: those of binding a tree.
/// Precondition: 0 <= degrees <= 90; trees have faces.
Status find_instance_edges(std::span<const EncodedTree> trees, std::span<const MeshArrays> arrays,
                           double degrees, SceneParts& parts);

}  // namespace boxtree::cooker
