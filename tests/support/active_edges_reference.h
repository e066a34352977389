// SPDX-License-Identifier: MIT
// Active edges by comparing every face with all others, in extended precision.
#pragma once

#include <cstdint>
#include <vector>

#include "cooker/import/source_mesh.h"

namespace boxtree::test {

/// Of each face, bit i: the edge from corner i to the next one; see find_active_edges(). Quadratic.
[[nodiscard]] std::vector<std::uint8_t> active_edges_by_brute_force(const cooker::SourceMesh& mesh,
                                                                    long double degrees);

}  // namespace boxtree::test
