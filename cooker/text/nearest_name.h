// SPDX-License-Identifier: MIT
// Names in messages: those that there are, and the one that a misspelt one was probably meant to
// be.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

namespace boxtree::cooker {

/// The least number of letters to insert, delete, replace, or swap with their neighbour to turn one
/// word into the other (Damerau, "A technique for computer detection and correction of spelling
/// errors", CACM 1964). Bytes count as letters. Cost: the product of both lengths.
[[nodiscard]] std::size_t edit_distance(std::string_view from, std::string_view to);

/// The first of `names` with the least distance; empty if there are none.
[[nodiscard]] std::string nearest_name(std::string_view name, std::span<const std::string> names);

/// What other programs call what is called `name` here.
struct Synonym {
  std::string_view word, name;
};

/// The one of `names` that is probably meant: of the first of `synonyms` that `name` is, or the
/// nearest; empty if more than a third of the letters would change, or all of them.
[[nodiscard]] std::string meant_name(std::string_view name, std::span<const std::string> names,
                                     std::span<const Synonym> synonyms = {});

/// "ray, box or point".
[[nodiscard]] std::string listed(std::span<const std::string> names);

/// The words one after another, `between` between them.
[[nodiscard]] std::string joined(std::span<const std::string> words,
                                 std::string_view between = " ");

/// Behind what was expected: " (nearest: \"ray\")" with meant_name(), otherwise " (ray, box or
/// point)" of at most 32 names; " (there are none)".
[[nodiscard]] std::string nearest_in_words(std::string_view name,
                                           std::span<const std::string> names,
                                           std::span<const Synonym> synonyms = {});

/// "; did you mean 'query'?" with meant_name(); empty if there is none.
[[nodiscard]] std::string suggestion(std::string_view name, std::span<const std::string> names,
                                     std::span<const Synonym> synonyms = {});

/// The same of names that may be paths: also with the first of which `name` is the last part.
[[nodiscard]] std::string path_suggestion(std::string_view name,
                                          std::span<const std::string> names);

/// "; expected ray, box or point"; empty if there are none, or more than eight.
[[nodiscard]] std::string expected_if_few(std::span<const std::string> names);

}  // namespace boxtree::cooker
