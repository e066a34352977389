// SPDX-License-Identifier: MIT
#include "cooker/system/memory_limit.h"

#include <algorithm>
#include <fstream>
#include <string>
#include <system_error>

#include "cooker/text/number_of.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// "max", and whatever else is no number, limits nothing.
std::optional<std::uint64_t> limit_in(const fs::path& file) {
  std::string word;
  std::ifstream(file) >> word;
  return number_of<std::uint64_t>(word);
}

void keep_least(std::optional<std::uint64_t> limit, std::optional<std::uint64_t>& least) {
  if (limit) least = std::min(least.value_or(*limit), *limit);
}

// Of a group and of all above it, up to `root`.
std::optional<std::uint64_t> least_limit(const fs::path& root, std::string_view group,
                                         const char* file) {
  fs::path folder = root / fs::path(group).relative_path();
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) folder = root;
  std::optional<std::uint64_t> least;
  while (true) {  // `root` is the beginning of its name
    keep_least(limit_in(folder / file), least);
    if (folder == root) return least;
    folder = folder.parent_path();
  }
}

}  // namespace

std::optional<std::uint64_t> memory_limit(std::string_view groups, const fs::path& root) {
  std::optional<std::uint64_t> least;
  while (!groups.empty()) {
    const std::size_t end = std::min(groups.find('\n'), groups.size());
    const std::string_view line = groups.substr(0, end);
    groups.remove_prefix(std::min(end + 1, groups.size()));
    const std::size_t first = line.find(':');
    const std::size_t second = line.find(':', std::min(first, line.size() - 1) + 1);
    if (first == std::string_view::npos || second == std::string_view::npos) continue;
    const std::string_view controllers = line.substr(first + 1, second - first - 1);
    const std::string_view group = line.substr(second + 1);
    if (controllers.empty()) keep_least(least_limit(root, group, "memory.max"), least);
    if (controllers == "memory") {
      keep_least(least_limit(root / "memory", group, "memory.limit_in_bytes"), least);
    }
  }
  return least;
}

}  // namespace boxtree::cooker
