// SPDX-License-Identifier: MIT
// What a glTF document has that places or shapes geometry and is not read.
#pragma once

#include <vector>

#include "cooker/import/import.h"
#include "cooker/text/json.h"

namespace boxtree::cooker {

/// Instances of a node (EXT_mesh_gpu_instancing), skins, morph targets that the file gives a
/// weight, and scenes besides the one that is read. The document may hold anything.
[[nodiscard]] std::vector<Unread> unread_of_gltf(const Json& document);

}  // namespace boxtree::cooker
