// SPDX-License-Identifier: MIT
// Existing files are the same if device and inode are equal; new files, if their paths are.
#include "cooker/write/outputs.h"

#include <string>
#include <system_error>

#include <fmt/format.h>

#include "cooker/write/atomic_file.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// The canonical path of a file, whether it exists or not; empty if the system reports an error.
fs::path real_name(const fs::path& path) {
  const Result<fs::path> followed = follow_links(path);
  if (!followed.ok()) return {};
  std::error_code error;
  const fs::path absolute = fs::absolute(*followed, error);
  if (error) return {};
  const fs::path real = fs::weakly_canonical(absolute, error);
  return error ? fs::path() : real;
}

bool is_same_file(const fs::path& a, const fs::path& b) {
  std::error_code error;
  const bool are_one = fs::equivalent(a, b, error);
  if (!error) return are_one;
  const fs::path name = real_name(a);
  return !name.empty() && name == real_name(b);
}

}  // namespace

Status check_outputs(std::span<const fs::path> outputs, std::span<const fs::path> inputs) {
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const fs::path& output = outputs[i];
    if (output.empty()) continue;
    const auto refuse = [&output](const fs::path& other, const char* what) {
      return Error{Errc::kWriteFailed,
                   fmt::format("{}: is the same file as {} {}; it would be written over: name "
                               "another output",
                               output.string(), what, other.string())};
    };
    for (const fs::path& input : inputs) {
      if (is_same_file(output, input)) return refuse(input, "the input");
    }
    for (const fs::path& other : outputs.subspan(i + 1)) {
      if (!other.empty() && is_same_file(output, other)) return refuse(other, "the output");
    }
  }
  return {};
}

}  // namespace boxtree::cooker
