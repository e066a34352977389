// SPDX-License-Identifier: MIT
// Binary STL files, read by ourselves: assimp's reader needs 171 bytes of memory a face, most of
// them for normals and for vertices that are merged at once.
#pragma once

#include <filesystem>

#include <boxtree/cooker/import/import.h>

namespace boxtree::cooker {

/// Reads `path`, an STL file, into `out`, all but the name, as import_mesh promises. False, with
/// `out` untouched, for a file that is left to assimp: text, or no triangles at all. kImportFailed
/// for a file that is no text and not as long as its number of triangles asks for.
Result<bool> import_binary_stl(const std::filesystem::path& path, const ImportOptions& options,
                               Imported& out);

}  // namespace boxtree::cooker
