// SPDX-License-Identifier: MIT
// The body of a binary PLY file. Assimp's reader needs 83 bytes of memory a face, drops the first
// byte of a body that starts with a line end, and takes up the end of a shortened file out of what
// it read a megabyte earlier.
#pragma once

#include <string>

#include "cooker/import/indexed_mesh.h"
#include "cooker/import/ply_layout.h"
#include "cooker/import/source_stream.h"

namespace boxtree::cooker {

/// Reads the file named from `stream`, of which nothing has been taken yet, into `mesh`; what
/// follows the last element is not looked at. Errors as for import_mesh.
template <class T>
Status read_binary_ply(SourceStream& stream, const PlyLayout& layout, const std::string& file,
                       IndexedMesh<T>& mesh);

}  // namespace boxtree::cooker
