// SPDX-License-Identifier: MIT
// PLY files of text: assimp takes comments for ends of elements, rows of elements that it does not
// know for vertices, and rounds decimals more than once, to f32.
#pragma once

#include <filesystem>

#include <boxtree/cooker/import/import.h>

namespace boxtree::cooker {

/// Reads `path` into `out` if it is a PLY file of text with the mesh that find_ply_parts() knows;
/// false if it is another file, and nothing has changed. Errors as for import_mesh.
Result<bool> import_text_ply(const std::filesystem::path& path, const ImportOptions& options,
                             Imported& out);

}  // namespace boxtree::cooker
