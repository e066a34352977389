// SPDX-License-Identifier: MIT
// Detects faces that assimp's glTF reader drops without an error: those with a vertex number out of
// range.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <boxtree/error.h>

#include "cooker/import/gltf_primitives.h"
#include "cooker/text/json.h"

struct aiScene;

namespace boxtree::cooker {

/// What a document states of its primitives.
struct StatedFaces {
  /// Numbers of vertices and faces, of each primitive of each mesh in turn.
  std::vector<std::pair<std::uint64_t, std::uint64_t>> counts;
  PrimitiveNumbers numbers;  ///< each primitive's place in `counts`
  Json nodes;                ///< a document with what numbers_of_meshes() looks at
};

/// Of a glTF document, which may hold anything. No counts for glTF 1, whose reader keeps bad
/// numbers for later checks, and for other formats. O(its size).
[[nodiscard]] StatedFaces stated_faces(const Json& document);

/// kMeshIndexOutOfRange with the mesh if a scene has other numbers of faces than `stated`, or more
/// vertices; fewer are those that faces name.
Status check_stated_faces(const StatedFaces& stated, const aiScene& scene);

}  // namespace boxtree::cooker
