// SPDX-License-Identifier: MIT
#include "cooker/import/gltf_stated_faces.h"

#include <algorithm>

#include <assimp/scene.h>
#include <fmt/format.h>

#include "cooker/import/gltf_accessor.h"
#include "cooker/import/gltf_document.h"

namespace boxtree::cooker {
namespace {

using Counts = decltype(StatedFaces::counts)::value_type;

Counts counts_of(const Json& document, const Json& primitive) {
  const std::uint64_t vertices = number_at(positions_of(document, primitive), "count", 0);
  const std::uint64_t corners =
      primitive.contains("indices")
          ? number_at(accessor_at(document, primitive, "indices"), "count", 0)
          : vertices;
  switch (number_at(primitive, "mode", 4)) {
    case 4:
      return {vertices, corners / 3};
    case 5:
    case 6:
      return {vertices, corners < 3 ? 0 : corners - 2};
    default:
      return {vertices, 0};
  }
}

Json only(const Json& object, std::initializer_list<const char*> keys) {
  Json out = Json::object();
  for (const char* key : keys) {
    const Json* const found = object.find(key);
    if (found != nullptr) out[key] = *found;
  }
  return out;
}

// Vertices that no face names assimp leaves out from version 5.3 on.
bool is_read_whole(const Counts& stated, const aiMesh& mesh) {
  return mesh.mNumVertices <= stated.first && mesh.mNumFaces == stated.second;
}

Error lost_faces(const aiMesh& mesh) {
  return {Errc::kMeshIndexOutOfRange,
          fmt::format("mesh '{}': faces name vertices that are not there; {} faces with {} "
                      "vertices are good",
                      mesh.mName.C_Str(), mesh.mNumFaces, mesh.mNumVertices)};
}

}  // namespace

StatedFaces stated_faces(const Json& document) {
  StatedFaces stated;
  stated.numbers.resize(array_at(document, "meshes").size());
  visit_primitives(document, [&](const Json&, std::size_t m, const Json& primitive, std::size_t) {
    stated.numbers[m].push_back(static_cast<std::uint32_t>(stated.counts.size()));
    stated.counts.push_back(counts_of(document, primitive));
  });
  stated.nodes = only(document, {"scene", "scenes"});
  Json& nodes = stated.nodes["nodes"] = Json::array();
  for (const Json& node : array_at(document, "nodes")) {
    nodes.push_back(only(node, {"children", "mesh"}));
  }
  return stated;
}

Status check_stated_faces(const StatedFaces& stated, const aiScene& scene) {
  if (stated.counts.empty()) return {};
  // Which primitive a mesh is, if that is known; else one of them has to be like it.
  const Result<std::vector<std::uint32_t>> primitives =
      numbers_of_meshes(stated.nodes, stated.numbers, scene, "faces");
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    if ((mesh.mPrimitiveTypes & aiPrimitiveType_TRIANGLE) == 0) continue;
    const auto is_it = [&](const Counts& counts) { return is_read_whole(counts, mesh); };
    const bool is_stated = primitives.ok()
                               ? is_it(stated.counts[(*primitives)[m]])
                               : std::any_of(stated.counts.begin(), stated.counts.end(), is_it);
    if (!is_stated) return lost_faces(mesh);
  }
  return {};
}

}  // namespace boxtree::cooker
