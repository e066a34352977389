// SPDX-License-Identifier: MIT
// Functions that the readers of text formats share.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include <boxtree/error.h>

#include "cooker/import/source_mesh.h"

namespace boxtree::cooker {

using Tokens = std::vector<std::string_view>;

/// The text of a file without zero bytes at its end. kImportFailed with the line if there are zero
/// bytes before.
Result<std::string_view> text_of(std::string_view file);

/// Whether the last line of a text has no end, as in a file truncated there.
[[nodiscard]] bool has_open_end(std::string_view text);

/// The words of `text`, between spaces, tabs and line ends.
void split_tokens(std::string_view text, Tokens& tokens);

/// Whether a text begins with the word of an STL file, in any case.
[[nodiscard]] bool begins_with_solid(std::string_view text);

/// `text` without leading and trailing blanks (spaces, tabs).
[[nodiscard]] std::string_view without_blanks(std::string_view text);

[[nodiscard]] constexpr bool is_digit(char c) noexcept {
  return c >= '0' && c <= '9';
}

/// `word` with letters A to Z in lower case.
[[nodiscard]] std::string in_lower_case(std::string_view word);

/// Removes the next line and its end (a line feed, a carriage return, or both) from `rest`; returns
/// the line without its end. Precondition: `rest` is not empty.
std::string_view take_line(std::string_view& rest);

/// The whole `token` as a number, rounded once to the nearest T (float or double), infinite beyond
/// its range; empty for other spellings ("1,5", "2m", "0x10").
template <class T>
[[nodiscard]] std::optional<T> read_number(std::string_view token);

/// The whole `token` as an integer with or without a sign; empty for a fraction, another spelling,
/// or more than 64 bits.
[[nodiscard]] std::optional<std::int64_t> read_integer(std::string_view token);

/// The whole `token` as an unsigned integer; empty for a sign, a fraction or another spelling.
[[nodiscard]] std::optional<std::uint64_t> read_count(std::string_view token);

/// The first of `tokens` that is not a number; empty if all are.
[[nodiscard]] std::string_view find_no_number(std::span<const std::string_view> tokens);

/// Coordinates and weight of a vertex as in the text; missing coordinates are 0, a missing weight
/// is 1.
using VertexWords = std::array<std::string_view, 4>;
inline constexpr VertexWords kOrigin = {"0", "0", "0", "1"};

/// The position, read and computed in `precision`; empty if a word is not a number.
[[nodiscard]] std::optional<Eigen::Vector3d> read_position(const VertexWords& words,
                                                           Precision precision);

/// Whether `path` ends in a dot and `extension` (lower case); ignores case.
[[nodiscard]] bool has_extension(const std::filesystem::path& path, std::string_view extension);

/// Whether a file of that name is a glTF file.
[[nodiscard]] inline bool is_gltf(const std::filesystem::path& path) {
  return has_extension(path, "gltf") || has_extension(path, "glb");
}

/// The entry of `table` whose `extension` `path` ends in, or nullptr.
template <class Entry, std::size_t kEntries>
[[nodiscard]] const Entry* find_extension(const std::array<Entry, kEntries>& table,
                                          const std::filesystem::path& path) {
  const auto found = std::find_if(table.begin(), table.end(), [&path](const Entry& each) {
    return has_extension(path, each.extension);
  });
  return found == table.end() ? nullptr : &*found;
}

}  // namespace boxtree::cooker
