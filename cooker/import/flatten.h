// SPDX-License-Identifier: MIT
// Meshes of an assimp scene become one SourceMesh: transforms, welding, polygons.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cooker/import/face_intake.h"
#include "cooker/import/fbx_materials.h"
#include "cooker/import/import.h"
#include "cooker/import/node_graph.h"
#include "format/scene_record.h"

struct aiScene;

namespace boxtree::cooker {

/// What is known of a file beside assimp's scene.
struct SourceContext {
  const ImportOptions& options;
  std::string file;  // what errors call it
  /// Of each mesh of aiScene::mMeshes; empty where each has one material, and assimp knows it.
  std::span<const MeshMaterials> materials = {};
};

/// A mesh of aiScene::mMeshes, and where it goes.
struct MeshInstance {
  unsigned mesh;
  Transform transform;
};

/// For each mesh of aiScene::mMeshes, how often it is still to be taken over.
using MeshUses = std::vector<unsigned>;

/// Frees normals, colours and the like, which can be larger than all that is kept.
void free_attributes(aiScene& scene);

/// Puts `instances`, one after the other, into `out.mesh` and counts them in `out.report`, as
/// import.h says; none may be left. Frees each mesh of the scene as soon as `uses` says that nobody
/// wants it any more, so that the two never coexist whole. `materials` gets the runs of each
/// instance with faces; a material is a number of aiScene::mMaterials or kNoMaterial.
Status flatten_instances(aiScene& scene, std::span<const MeshInstance> instances, MeshUses& uses,
                         const SourceContext& context, Imported& out,
                         std::vector<MaterialRun>& materials);

/// The same for everything that is placed; kNoFaces when nothing comes of it.
Status flatten_scene(aiScene& scene, const Placements& placements, const SourceContext& context,
                     Imported& out, std::vector<MaterialRun>& materials);

}  // namespace boxtree::cooker
