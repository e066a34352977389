// SPDX-License-Identifier: MIT
// Refuses glTF files that need what assimp's reader does not know: it reads past extensionsRequired
// and takes what is left for the mesh.
#pragma once

#include <cstddef>

#include <boxtree/error.h>

#include "cooker/text/json.h"

namespace boxtree::cooker {

/// kImportFailed with the name and a remedy if the document requires an extension other than those
/// that are read and those that cannot change geometry. The document may hold anything.
Status check_required_extensions(const Json& document);

/// Has the positions and indices of a primitive.
inline constexpr const char* kDraco = "KHR_draco_mesh_compression";

/// Places the mesh of a node several times; it is read as placed once.
inline constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
inline constexpr const char* kInstancingRemedy =
    "write a node for each instance (gltfpack: without -mi)";

}  // namespace boxtree::cooker
