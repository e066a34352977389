// SPDX-License-Identifier: MIT
// Names of unfinished files: ".NAME.RANDOM.cooking" beside NAME.
#pragma once

#include <string>
#include <string_view>

namespace boxtree::cooker {

/// What all unfinished files end with.
inline constexpr std::string_view kTemporaryEnding = ".cooking";

/// What all unfinished files of one target begin with.
[[nodiscard]] std::string temporary_prefix(std::string_view target);

/// Whether a file is one of those.
[[nodiscard]] bool is_temporary_name(std::string_view name, std::string_view prefix);

/// A new one; empty, with the reason in errno, if the system has no random numbers.
[[nodiscard]] std::string temporary_name(std::string_view target);

}  // namespace boxtree::cooker
