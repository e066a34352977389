// SPDX-License-Identifier: MIT
// Commands of reports, as readers paste them.
#pragma once

#include <string>
#include <string_view>

namespace boxtree::cooker {

/// A file name as one word of a POSIX shell: in single quotes where it has more than letters,
/// digits and "%+,-./:@_", and below "./" where it would be an option.
[[nodiscard]] std::string shell_word(std::string_view file_name);

}  // namespace boxtree::cooker
