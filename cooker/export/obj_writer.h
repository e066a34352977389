// SPDX-License-Identifier: MIT
// Wavefront OBJ: an object a tree, or an instance of a scene; a group for its triangles and one for
// each level of its boxes.
#pragma once

#include <string>

#include "cooker/export/shown_tree.h"

namespace boxtree::cooker {

class ByteSink;

/// Decimal digits that give the same f32 back, and neither more than 15 decimals nor an exponent
/// where that can be helped: readers of OBJ, assimp's among them, are exact for these alone.
[[nodiscard]] std::string f32_digits(float value);

/// Quads stay quads. Boxes are lines, or six quads each if `solid_boxes`. Numbers read back as they
/// were: those of trees with f32 positions as f32 and, with boxes rounded outward to f32, all
/// others as f64. Instances are placed and told in f64, boxes by their corners; a pose that mirrors
/// turns faces round, from the same first corner.
void write_obj(const Shown& shown, bool solid_boxes, ByteSink& out);

}  // namespace boxtree::cooker
