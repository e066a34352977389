// SPDX-License-Identifier: MIT
// Reads text STL files. Assimp is not used: it reads 20 digits before a point, or many zeros after
// it, as 0, and skips facets without their first line.
#pragma once

#include <string>
#include <string_view>

#include "cooker/import/stl_mesh.h"

namespace boxtree::cooker {

/// Whether a file that begins with `start` is text.
[[nodiscard]] bool is_text_stl(std::string_view start);

/// Reads `text`, the whole file `file`, into `mesh`. Every facet has three corners of three numbers
/// and is closed, and so are the solids; there is nothing else between them. Errors: as for
/// import_mesh, with the line.
template <class T>
Status read_text_stl(std::string_view text, const std::string& file, StlMesh<T>& mesh);

}  // namespace boxtree::cooker
