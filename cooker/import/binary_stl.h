// SPDX-License-Identifier: MIT
// Binary STL files, read by ourselves: assimp's reader needs 171 bytes of memory a face, most of
// them for normals and for vertices that are merged at once.
#pragma once

#include <string>

#include "cooker/import/source_stream.h"
#include "cooker/import/stl_mesh.h"

namespace boxtree::cooker {

/// Whether the file is as long as the count in its header says. `stream` is at its start.
[[nodiscard]] bool is_binary_stl(const SourceStream& stream);

/// Reads the file named from `stream`, of which nothing has been taken yet, into `mesh`. Errors as
/// for import_mesh.
template <class T>
Status read_binary_stl(SourceStream& stream, const std::string& file, StlMesh<T>& mesh);

}  // namespace boxtree::cooker
