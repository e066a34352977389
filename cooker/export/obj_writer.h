// SPDX-License-Identifier: MIT
// Wavefront OBJ: an object a tree; a group for its triangles and one for each level of its boxes.
#pragma once

#include <span>
#include <string>

#include <boxtree/cooker/export/shown_tree.h>

namespace boxtree::cooker {

class ByteSink;

/// Decimal digits that give the same f32 back, and neither more than 15 decimals nor an exponent
/// where that can be helped: readers of OBJ, assimp's among them, are exact for these alone.
[[nodiscard]] std::string f32_digits(float value);

/// Quads stay quads. Boxes are lines, or six quads each if `solid_boxes`. Numbers read back as they
/// were: those of f32 positions as f32 and, with boxes rounded outward to f32, all others as f64.
void write_obj(std::span<const ShownTree> trees, bool solid_boxes, ByteSink& out);

}  // namespace boxtree::cooker
