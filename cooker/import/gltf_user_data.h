// SPDX-License-Identifier: MIT
// Finds the user data of the faces of a glTF 2 file. Assimp keeps the extras of nodes alone, so
// that the numbers of primitives are read from the document and assigned to assimp's meshes by
// where the nodes place them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include <boxtree/error.h>

struct aiScene;

namespace boxtree::cooker {

/// A number for each primitive of each mesh of a document.
using PrimitiveNumbers = std::vector<std::vector<std::uint32_t>>;

/// The numbers that ImportOptions::user_data specifies as `wanted`. Errors, without the name of the
/// file: kMeshUnsupported for glTF 1, and if the document has no number of that name;
/// kImportFailed for a value that is no integer of 32 bits. O(size of the document).
Result<PrimitiveNumbers> numbers_of_primitives(const nlohmann::json& document,
                                               const std::string& wanted);

/// The names of all primitives, in the order of kPrimitives: that of their mesh, with their number
/// in it if it has several.
[[nodiscard]] std::vector<std::string> names_of_primitives(const nlohmann::json& document);

/// The numbers of aiScene::mMeshes. kMeshUnsupported for a mesh with faces that no node of the
/// scene places, kImportFailed if assimp's nodes are not those of the document. Precondition:
/// `numbers` is of `document`.
Result<std::vector<std::uint32_t>> numbers_of_meshes(const nlohmann::json& document,
                                                     const PrimitiveNumbers& numbers,
                                                     const aiScene& scene);

}  // namespace boxtree::cooker
