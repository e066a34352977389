// SPDX-License-Identifier: MIT
// PLY files: header, then a body of text or of numbers.
#pragma once

#include <filesystem>

#include "cooker/import/import.h"

namespace boxtree::cooker {

/// Reads `path`, a PLY file, into `out`, all but the name, as import_mesh promises. Positions have
/// all the digits of the file; polygons and triangle strips are taken, in the order of the file.
Status import_ply(const std::filesystem::path& path, const ImportOptions& options, Imported& out);

}  // namespace boxtree::cooker
