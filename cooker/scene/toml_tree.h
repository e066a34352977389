// SPDX-License-Identifier: MIT
// A TOML text as plain values, each with its line: the only door to toml++, so that neither its
// types nor its exceptions get any farther.
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
  std::uint32_t line = 0;  // where it begins, from 1
};

struct TomlEntry {
  std::string key;
  std::uint32_t line = 0;  // of the key
  TomlNode node;
};

/// Error: kProfileInvalid, "PATH:LINE: what is wrong", `path` being that of the text.
Result<TomlTable> parse_toml(std::string_view text, std::string_view path);

/// How a value is shown in messages: "-1", "\"abc\"", "a table", "an array of 3".
[[nodiscard]] std::string shown(const TomlNode& node);

}  // namespace boxtree::cooker
