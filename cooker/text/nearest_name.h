// SPDX-License-Identifier: MIT
// The name that was probably meant by one that was misspelt.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace boxtree::cooker {

/// The fewest letters put in, left out, replaced, or swapped with their neighbour that make one
/// word of the other (Damerau, "A technique for computer detection and correction of spelling
/// errors", CACM 1964). Bytes count as letters. Cost: the product of both lengths.
[[nodiscard]] std::size_t edit_distance(std::string_view from, std::string_view to);

/// Of `names` the first with the least distance; empty if there are none.
[[nodiscard]] std::string nearest_name(std::string_view name, std::span<const std::string> names);

/// "; did you mean 'query'?" with the nearest of `names`; empty where more than a third of the
/// letters would be others.
[[nodiscard]] std::string suggestion(std::string_view name, std::span<const std::string> names);

}  // namespace boxtree::cooker
