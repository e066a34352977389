// SPDX-License-Identifier: MIT
// Texts of errors with numbers in them, in few bytes of code: sums of strings inline an allocation,
// a copy and a clean-up for each sign, which was a tenth of what a small runtime links.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string_view>

#include <boxtree/error.h>

namespace boxtree {

/// An error whose detail is `place` and then `text`, in which each '#' stands for the next number.
/// Precondition: as many numbers as signs.
[[nodiscard]] Error error_with(Errc code, std::string_view place, std::string_view text,
                               std::initializer_list<std::uint64_t> numbers = {});

/// kSectionSize with both sizes; the caller knows which section of which tree.
[[nodiscard]] Error section_size_error(std::uint64_t found, std::uint64_t expected);

}  // namespace boxtree
