// SPDX-License-Identifier: MIT
// Splits an OBJ file (Wavefront, "Object Files (.obj)") into statements.
#pragma once

#include <string>
#include <string_view>

namespace boxtree::cooker {

/// One statement, including the lines joined to it by backslashes.
struct ObjStatement {
  std::string_view text;  // from its keyword on, without comment and line end; may span lines
  std::size_t line;       // of its first line, from 1

  [[nodiscard]] bool is_vertex() const;
  /// A statement of vertex numbers: f, fo (f in files of version 2), l or p.
  [[nodiscard]] bool is_element() const;
};

/// The statements of a file: its text without bytes that editors and systems add around it.
[[nodiscard]] std::string_view statements_of(std::string_view text);

class ObjStatements {
 public:
  /// `text` must outlive this object and its statements.
  explicit ObjStatements(std::string_view text) : rest_(text) {}

  /// Sets `statement` to the next one; empty lines and comments are empty statements. False at the
  /// end.
  bool next(ObjStatement& statement);

 private:
  std::string_view rest_;
  std::size_t line_ = 1;
};

/// The statement as one line; uses `buffer` if it has several. Joining backslashes and line ends
/// become blanks.
[[nodiscard]] std::string_view joined_text(const ObjStatement& statement, std::string& buffer);

}  // namespace boxtree::cooker
