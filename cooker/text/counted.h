// SPDX-License-Identifier: MIT
// Numbers of things in messages.
#pragma once

#include <cstdint>
#include <string>

namespace boxtree::cooker {

/// "1 tree", "2 trees": of what takes an s. `word`: one of them.
[[nodiscard]] inline std::string counted(std::uint64_t count, const std::string& word) {
  return std::to_string(count) + " " + word + (count == 1 ? "" : "s");
}

}  // namespace boxtree::cooker
