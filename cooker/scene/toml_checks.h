// SPDX-License-Identifier: MIT
// Finds TOML texts that toml++ cannot parse safely. It expands keys by recursion, a frame per part;
// it asserts on a table's name that does not end on its line; and it looks up characters beyond
// ASCII outside of quotes, which TOML 1.0 does not allow, in tables that it overruns.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace boxtree::cooker {

/// Largest number of parts of a key; "a.b.c" has three.
inline constexpr std::uint32_t kMaxKeyParts = 64;

struct TomlFault {
  std::uint32_t line;  // from 1
  std::string what;
};

/// The first such place in a text, if any. O(bytes). Other faults are left to the parser.
[[nodiscard]] std::optional<TomlFault> find_unreadable_toml(std::string_view text);

}  // namespace boxtree::cooker
