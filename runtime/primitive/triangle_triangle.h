// SPDX-License-Identifier: MIT
// Overlap of two triangles, decided by orientation signs alone.
#pragma once

#include "runtime/primitive/triangle.h"

namespace boxtree {

/// Whether two triangles share a point. Only the signs of orient3d and orient2d decide, so the
/// answer is exact for the coordinates given (after Guigue and Devillers, "Fast and Robust
/// Triangle-Triangle Overlap Test Using Orientation Predicates", 2003); coplanar and degenerate
/// triangles (segments, points) included. Symmetric in its arguments and independent of the order
/// of the corners.
[[nodiscard]] bool triangles_intersect(const Triangle& p, const Triangle& q) noexcept;

}  // namespace boxtree
