// SPDX-License-Identifier: MIT
// Active edges by comparing every face with all others, in extended precision.
#pragma once

#include <cstdint>
#include <vector>

#include "cooker/encode/encoded_scene.h"
#include "cooker/import/source_mesh.h"

namespace boxtree::test {

/// Of each face, bit i: the edge from corner i to the next one; see find_active_edges(). Quadratic.
[[nodiscard]] std::vector<std::uint8_t> active_edges_by_brute_force(const cooker::SourceMesh& mesh,
                                                                    long double degrees);

/// The same of each placed tree of a scene, in the order of its source faces. An edge that a face
/// has alone in its tree may be that of a face of another tree there, if neither moves.
[[nodiscard]] std::vector<std::vector<std::uint8_t>> active_edges_by_brute_force(
    const std::vector<cooker::SourceMesh>& meshes, const std::vector<cooker::PlacedTree>& instances,
    long double degrees);

}  // namespace boxtree::test
