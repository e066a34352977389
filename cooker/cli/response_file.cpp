// SPDX-License-Identifier: MIT
#include "cooker/cli/response_file.h"

#include <string_view>

#include "cooker/import/text_tokens.h"
#include "cooker/import/whole_file.h"
#include "cooker/system/path.h"
#include "cooker/text/utf8.h"

namespace boxtree::cooker {

Result<ExpandedWords> with_response_files(const std::vector<std::string>& words) {
  ExpandedWords all;
  for (const std::string& word : words) {
    if (word.size() < 2 || word[0] != '@') {
      all.words.push_back(word);
      continue;
    }
    const Result<std::string> text = read_whole_file(named_path(word.substr(1)), kMaxFaceListBytes);
    if (!text) {
      return Error{text.code(),
                   word + ": a word with @ names a list of arguments: " + text.error().detail};
    }
    std::string_view rest = *text;
    if (rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());
    const std::size_t before = all.words.size();
    while (!rest.empty()) {
      const std::string_view line = take_line(rest);
      if (!line.empty()) all.words.emplace_back(line);
    }
    if (all.words.size() == before) all.empty_lists.push_back(word);
  }
  return all;
}

}  // namespace boxtree::cooker
