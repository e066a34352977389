// SPDX-License-Identifier: MIT
// Parses TOML into plain values with their lines. Only this interface uses toml++; its types and
// exceptions go no farther.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <boxtree/error.h>

namespace boxtree::cooker {

struct TomlNode;
struct TomlEntry;
using TomlArray = std::vector<TomlNode>;
using TomlTable = std::vector<TomlEntry>;  // by line
struct TomlDate {};

struct TomlNode {
  std::variant<TomlDate, bool, std::int64_t, double, std::string, TomlArray, TomlTable> value;
  std::uint32_t line = 0;  // where the value begins, from 1
};

struct TomlEntry {
  std::string key;
  std::uint32_t line = 0;  // of the key
  TomlNode node;
};

/// Error: kProfileInvalid, "PATH:LINE: what is wrong"; `path` is the path of the text.
Result<TomlTable> parse_toml(std::string_view text, std::string_view path);

/// A value as messages show it: "-1", "\"abc\"", "a table", "an array of 3".
[[nodiscard]] std::string shown(const TomlNode& node);

}  // namespace boxtree::cooker
