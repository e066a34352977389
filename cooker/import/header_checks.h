// SPDX-License-Identifier: MIT
// What some readers of assimp lose or believe without a word, found by a look at the file's header.
#pragma once

#include <filesystem>

#include <boxtree/format/result.h>

struct aiScene;

namespace boxtree::cooker {

/// Refuses a glTF file of which assimp has dropped faces: it does so when a vertex number is out of
/// range. Compares the counts that the file states with those of `scene`. Other files pass.
Status check_gltf_faces(const std::filesystem::path& path, const aiScene& scene);

}  // namespace boxtree::cooker
