// SPDX-License-Identifier: MIT
// OFF files, told to assimp as OBJ: its own OFF reader moves vertex numbers that are out of range
// to the last vertex, drops faces of more than nine corners, and believes any count in the header.
#pragma once

#include <string>
#include <string_view>

#include <boxtree/cooker/import/flatten.h>
#include <boxtree/format/result.h>

namespace boxtree::cooker {

/// The vertices and faces of `off`, an ASCII OFF file (with or without normals, colours, texture
/// and homogeneous coordinates), as an OBJ file in the same order. Corners that name no vertex and
/// vertices that are not finite become fault markers, described in `known`.
/// kImportFailed, naming the line, if it is not such a file or ends early.
/// Positions are put aside in `exact`.
Result<std::string> obj_from_off(std::string_view off, KnownFaults& known, ExactPositions& exact);

}  // namespace boxtree::cooker
