// SPDX-License-Identifier: MIT
// Both readings visit the file in the same order: the parts of a split mesh are consecutive, and
// each part has its faces in the order of the file. The faces of a mesh are therefore an
// interleaving of the faces of its parts.
#include "cooker/import/fbx_materials.h"

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>

#include <assimp/mesh.h>
#include <assimp/scene.h>

namespace boxtree::cooker {
namespace {

std::array<std::uint32_t, 3> bits_of(const aiVector3D& v) {
  return {std::bit_cast<std::uint32_t>(v.x), std::bit_cast<std::uint32_t>(v.y),
          std::bit_cast<std::uint32_t>(v.z)};
}

// Whether two faces have the same corners, bit for bit.
bool is_equal(const aiMesh& a, const aiFace& face_of_a, const aiMesh& b, const aiFace& face_of_b) {
  if (face_of_a.mNumIndices != face_of_b.mNumIndices) return false;
  for (unsigned corner = 0; corner < face_of_a.mNumIndices; ++corner) {
    const unsigned i = face_of_a.mIndices[corner], j = face_of_b.mIndices[corner];
    if (i >= a.mNumVertices || j >= b.mNumVertices) return false;
    if (bits_of(a.mVertices[i]) != bits_of(b.mVertices[j])) return false;
  }
  return true;
}

const MeshMaterials kUnknown = {{0, kNoMaterial}};

// Matches the faces of `mesh` one by one with the fronts of its parts, trying the part of the
// previous face first.
MeshMaterials materials_of(const aiMesh& mesh, std::span<aiMesh* const> parts) {
  std::vector<unsigned> taken(parts.size(), 0);
  MeshMaterials runs;
  std::uint32_t face_id = 0;
  std::size_t part = 0;
  for (unsigned i = 0; i < mesh.mNumFaces; ++i) {
    const aiFace& face = mesh.mFaces[i];
    std::size_t tried = 0;
    for (; tried < parts.size(); ++tried, part = (part + 1) % parts.size()) {
      const aiMesh& candidate = *parts[part];
      if (taken[part] == candidate.mNumFaces) continue;
      if (is_equal(mesh, face, candidate, candidate.mFaces[taken[part]])) break;
    }
    if (tried == parts.size()) return kUnknown;
    ++taken[part];
    if (face.mNumIndices < 3) continue;
    const std::uint32_t material = parts[part]->mMaterialIndex;
    if (runs.empty() || runs.back().number != material) runs.push_back({face_id, material});
    ++face_id;
  }
  return runs;
}

}  // namespace

std::vector<MeshMaterials> match_materials(aiScene& in_order, aiScene& sorted) {
  std::vector<MeshMaterials> materials(in_order.mNumMeshes, kUnknown);
  std::span<aiMesh* const> rest(sorted.mMeshes, sorted.mNumMeshes);
  for (unsigned i = 0; i < in_order.mNumMeshes; ++i) {
    const aiMesh& mesh = *in_order.mMeshes[i];
    std::size_t parts = 0, faces = 0;
    while (parts < rest.size() && faces < mesh.mNumFaces) faces += rest[parts++]->mNumFaces;
    if (faces != mesh.mNumFaces) break;
    materials[i] = materials_of(mesh, rest.first(parts));
    rest = rest.subspan(parts);
  }
  std::swap(in_order.mMaterials, sorted.mMaterials);
  std::swap(in_order.mNumMaterials, sorted.mNumMaterials);
  return materials;
}

}  // namespace boxtree::cooker
