// SPDX-License-Identifier: MIT
// The version of the tool, for cook records and --version.
#pragma once

#include <string_view>

namespace boxtree::cooker {

inline constexpr std::string_view kVersion = "0.1.0";

}  // namespace boxtree::cooker
