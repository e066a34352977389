// SPDX-License-Identifier: MIT
// Detects faces that assimp's glTF reader drops without an error: those with a vertex number out of
// range.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include <nlohmann/json_fwd.hpp>

#include <boxtree/error.h>

#include "cooker/import/source_file.h"

struct aiScene;

namespace boxtree::cooker {

/// Numbers of vertices and faces stated for each primitive. Empty for glTF 1, whose reader keeps
/// bad numbers for later checks, and for other formats.
using StatedFaces = std::set<std::pair<std::uint64_t, std::uint64_t>>;

/// The counts in a glTF document, which may hold anything. O(its size).
[[nodiscard]] StatedFaces stated_faces(const nlohmann::json& document);

/// The counts in a .gltf or .glb file; empty for others. Errors: as parse_gltf.
Result<StatedFaces> read_stated_faces(const SourceFile& source);

/// Why no reader takes a .gltf or .glb file: its bytes end too early, or its JSON is none. Empty if
/// that is not the reason, and for other formats.
[[nodiscard]] std::string gltf_fault(const SourceFile& source);

/// kMeshIndexOutOfRange with the mesh if a scene's counts differ from `stated`.
Status check_stated_faces(const StatedFaces& stated, const aiScene& scene);

}  // namespace boxtree::cooker
