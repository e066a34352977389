// SPDX-License-Identifier: MIT
// Which primitive of a glTF document each mesh of assimp's scene is.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include <boxtree/error.h>

#include "cooker/import/gltf_document.h"
#include "cooker/text/json.h"

struct aiScene;

namespace boxtree::cooker {

/// A number for each primitive of each mesh of a document.
using PrimitiveNumbers = std::vector<std::vector<std::uint32_t>>;

/// Calls visit(mesh, number of the mesh, primitive, its number in the mesh) for each primitive.
template <class Visit>
void visit_primitives(const Json& document, const Visit& visit) {
  const Json& meshes = array_at(document, "meshes");
  for (std::size_t m = 0; m < meshes.size(); ++m) {
    const Json& primitives = array_at(meshes[m], "primitives");
    for (std::size_t p = 0; p < primitives.size(); ++p) visit(meshes[m], m, primitives[p], p);
  }
}

/// The name of a mesh; "mesh 3" if it has none.
[[nodiscard]] std::string name_of_mesh(const Json& mesh, std::size_t number);

/// The numbers of aiScene::mMeshes, of what `what` says in errors: kMeshUnsupported for a mesh with
/// faces that no node of the scene places, kImportFailed if assimp's nodes are not those of the
/// document. Precondition: `numbers` is of `document`.
Result<std::vector<std::uint32_t>> numbers_of_meshes(const Json& document,
                                                     const PrimitiveNumbers& numbers,
                                                     const aiScene& scene, std::string_view what);

}  // namespace boxtree::cooker
