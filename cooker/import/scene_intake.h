// SPDX-License-Identifier: MIT
// Converts an assimp scene to a SourceScene: distinct meshes, instances, materials.
#pragma once

#include "cooker/import/face_materials.h"
#include "cooker/import/flatten.h"
#include "cooker/import/node_graph.h"
#include "cooker/import/source_scene.h"

struct aiScene;

namespace boxtree::cooker {

/// Adds `scene` to `out` and counts in `out.report`, as source_scene.h specifies for files with a
/// node graph. Frees each mesh of the scene after its last use.
Status take_scene(aiScene& scene, const Placements& placements, const SourceContext& context,
                  SourceScene& out);

/// The materials of a flattened scene, of which only the materials have to be left; `runs` are
/// those of flatten_scene.
[[nodiscard]] FaceMaterials take_materials(const aiScene& scene, std::span<const FaceRun> runs);

}  // namespace boxtree::cooker
