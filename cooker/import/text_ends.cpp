// SPDX-License-Identifier: MIT
#include "cooker/import/text_ends.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <string>

#include "cooker/import/text_tokens.h"

namespace boxtree::cooker {
namespace {

Error cut(const char* why) {
  return {Errc::kImportFailed, std::string(why) + ": it was cut short"};
}

}  // namespace

// OBJECT begins an object; its last line, "kids N", states that N child objects follow.
Status check_ac_end(std::string_view file) {
  std::uint64_t awaited = 0;  // children still to come
  bool is_open = false;       // inside an object, before its last line
  Tokens words;
  while (!file.empty()) {
    split_tokens(take_line(file), words);
    if (words.empty()) continue;
    if (words[0] == "OBJECT") {
      if (is_open) return cut("an object follows one without its 'kids'");
      is_open = true;
      awaited -= awaited > 0 ? 1u : 0u;
    } else if (words.size() > 1 && words[0] == "kids") {
      is_open = false;
      const std::uint64_t room = std::numeric_limits<std::uint64_t>::max() - awaited;
      awaited += std::min(read_count(words[1]).value_or(0), room);
    } else if (words.size() > 1 && words[0] == "data") {
      // The next line or lines contain this many bytes of any kind.
      const std::uint64_t bytes = read_count(words[1]).value_or(0);
      file.remove_prefix(std::min<std::uint64_t>(bytes, file.size()));
    }
  }
  if (is_open) return cut("the last object has no 'kids'");
  return awaited > 0 ? Status(cut("objects say that more of them follow")) : Status();
}

Status check_blocks_end(std::string_view file) {
  std::uint64_t open = 0;
  bool in_quotes = false;
  for (const char c : file) {
    if (c == '"' || (in_quotes && c == '\n')) {
      in_quotes = c == '"' && !in_quotes;
    } else if (!in_quotes && c == '{') {
      ++open;
    } else if (!in_quotes && c == '}' && open > 0) {
      --open;
    }
  }
  return open > 0 ? Status(cut("a block has no end")) : Status();
}

Status check_dxf_end(std::string_view file) {
  if (file.starts_with("AutoCAD Binary DXF")) return {};
  const std::size_t last = file.find_last_not_of(" \t\r\n\x1a");
  const bool has_end = last != std::string_view::npos && last >= 2 &&
                       file.substr(last - 2, 3) == "EOF" && (last == 2 || file[last - 3] <= ' ');
  return has_end ? Status() : Status(cut("the last entity is not EOF"));
}

Status check_smd_end(std::string_view file) {
  bool is_open = false;
  Tokens words;
  while (!file.empty()) {
    split_tokens(take_line(file), words);
    if (words.size() != 1) continue;
    if (words[0] == "end") {
      is_open = false;
    } else if (words[0] == "nodes" || words[0] == "skeleton" || words[0] == "triangles" ||
               words[0] == "vertexanimation") {
      is_open = true;
    }
  }
  return is_open ? Status(cut("a block has no end")) : Status();
}

}  // namespace boxtree::cooker
