// SPDX-License-Identifier: MIT
// Whether texts that assimp reads are whole: of a file that was cut short it makes faces of its
// own.
#pragma once

#include <cstddef>
#include <functional>
#include <string_view>

#include <boxtree/cooker/import/ply_header.h>
#include <boxtree/cooker/import/text_tokens.h>
#include <boxtree/format/result.h>

namespace boxtree::cooker {

/// Calls visit(element, words, line) with each row of a text PLY file that has the header, in their
/// order, until it returns an error: as many words as the properties of the element ask for, all of
/// them numbers. kImportFailed, naming the line, when a row is not so or not there.
using PlyRowVisitor =
    std::function<Status(const PlyElement& element, const Tokens& words, std::size_t line)>;
Status read_ply_rows(const PlyHeader& header, std::string_view file, const PlyRowVisitor& visit);

/// A text PLY file: every element that the header states is there, a line each, with as many
/// numbers as its properties ask for. What follows the last one is not looked at. kImportFailed,
/// naming the line; no error for binary files.
Status check_ply_text(std::string_view file);

/// Whether the last line of a text has no end: a file that was cut there looks the same.
[[nodiscard]] bool has_open_end(std::string_view text);

}  // namespace boxtree::cooker
