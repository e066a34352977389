// SPDX-License-Identifier: MIT
// STL files: of numbers, or of text.
#pragma once

#include <filesystem>

#include "cooker/import/import.h"

namespace boxtree::cooker {

/// Reads `path`, an STL file, into `out`, all but the name, as import_mesh promises. Facets become
/// faces in the order of the file; their normals are not looked at.
Status import_stl(const std::filesystem::path& path, const ImportOptions& options, Imported& out);

}  // namespace boxtree::cooker
