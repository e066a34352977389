// SPDX-License-Identifier: MIT
// Whether texts that assimp reads are whole: of a file that was cut short it makes faces of its
// own.
#pragma once

#include <string_view>

#include <boxtree/format/result.h>

namespace boxtree::cooker {

/// A text PLY file: every element that the header states is there, a line each, with as many
/// numbers as its properties ask for. What follows the last one is not looked at. kImportFailed,
/// naming the line; no error for binary files.
Status check_ply_text(std::string_view file);

/// A text STL file: every facet has three corners of three numbers and is closed, and so is the
/// solid. kImportFailed, naming the line; no error for a file that does not begin with "solid".
Status check_stl_text(std::string_view file);

/// Whether the last line of a text has no end: a file that was cut there looks the same.
[[nodiscard]] bool has_open_end(std::string_view text);

}  // namespace boxtree::cooker
