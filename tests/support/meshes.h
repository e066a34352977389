// SPDX-License-Identifier: MIT
// Generated meshes for tests. Seeded; the same on every machine.
#pragma once

#include <string>
#include <vector>

#include "cooker/import/source_mesh.h"

namespace boxtree::test {

using cooker::SourceMesh;

[[nodiscard]] SourceMesh sphere(unsigned rings, unsigned segments);
[[nodiscard]] SourceMesh torus(unsigned rings, unsigned segments);
[[nodiscard]] SourceMesh terrain(unsigned cells, unsigned seed);
/// Boxes of quads on a plane: axis-aligned, coplanar, touching.
[[nodiscard]] SourceMesh city(unsigned blocks, unsigned seed);
[[nodiscard]] SourceMesh soup(unsigned faces, unsigned seed);
[[nodiscard]] SourceMesh slivers(unsigned faces, unsigned seed);
/// `copies` of the same triangle.
[[nodiscard]] SourceMesh duplicates(unsigned copies);
/// One face of size 1000 and `tiny` faces of size 1e-3.
[[nodiscard]] SourceMesh huge_among_tiny(unsigned tiny, unsigned seed);

/// One of each kind above, small enough for brute force.
[[nodiscard]] std::vector<SourceMesh> all_kinds();

}  // namespace boxtree::test
