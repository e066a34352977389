// SPDX-License-Identifier: MIT
// "-" in place of a file: standard input and standard output. A file of that name is "./-".
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include <boxtree/error.h>

#include "cooker/import/source_file.h"
#include "cooker/write/output_target.h"
#include "format/bytes.h"

namespace boxtree::cooker {

/// Standard input is held in memory; more than this is refused.
inline constexpr std::uint64_t kMaxStandardInput = std::uint64_t{1} << 34;

[[nodiscard]] inline bool is_standard_stream(const std::filesystem::path& path) {
  return path == "-";
}

/// What messages call an input: its path, or "standard input".
[[nodiscard]] std::string input_name(const std::filesystem::path& path);

/// All of standard input. The first call reads it; the bytes stay until the program ends. Not for
/// several threads at once. Error: kFileUnreadable for a terminal, a read that fails, and more than
/// kMaxStandardInput.
Result<Bytes> standard_input();

/// A mesh from standard input. `format`: the ending of a mesh file's name, "obj". Errors: those of
/// standard_input.
Result<SourceBytes> standard_mesh(const std::string& format);

/// Where a command writes: the file that was named or, for "-", standard output. `format`: the
/// ending of the name that the writer expects. Error: kInvalidQuery if standard output is a
/// terminal. A reader of it that goes away ends the process by SIGPIPE, as it ends others.
Result<OutputTarget> output_target(const std::filesystem::path& requested,
                                   const std::string& format);

/// Prints text for people to standard output, or to standard error where that is the target.
void tell(const OutputTarget& target, const std::string& text);

}  // namespace boxtree::cooker
