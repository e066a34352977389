// SPDX-License-Identifier: MIT
// OBJ files as assimp is to see them: it refuses one with a bad vertex number as a whole and says
// not where, leaves out vertices in forms it does not know, and rounds decimals more than once.
#pragma once

#include <string>
#include <string_view>

#include <boxtree/cooker/import/flatten.h>
#include <boxtree/format/result.h>

namespace boxtree::cooker {

/// `obj`, an OBJ file, with its vertices and faces in the same order and number, so that assimp
/// reads all of it. Positions are put aside in `exact`. A vertex that is not finite and a vertex
/// number that is out of range become fault markers, described in `known` by line and by number in
/// the file. What is behind a position (colours, comments) goes, and so do texture and normal
/// numbers that are no numbers: they are no geometry.
/// kImportFailed, naming the line, if a vertex has less than three numbers or anything else.
Result<std::string> obj_for_assimp(std::string_view obj, KnownFaults& known, ExactPositions& exact);

}  // namespace boxtree::cooker
