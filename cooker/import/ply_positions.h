// SPDX-License-Identifier: MIT
// Positions of PLY files of text: assimp rounds their decimals more than once, and to f32.
#pragma once

#include <string>

#include <boxtree/cooker/import/exact_positions.h>

namespace boxtree::cooker {

/// Puts the positions of `file`, a PLY file of text, aside and writes their numbers in their
/// places. Returns false and changes nothing when it does not understand the file well enough:
/// lists before the vertices, coordinates in fewer than 32 bits, an early end. Positions that are
/// not finite stay.
bool number_ply_vertices(std::string& file, ExactPositions& exact);

}  // namespace boxtree::cooker
