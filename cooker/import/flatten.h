// SPDX-License-Identifier: MIT
// Converts meshes of an assimp scene to one SourceMesh: transforms, welding, polygons.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "cooker/import/face_intake.h"
#include "cooker/import/fbx_materials.h"
#include "cooker/import/import.h"
#include "cooker/import/node_graph.h"
#include "format/face_numbers.h"

struct aiScene;

namespace boxtree::cooker {

/// Facts about a file that are not in assimp's scene.
struct SourceContext {
  const ImportOptions& options;
  std::string file;  // the name of the file in errors
  /// Per mesh of aiScene::mMeshes; empty if each has the one material that assimp states.
  std::span<const MeshMaterials> materials = {};
  /// Likewise, the user data of all faces of each mesh; empty if none is wanted.
  std::span<const std::uint32_t> user_data = {};
  /// loss_in_text (f32_digits.h) of a text; 0 for files that are none.
  double loss_in_text = 0;
};

/// A mesh of aiScene::mMeshes and its transform.
struct MeshInstance {
  unsigned mesh;
  Transform transform;
};

/// For each mesh of aiScene::mMeshes, the number of instances not flattened yet.
using MeshUses = std::vector<unsigned>;

/// Frees normals, colours and the like, which can be larger than all data that is kept.
void free_attributes(aiScene& scene);

/// Adds `instances`, one after another, to `out.mesh` and counts them in `out.report`, as specified
/// in import.h; the result may be empty. Frees each mesh of the scene after its last use according
/// to `uses`, so that source and result never coexist whole. `materials` gets the runs of each
/// instance with faces; a material is an index into aiScene::mMaterials or kNoMaterial. Adds to
/// `out.user_data`, if it is wanted.
Status flatten_instances(aiScene& scene, std::span<const MeshInstance> instances, MeshUses& uses,
                         const SourceContext& context, Imported& out,
                         std::vector<FaceRun>& materials);

/// The same for all placements; kNoFaces if the result is empty.
Status flatten_scene(aiScene& scene, const Placements& placements, const SourceContext& context,
                     Imported& out, std::vector<FaceRun>& materials);

}  // namespace boxtree::cooker
