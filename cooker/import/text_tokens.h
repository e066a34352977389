// SPDX-License-Identifier: MIT
// Small pieces that the readers of text formats share.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

namespace boxtree::cooker {

using Tokens = std::vector<std::string_view>;

/// The words of `text`, between spaces, tabs, line ends and backslashes.
void split_tokens(std::string_view text, Tokens& tokens);

/// The number at the beginning of `token`, exactly as assimp reads it; nothing if it reads none.
[[nodiscard]] std::optional<float> read_number(std::string_view token);

/// The same number with all its digits; what read_number does not read, this does not.
[[nodiscard]] std::optional<double> read_exact_number(std::string_view token);

/// Coordinates and weight of a vertex as they stand in a text; those left out are 0, the weight 1.
using VertexWords = std::array<std::string_view, 4>;
inline constexpr VertexWords kOrigin = {"0", "0", "0", "1"};

/// The position: from all digits in double, or else as assimp has it, in float.
[[nodiscard]] Eigen::Vector3d read_position(const VertexWords& words, bool exact);

/// The OBJ vertex that stands for a fault (flatten.h), as a line.
[[nodiscard]] std::string marker_line(std::size_t fault);

/// Whether `path` ends in a dot and `extension` (lower case), in any case.
[[nodiscard]] bool has_extension(const std::filesystem::path& path, std::string_view extension);

}  // namespace boxtree::cooker
