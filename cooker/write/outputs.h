// SPDX-License-Identifier: MIT
// Checks that nothing is written over that is worth more than what is written.
#pragma once

#include <filesystem>
#include <span>

#include <boxtree/error.h>

namespace boxtree::cooker {

struct Output {
  std::filesystem::path path;  // empty if it was not given
  const char* option = "";     // that names it, for messages; of the output itself none
};

/// Checks that no output is an input or another output, under any name, hard link or symbolic link.
/// Reads no file; call it before anything is written. Error: kWriteFailed.
Status check_outputs(std::span<const Output> outputs,
                     std::span<const std::filesystem::path> inputs);

/// What a program writes: a new output of a kind takes the place of an old one, and of nothing
/// else.
enum class OutputKind {
  kCooked,
  kShownObj,
  kShownGlb,
  kReportPage,
  kReportCsv,
  kReportJson,
  kDepfile,
  kJournal,  // which is added to
};

/// Checks that an output is new, empty, no regular file (a pipe, say), or begins as its kind does,
/// of whatever version; a depfile is looked at as a whole. An empty path is an output that was not
/// given.
/// Error: kWriteFailed.
Status check_replaced(const std::filesystem::path& output, OutputKind kind);

}  // namespace boxtree::cooker
