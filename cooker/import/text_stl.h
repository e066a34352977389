// SPDX-License-Identifier: MIT
// STL files of text: assimp takes 20 digits before a point, or many zeros behind it, for 0, and
// passes over facets that lack their first line.
#pragma once

#include <string>
#include <string_view>

#include "cooker/import/stl_mesh.h"

namespace boxtree::cooker {

/// Whether a file that begins with `start` is to be read as a text.
[[nodiscard]] bool is_text_stl(std::string_view start);

/// Reads `text`, all of the file named, into `mesh`. Every facet has three corners of three numbers
/// and is closed, and so are the solids; between them is nothing else. Errors as for import_mesh,
/// naming the line.
template <class T>
Status read_text_stl(std::string_view text, const std::string& file, StlMesh<T>& mesh);

}  // namespace boxtree::cooker
