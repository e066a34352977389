// SPDX-License-Identifier: MIT
// Faces that assimp's reader of glTF has dropped without a word: those with a vertex number out of
// range.
#pragma once

#include <cstdint>
#include <filesystem>
#include <set>
#include <utility>

#include <nlohmann/json_fwd.hpp>

#include <boxtree/error.h>

struct aiScene;

namespace boxtree::cooker {

/// Vertices and faces of each primitive that a file states. Empty where it states none: glTF 1,
/// whose reader leaves bad numbers to us, and what is no glTF.
using StatedFaces = std::set<std::pair<std::uint64_t, std::uint64_t>>;

/// What a document of glTF states, whatever it holds. O(its size).
[[nodiscard]] StatedFaces stated_faces(const nlohmann::json& document);

/// What a .gltf or .glb file states; nothing for others. Refuses what parse_gltf refuses.
Result<StatedFaces> read_stated_faces(const std::filesystem::path& path);

/// Refuses a scene that holds other counts than `stated`: kMeshIndexOutOfRange, naming the mesh.
Status check_stated_faces(const StatedFaces& stated, const aiScene& scene);

}  // namespace boxtree::cooker
