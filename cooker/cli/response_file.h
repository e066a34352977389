// SPDX-License-Identifier: MIT
// Command lines that are too long for the system: @FILE stands for the lines of a file.
#pragma once

#include <string>
#include <vector>

#include <boxtree/error.h>

namespace boxtree::cooker {

struct ExpandedWords {
  std::vector<std::string> words;
  std::vector<std::string> empty_lists;  // those of the form @FILE whose file has no line
};

/// The words, each of the form @FILE replaced by the lines of that file, one word a line; empty
/// lines are none, and a line that begins with @ is a word as it is. A word that begins with @ is
/// ./@... where it is the name of a file. Errors: kFileNotFound, kFileUnreadable.
Result<ExpandedWords> with_response_files(const std::vector<std::string>& words);

}  // namespace boxtree::cooker
