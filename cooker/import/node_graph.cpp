// SPDX-License-Identifier: MIT
// Walks the nodes once, with an explicit stack: files may nest to any depth.
#include "cooker/import/node_graph.h"

#include <algorithm>

#include <assimp/scene.h>

namespace boxtree::cooker {
namespace {

std::vector<unsigned> meshes_of(const aiScene& scene, const aiNode& node) {
  std::vector<unsigned> meshes;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const unsigned mesh = node.mMeshes[i];
    if (mesh < scene.mNumMeshes && scene.mMeshes[mesh] != nullptr) meshes.push_back(mesh);
  }
  return meshes;
}

bool has_faces(const aiMesh& mesh) {
  return std::any_of(mesh.mFaces, mesh.mFaces + mesh.mNumFaces,
                     [](const aiFace& face) { return face.mNumIndices >= 3; });
}

}  // namespace

Placements find_placements(const aiScene& scene) {
  struct Visit {
    const aiNode* node;
    Transform parent;
  };
  Placements placements;
  std::vector<bool> placed(scene.mNumMeshes, false);
  std::vector<Visit> stack;
  if (scene.mRootNode != nullptr) stack.push_back({scene.mRootNode, Transform()});
  while (!stack.empty()) {
    const Visit visit = stack.back();
    stack.pop_back();
    const aiNode& node = *visit.node;
    // A product with the identity would turn -0 into +0; only the signs of zeros depend on this.
    const Transform own = Transform::from(node.mTransformation);
    const Transform transform = own.is_identity() ? visit.parent : visit.parent * own;
    std::vector<unsigned> meshes = meshes_of(scene, node);
    for (const unsigned mesh : meshes) placed[mesh] = true;
    if (!meshes.empty()) {
      placements.all.push_back({node.mName.C_Str(), std::move(meshes), transform});
    }
    for (unsigned i = node.mNumChildren; i-- > 0;) {
      if (node.mChildren[i] != nullptr) stack.push_back({node.mChildren[i], transform});
    }
  }
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    if (placed[i] || scene.mMeshes[i] == nullptr) continue;
    placements.all.push_back({scene.mMeshes[i]->mName.C_Str(), {i}, Transform()});
    ++placements.unplaced;
  }
  return placements;
}

bool places_several(const aiScene& scene, const Placements& placements) {
  std::vector<bool> has(scene.mNumMeshes, false);
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    has[i] = scene.mMeshes[i] != nullptr && has_faces(*scene.mMeshes[i]);
  }
  std::size_t count = 0;
  for (const Placement& placement : placements.all) {
    const auto& meshes = placement.meshes;
    if (std::any_of(meshes.begin(), meshes.end(), [&has](unsigned mesh) { return has[mesh]; })) {
      if (++count == 2) return true;
    }
  }
  return false;
}

}  // namespace boxtree::cooker
