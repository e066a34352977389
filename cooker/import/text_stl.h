// SPDX-License-Identifier: MIT
// STL files of text: assimp takes 20 digits before a point, or many zeros behind it, for 0, and
// passes over facets that lack their first line.
#pragma once

#include <filesystem>

#include <boxtree/cooker/import/import.h>

namespace boxtree::cooker {

/// Reads `path` into `out` if it is a text that begins with "solid", in any case; false if not, and
/// nothing has changed. Every facet has three corners of three numbers and is closed, and so is the
/// last solid. Errors as for import_mesh.
Result<bool> import_text_stl(const std::filesystem::path& path, const ImportOptions& options,
                             Imported& out);

}  // namespace boxtree::cooker
