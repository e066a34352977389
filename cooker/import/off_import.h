// SPDX-License-Identifier: MIT
// Reads text OFF files (http://www.geomview.org/docs/html/OFF.html). Assimp is not used: it moves
// vertex numbers that are out of range to the last vertex, drops faces of more than nine corners,
// and trusts any count in the header.
#pragma once

#include <filesystem>

#include "cooker/import/import.h"

namespace boxtree::cooker {

/// Reads the OFF file `path`, with or without normals, colours, texture and homogeneous
/// coordinates, into `out`, except the name, as specified for import_mesh.
Status import_off(const SourceFile& source, const ImportOptions& options, Imported& out);

}  // namespace boxtree::cooker
