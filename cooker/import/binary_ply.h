// SPDX-License-Identifier: MIT
// Reads the body of a binary PLY file. Assimp's reader is not used: it needs 83 bytes of memory per
// face, drops the first byte of a body that starts with a line end, and completes a truncated file
// with data it read a megabyte earlier.
#pragma once

#include <string>

#include "cooker/import/indexed_mesh.h"
#include "cooker/import/ply_layout.h"
#include "cooker/import/source_stream.h"

namespace boxtree::cooker {

/// Reads the body from `stream`, from which nothing has been taken yet, into `mesh`. `file` is for
/// messages. Bytes after the last element are ignored. Errors: as for import_mesh.
template <class T>
Status read_binary_ply(SourceStream& stream, const PlyLayout& layout, const std::string& file,
                       IndexedMesh<T>& mesh);

}  // namespace boxtree::cooker
