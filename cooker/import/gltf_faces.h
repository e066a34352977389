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

/// The document of a .gltf or .glb file; null for others. Errors: as parse_gltf.
Result<nlohmann::json> read_gltf(const SourceFile& source);

/// The value of a key that is an array; an empty one if there is none such.
[[nodiscard]] const nlohmann::json& array_at(const nlohmann::json& object, const char* key);

/// The value of a key that is a whole number of 0 or more; `otherwise` if there is none such.
[[nodiscard]] std::uint64_t number_at(const nlohmann::json& object, const char* key,
                                      std::uint64_t otherwise);

/// Numbers of vertices and faces stated for each primitive. Empty for glTF 1, whose reader keeps
/// bad numbers for later checks, and for other formats.
using StatedFaces = std::set<std::pair<std::uint64_t, std::uint64_t>>;

/// The counts in a glTF document, which may hold anything. O(its size).
[[nodiscard]] StatedFaces stated_faces(const nlohmann::json& document);

/// Why no reader takes a .gltf or .glb file: its bytes end too early, or its JSON is none. Empty if
/// that is not the reason, and for other formats.
[[nodiscard]] std::string gltf_fault(const SourceFile& source);

/// kMeshIndexOutOfRange with the mesh if a scene's counts differ from `stated`.
Status check_stated_faces(const StatedFaces& stated, const aiScene& scene);

}  // namespace boxtree::cooker
