// SPDX-License-Identifier: MIT
// Types of positions and vertex numbers in glTF 2 files: assimp's reader takes positions of any
// type for f32 and vertex numbers of any type for unsigned.
#pragma once

#include <boxtree/error.h>

#include "cooker/text/json.h"

struct aiScene;

namespace boxtree::cooker {

/// kImportFailed with the mesh and the primitive for positions that are neither f32 nor integers of
/// KHR_mesh_quantization, for vertex numbers that are not unsigned integers, and for sparse
/// positions among other data, of which assimp takes the wrong bytes. The document may hold
/// anything. O(its size).
Status check_types(const Json& document);

/// Whether positions of a primitive are integers.
[[nodiscard]] bool has_quantized_positions(const Json& document);

/// Replaces integers that assimp has stored as f32 by the positions that they stand for
/// (KHR_mesh_quantization): exact, or the nearest f32 if they are normalized. Errors: as for
/// numbers_of_meshes. Precondition: check_types passes; the scene is as assimp has read it.
Status read_quantized_positions(const Json& document, aiScene& scene);

}  // namespace boxtree::cooker
