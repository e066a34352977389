// SPDX-License-Identifier: MIT
// Finds the user data of the faces of a glTF 2 file. Assimp keeps the extras of nodes alone, so
// that the numbers of primitives are read from the document and assigned to assimp's meshes by
// where the nodes place them.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <boxtree/error.h>

#include "cooker/import/gltf_primitives.h"
#include "cooker/text/json.h"

namespace boxtree::cooker {

/// The numbers that ImportOptions::user_data specifies as `wanted`. Errors, without the name of the
/// file: kMeshUnsupported for glTF 1, and if the document has no number of that name;
/// kImportFailed for a value that is no integer of 32 bits. O(size of the document).
Result<PrimitiveNumbers> numbers_of_primitives(const Json& document, const std::string& wanted);

/// The names of all primitives, in the order of kPrimitives: that of their mesh, with their number
/// in it if it has several.
[[nodiscard]] std::vector<std::string> names_of_primitives(const Json& document);

}  // namespace boxtree::cooker
