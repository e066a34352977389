// SPDX-License-Identifier: MIT
// Walks the nodes of the document and of assimp side by side.
#include "cooker/import/gltf_primitives.h"

#include <optional>
#include <string>
#include <utility>

#include <assimp/scene.h>
#include <fmt/format.h>

namespace boxtree::cooker {

std::string name_of_mesh(const Json& mesh, std::size_t number) {
  const Json* const name = mesh.find("name");
  std::string text = name != nullptr && name->is_string() ? name->get<std::string>() : "";
  return !text.empty() ? text : fmt::format("mesh {}", number);
}

Result<std::vector<std::uint32_t>> numbers_of_meshes(const Json& document,
                                                     const PrimitiveNumbers& numbers,
                                                     const aiScene& scene, std::string_view what) {
  const Error other_nodes{Errc::kImportFailed,
                          fmt::format("{}: assimp has read other nodes than the file has", what)};
  const Json& nodes = array_at(document, "nodes");
  const Json& scenes = array_at(document, "scenes");
  const Json& roots = array_at(element_at(scenes, number_at(document, "scene", 0)), "nodes");
  std::vector<std::optional<std::uint32_t>> found(scene.mNumMeshes);
  std::vector<std::pair<const Json*, const aiNode*>> stack;
  const auto push = [&](const Json& listed, const aiNode& parent) {
    if (listed.size() != parent.mNumChildren) return false;
    for (std::size_t i = 0; i < listed.size(); ++i) {
      if (!listed[i].is_number_unsigned()) return false;
      stack.emplace_back(&element_at(nodes, listed[i].get<std::uint64_t>()), parent.mChildren[i]);
    }
    return true;
  };
  // Of several roots assimp makes one.
  if (roots.size() == 1 && roots[0].is_number_unsigned()) {
    stack.emplace_back(&element_at(nodes, roots[0].get<std::uint64_t>()), scene.mRootNode);
  } else if (!push(roots, *scene.mRootNode)) {
    return other_nodes;
  }
  while (!stack.empty()) {
    const auto [node, read] = stack.back();
    stack.pop_back();
    const std::uint64_t mesh = number_at(*node, "mesh", numbers.size());
    const std::size_t primitives = mesh < numbers.size() ? numbers[mesh].size() : 0;
    if (read->mNumMeshes != primitives) return other_nodes;
    for (std::size_t p = 0; p < primitives; ++p) {
      if (read->mMeshes[p] >= found.size()) return other_nodes;
      found[read->mMeshes[p]] = numbers[mesh][p];
    }
    if (!push(array_at(*node, "children"), *read)) return other_nodes;
  }
  std::vector<std::uint32_t> of_meshes;
  for (unsigned m = 0; m < scene.mNumMeshes; ++m) {
    const aiMesh& mesh = *scene.mMeshes[m];
    if (!found[m] && mesh.mNumFaces > 0) {
      return Error{Errc::kMeshUnsupported,
                   fmt::format("{}: no node of the scene has mesh '{}', so that it is not known "
                               "which one it is",
                               what, mesh.mName.C_Str())};
    }
    of_meshes.push_back(found[m].value_or(0));
  }
  return of_meshes;
}

}  // namespace boxtree::cooker
