// SPDX-License-Identifier: MIT
// Meshes whose faces lie on each other or in one plane: what bounds cannot tell apart.
#pragma once

#include <vector>

#include "cooker/import/source_mesh.h"

namespace boxtree::test {

/// One triangle, `faces` times; the plane is z = x, so that no box is flat.
[[nodiscard]] cooker::SourceMesh identical_faces(unsigned faces);
/// The same triangle in the six orders of its corners, by turns.
[[nodiscard]] cooker::SourceMesh corner_orders(unsigned faces);
/// Different triangles in the plane z = x, each of which overlaps many others.
[[nodiscard]] cooker::SourceMesh overlapping_faces(unsigned faces, unsigned seed);
/// Two parallel squares, z = x and z = x + 1/4, tiled with right triangles.
[[nodiscard]] cooker::SourceMesh parallel_plates(unsigned faces);

/// Faces of both, by turns while both have some.
[[nodiscard]] cooker::SourceMesh mixed(const cooker::SourceMesh& first,
                                       const cooker::SourceMesh& second);

/// One of each kind above, and each mixed into a sphere, of about so many faces.
[[nodiscard]] std::vector<cooker::SourceMesh> coincident_kinds(unsigned faces);

}  // namespace boxtree::test
