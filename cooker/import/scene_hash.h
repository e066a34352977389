// SPDX-License-Identifier: MIT
// Whether two readings of a file gave the same geometry.
#pragma once

#include <cstdint>

struct aiScene;

namespace boxtree::cooker {

/// A hash of what is taken of a scene: positions, faces, and the nodes that place them. Terminates
/// for graphs without cycles, which assimp makes.
[[nodiscard]] std::uint64_t geometry_hash(const aiScene& scene);

}  // namespace boxtree::cooker
