// SPDX-License-Identifier: MIT
// Error texts with numbers in little code: string concatenation inlines an allocation, a copy and a
// clean-up for each operator, which was a tenth of what a small runtime links.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string_view>

#include <boxtree/error.h>

namespace boxtree {

/// An error whose detail is `place` followed by `text`, each '#' replaced by the next number.
/// Precondition: as many numbers as '#', or more.
[[nodiscard]] Error error_with(Errc code, std::string_view place, std::string_view text,
                               std::initializer_list<std::uint64_t> numbers = {});

/// The error, its detail after `place`.
[[nodiscard]] Error error_at(std::string_view place, const Error& error);
/// The same with ": " between them.
[[nodiscard]] Error error_in(std::string_view place, const Error& error);

/// The error, its detail after "tree 2: ", of what is called `what`.
[[nodiscard]] Error error_of(std::string_view what, std::uint64_t number, const Error& error);

/// "there is no tree 2; expected 0 or 1", of `count` things called `what`.
/// Precondition: index >= count.
[[nodiscard]] Error index_error(Errc code, std::string_view what, std::uint64_t index,
                                std::uint64_t count);

/// kSectionSize with both sizes; the caller knows which section of which tree.
[[nodiscard]] Error section_size_error(std::uint64_t found, std::uint64_t expected);

}  // namespace boxtree
