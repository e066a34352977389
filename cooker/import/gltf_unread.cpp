// SPDX-License-Identifier: MIT
#include "cooker/import/gltf_unread.h"

#include <algorithm>
#include <cstddef>

#include "cooker/import/gltf_document.h"
#include "cooker/import/gltf_extensions.h"

namespace boxtree::cooker {
namespace {

bool is_instanced(const Json& node) {
  const Json* const extensions = node.find("extensions");
  return extensions != nullptr && extensions->contains(kInstancing);
}

bool is_skinned(const Json& node) {
  return node.contains("mesh") && node.contains("skin");
}

// Weights are those of a mesh or of a node; without any, or with zeros, meshes are as they are
// read.
bool has_weights(const Json& mesh_or_node) {
  const Json& weights = array_at(mesh_or_node, "weights");
  return std::any_of(weights.begin(), weights.end(), [](const Json& weight) {
    return weight.is_number() && weight.get<double>() != 0;
  });
}

template <class Test>
std::size_t count(const Json& document, const char* array, const Test& test) {
  const Json& elements = array_at(document, array);
  return static_cast<std::size_t>(std::count_if(elements.begin(), elements.end(), test));
}

}  // namespace

std::vector<Unread> unread_of_gltf(const Json& document) {
  std::vector<Unread> unread;
  const auto add = [&](const char* what, std::size_t count, const char* remedy) {
    if (count > 0) unread.push_back({what, count, 0, remedy});
  };
  add(kInstancing, count(document, "nodes", is_instanced), kInstancingRemedy);
  add("skins", count(document, "nodes", is_skinned), "export the mesh as its bones pose it");
  add("weights of morph targets",
      count(document, "meshes", has_weights) + count(document, "nodes", has_weights),
      "export the mesh as they shape it");
  const std::size_t scenes = array_at(document, "scenes").size();
  add("other scenes", scenes > 1 ? scenes - 1 : 0, "export each to a file of its own");
  return unread;
}

}  // namespace boxtree::cooker
