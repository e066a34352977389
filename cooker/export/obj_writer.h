// SPDX-License-Identifier: MIT
// Writes Wavefront OBJ: an object per tree or instance, with a group for its triangles and one for
// each level of its boxes.
#pragma once

#include <string>

#include "cooker/export/shown_tree.h"

namespace boxtree::cooker {

class ByteSink;

/// Decimal digits that read back as the same f32, with at most 15 decimals and no exponent where
/// possible: readers of OBJ, including assimp's, are exact only for these.
[[nodiscard]] std::string f32_digits(float value);

/// Quads stay quads. Boxes are lines, or six quads each if `solid_boxes`. Numbers read back
/// unchanged: as f32 for trees with f32 positions, whose boxes are rounded outward to f32, and as
/// f64 for all others. Instances are placed and written in f64, boxes by their corners; if a pose
/// mirrors, faces are reversed, starting at the same first corner.
void write_obj(const Shown& shown, bool solid_boxes, ByteSink& out);

}  // namespace boxtree::cooker
