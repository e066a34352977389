// SPDX-License-Identifier: MIT
// Reads binary STL files. Assimp's reader is not used: it needs 171 bytes of memory per face,
// mostly for normals and for vertices that are merged at once.
#pragma once

#include <cstddef>
#include <string>

#include "cooker/import/source_stream.h"
#include "cooker/import/stl_mesh.h"

namespace boxtree::cooker {

/// What is before the triangles: text of any content, and their count.
inline constexpr std::size_t kStlHeaderBytes = 84;

/// A triangle: its normal, three corners of 12 bytes each, and 16 bits that mean nothing here.
inline constexpr std::size_t kStlTriangleBytes = 50;
inline constexpr std::size_t kStlCornersOffset = 12;

/// Whether the file has the length that the count in its header requires. `stream` is at its start.
[[nodiscard]] bool is_binary_stl(const SourceStream& stream);

/// Reads the triangles from `stream`, from which nothing has been taken yet, into `mesh`. Errors:
/// as for import_mesh.
template <class T>
Status read_binary_stl(SourceStream& stream, const std::string& file, StlMesh<T>& mesh);

}  // namespace boxtree::cooker
