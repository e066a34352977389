// SPDX-License-Identifier: MIT
// An assimp scene becomes a SourceScene: meshes that differ, instances, materials.
#pragma once

#include "cooker/import/flatten.h"
#include "cooker/import/node_graph.h"
#include "cooker/import/source_scene.h"

struct aiScene;

namespace boxtree::cooker {

/// Puts `scene` into `out` and counts in `out.report`, as source_scene.h says of files with a node
/// graph. Frees each mesh of the scene as soon as it is no longer needed.
Status take_scene(aiScene& scene, const Placements& placements, const SourceContext& context,
                  SourceScene& out);

}  // namespace boxtree::cooker
