// SPDX-License-Identifier: MIT
// The body of a PLY file of text: each element a line, each property a word, or for a list its
// length and so many words. Assimp takes comments for ends of elements, rows of elements that it
// does not know for vertices, and rounds decimals more than once, to f32.
#pragma once

#include <string>
#include <string_view>

#include "cooker/import/indexed_mesh.h"
#include "cooker/import/ply_layout.h"

namespace boxtree::cooker {

/// Reads `text`, all of the file named, into `mesh`. Every element that the header states has to be
/// there, a line each, with as many words as its properties need, all of them numbers; what
/// follows the last one is not looked at. Errors as for import_mesh, naming the line.
template <class T>
Status read_text_ply(std::string_view text, const PlyLayout& layout, const std::string& file,
                     IndexedMesh<T>& mesh);

}  // namespace boxtree::cooker
