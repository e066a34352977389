// SPDX-License-Identifier: MIT
// What toml++ must not be given: it expands keys by recursion, a frame for each part, asserts
// on a table's name that does not end on its line, and looks up characters beyond ASCII outside of
// quotes, which TOML 1.0 does not allow, in tables that it runs past.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace boxtree::cooker {

/// Parts of a key, "a.b.c" having three.
inline constexpr std::uint32_t kMaxKeyParts = 64;

struct TomlFault {
  std::uint32_t line;  // from 1
  std::string what;
};

/// The first such place of a text, if any. O(bytes). Other faults are left to the parser.
[[nodiscard]] std::optional<TomlFault> find_unreadable_toml(std::string_view text);

}  // namespace boxtree::cooker
