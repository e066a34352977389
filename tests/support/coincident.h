// SPDX-License-Identifier: MIT
// Meshes with coincident or coplanar faces, which bounds cannot separate.
#pragma once

#include <vector>

#include "cooker/import/source_mesh.h"

namespace boxtree::test {

/// One triangle, repeated `faces` times, in the plane z = x, so that no box is flat.
[[nodiscard]] cooker::SourceMesh identical_faces(unsigned faces);
/// The same triangle in the six orders of its corners, repeated in turn.
[[nodiscard]] cooker::SourceMesh corner_orders(unsigned faces);
/// Different triangles in the plane z = x, each of which overlaps many others.
[[nodiscard]] cooker::SourceMesh overlapping_faces(unsigned faces, unsigned seed);
/// Two parallel squares, z = x and z = x + 1/4, tiled with right triangles.
[[nodiscard]] cooker::SourceMesh parallel_plates(unsigned faces);

/// The faces of both meshes, alternating as long as both have some.
[[nodiscard]] cooker::SourceMesh mixed(const cooker::SourceMesh& first,
                                       const cooker::SourceMesh& second);

/// One mesh of each kind above, and each mixed into a sphere, with about `faces` faces.
[[nodiscard]] std::vector<cooker::SourceMesh> coincident_kinds(unsigned faces);

}  // namespace boxtree::test
