// SPDX-License-Identifier: MIT
// Binary PLY files, read by ourselves. Assimp's reader needs 83 bytes of memory a face, drops the
// first byte of a body that starts with a line end, and takes up the end of a shortened file out of
// what it read a megabyte earlier.
#pragma once

#include <filesystem>

#include <boxtree/cooker/import/import.h>

namespace boxtree::cooker {

/// Reads `path`, a PLY file, into `out`, all but the name, as import_mesh promises. Positions have
/// all the digits of the file. False, with `out` untouched, for a file that is left to assimp:
/// text, triangle strips, vertices with lists or without x, y and z, faces before vertices or
/// without vertex_indices, a header with more in it than the format knows.
Result<bool> import_binary_ply(const std::filesystem::path& path, const ImportOptions& options,
                               Imported& out);

}  // namespace boxtree::cooker
