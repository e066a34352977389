// SPDX-License-Identifier: MIT
#include "cooker/import/scene_hash.h"

#include <cstddef>
#include <span>
#include <vector>

#include <assimp/scene.h>

#include "cooker/import/hash_mix.h"
#include "runtime/file/checksum.h"

namespace boxtree::cooker {
namespace {

template <class T>
std::uint64_t with_array(std::uint64_t hash, const T* array, std::size_t count) {
  return hash_with(hash, array == nullptr ? 0 : checksum(std::as_bytes(std::span(array, count))));
}

}  // namespace

std::uint64_t geometry_hash(const aiScene& scene) {
  std::uint64_t hash = scene.mNumMeshes;
  for (std::size_t i = 0; i < scene.mNumMeshes; ++i) {
    if (scene.mMeshes[i] == nullptr) continue;
    const aiMesh& mesh = *scene.mMeshes[i];
    hash = with_array(hash, mesh.mVertices, mesh.mNumVertices);
    hash = hash_with(hash_with(hash, mesh.mNumVertices), mesh.mNumFaces);
    for (std::size_t face = 0; face < mesh.mNumFaces; ++face) {
      const aiFace& corners = mesh.mFaces[face];
      hash = with_array(hash, corners.mIndices, corners.mNumIndices);
    }
  }
  std::vector<const aiNode*> ahead;
  if (scene.mRootNode != nullptr) ahead.push_back(scene.mRootNode);
  while (!ahead.empty()) {
    const aiNode* const last = ahead.back();
    ahead.pop_back();
    hash = hash_with(hash, last == nullptr ? 0 : 1);
    if (last == nullptr) continue;  // its reader of RAW leaves some out
    const aiNode& node = *last;
    hash = with_array(hash, &node.mTransformation, 1);
    hash = with_array(hash, node.mMeshes, node.mNumMeshes);
    hash = hash_with(hash, node.mNumChildren);
    ahead.insert(ahead.end(), node.mChildren, node.mChildren + node.mNumChildren);
  }
  return hash;
}

}  // namespace boxtree::cooker
