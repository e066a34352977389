// SPDX-License-Identifier: MIT
// An assimp scene becomes a SourceScene: meshes that differ, instances, materials.
#pragma once

#include <string>

#include <boxtree/cooker/import/flatten.h>
#include <boxtree/cooker/import/node_graph.h>
#include <boxtree/cooker/import/source_scene.h>

struct aiScene;

namespace boxtree::cooker {

/// Puts `scene` into `out` and counts in `out.report`, as source_scene.h says of files with a node
/// graph. Frees each mesh of the scene as soon as it is no longer needed.
Status take_scene(aiScene& scene, const Placements& placements, const SourceContext& context,
                  SourceScene& out);

/// The same for files without a node graph: one instance `name` of what import_mesh makes of it.
Status take_whole(aiScene& scene, const Placements& placements, const SourceContext& context,
                  const std::string& name, SourceScene& out);

/// One instance of a mesh that our own readers read.
SourceScene scene_of(Imported&& imported, const std::string& name);

}  // namespace boxtree::cooker
