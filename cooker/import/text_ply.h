// SPDX-License-Identifier: MIT
// Reads the body of a text PLY file: each element is a line, each property a word, each list its
// length and as many words. Assimp is not used: it reads comments as ends of elements, rows of
// unknown elements as vertices, and rounds decimals more than once, to f32.
#pragma once

#include <string>
#include <string_view>

#include "cooker/import/indexed_mesh.h"
#include "cooker/import/ply_layout.h"

namespace boxtree::cooker {

/// Reads `text`, the whole file `file`, into `mesh`. Every element that the header states must have
/// a line with as many words as its properties need, all of them numbers. Text after the last
/// element is ignored. Errors: as for import_mesh, with the line.
template <class T>
Status read_text_ply(std::string_view text, const PlyLayout& layout, const std::string& file,
                     IndexedMesh<T>& mesh);

}  // namespace boxtree::cooker
