// SPDX-License-Identifier: MIT
// OFF files of text (http://www.geomview.org/docs/html/OFF.html). Assimp moves vertex numbers that
// are out of range to the last vertex, drops faces of more than nine corners, and believes any
// count in the header.
#pragma once

#include <filesystem>

#include "cooker/import/import.h"

namespace boxtree::cooker {

/// Reads `path`, an OFF file with or without normals, colours, texture and homogeneous coordinates,
/// into `out`, all but the name, as import_mesh promises.
Status import_off(const std::filesystem::path& path, const ImportOptions& options, Imported& out);

}  // namespace boxtree::cooker
