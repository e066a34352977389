// SPDX-License-Identifier: MIT
// What positions lose as f32: the farther a mesh is from the origin for its size, as in metres of a
// map, the fewer bits are left for its shape.
#pragma once

#include "cooker/import/source_mesh.h"

namespace boxtree::cooker {

/// Whether f32 leaves less than 16 bits for the largest extent of a mesh that was read as f32, the
/// least that a mesh of a scene gets on a grid by default (kLeastMeshBits).
[[nodiscard]] bool has_few_digits(const Positions& positions);

/// The largest distance of a position from the nearest one with coordinates of f32.
[[nodiscard]] double moved_by_f32(const Positions& positions);

}  // namespace boxtree::cooker
