// SPDX-License-Identifier: MIT
// Completion scripts for shells.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "cooker/cli/command.h"

namespace boxtree::cooker {

inline constexpr std::array kShells = {"bash", "zsh", "fish"};

/// The script for one of kShells: commands, kinds, options, the values of those that list them,
/// and files by their endings.
[[nodiscard]] std::string completion_script(const Command& program, std::string_view shell);

}  // namespace boxtree::cooker
