// SPDX-License-Identifier: MIT
// Finds what is wrong in an OBJ file that assimp refuses as a whole without saying where.
#pragma once

#include <string>
#include <string_view>

#include <boxtree/cooker/import/flatten.h>
#include <boxtree/format/result.h>

namespace boxtree::cooker {

/// Whether `text`, an OBJ file, has vertices in a form that assimp leaves out without a word,
/// moving all later vertex numbers: with five numbers, or seven and more, or a comment behind.
/// Those with less than three numbers, or with something else than numbers, are an error that names
/// the line.
Result<bool> has_unknown_vertex_forms(std::string_view text);

/// Changes `text`, an OBJ file, so that assimp reads all of it: a vertex that is not finite and a
/// vertex number that is out of range are replaced by fault markers (flatten.h), each known by its
/// line and its number in the file. Vertices in unknown forms are reduced to their
/// position. Texture and normal numbers that are no numbers go without a word: they are no
/// geometry. Numbers of vertices and faces stay as they are. `changed` says whether anything was
/// replaced. With `exact`, every position is put aside there, whatever f32 makes of it, and `text`
/// holds its number.
KnownFaults mark_obj_faults(std::string& text, bool& changed, ExactPositions* exact = nullptr);

}  // namespace boxtree::cooker
