// SPDX-License-Identifier: MIT
// The statements of an OBJ file (Wavefront, "Object Files (.obj)"), one after the other.
#pragma once

#include <string>
#include <string_view>

namespace boxtree::cooker {

/// One statement, with the lines that a backslash joins to it.
struct ObjStatement {
  std::string_view text;  // from its keyword on, without comment and line end; may hold joined ones
  std::size_t line;       // of its beginning, from 1

  [[nodiscard]] bool is_vertex() const;
  /// A statement of vertex numbers: f, l or p.
  [[nodiscard]] bool is_element() const;
};

class ObjStatements {
 public:
  /// `text` must outlive this object and what comes out of it.
  explicit ObjStatements(std::string_view text) : rest_(text) {}

  /// Leaves the next one in `statement`; empty lines and comments are empty statements. False at
  /// the end.
  bool next(ObjStatement& statement);

 private:
  std::string_view rest_;
  std::size_t line_ = 1;
};

/// The statement as one line, in `buffer` if there are several: backslashes that join them and line
/// ends become blanks.
[[nodiscard]] std::string_view joined_text(const ObjStatement& statement, std::string& buffer);

}  // namespace boxtree::cooker
