// SPDX-License-Identifier: MIT
// Existing files are the same if device and inode are equal; new files, if their paths are. What a
// file is, its first bytes tell: those that cooks and exports write alone.
#include "cooker/write/outputs.h"

#include <array>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>

#include <fmt/format.h>

#include "cooker/write/atomic_file.h"
#include "format/container.h"

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

// The exporters write it within so many bytes.
constexpr std::size_t kStart = 256;

// The first bytes of a regular file; empty if it has none or cannot be read.
std::string start_of(const fs::path& path) {
  std::error_code error;
  if (!fs::is_regular_file(path, error)) return {};
  std::array<char, kStart> start;
  std::ifstream file(path, std::ios::binary);
  file.read(start.data(), start.size());
  return {start.data(), static_cast<std::size_t>(file.gcount())};
}

bool begins_as(OutputKind kind, std::string_view start) {
  switch (kind) {
    case OutputKind::kCooked:
      return start.starts_with(
          std::string_view(reinterpret_cast<const char*>(kMagic.data()), kMagic.size()));
    case OutputKind::kShownObj:
      return start.starts_with("# boxtree ");
    case OutputKind::kShownGlb:
      return start.find(R"("generator":"boxtree )") != std::string_view::npos;
  }
  return false;
}

const char* name_of(OutputKind kind) {
  return kind == OutputKind::kCooked ? "a cooked file" : "what an export has written";
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

Status check_replaced(const fs::path& output, OutputKind kind) {
  const std::string start = start_of(output);
  if (start.empty() || begins_as(kind, start)) return {};
  return Error{
      Errc::kWriteFailed,
      fmt::format("{}: expected {} in the place of the output, or none, found another file; "
                  "it would be lost: remove it, or name another output",
                  output.string(), name_of(kind))};
}

}  // namespace boxtree::cooker
