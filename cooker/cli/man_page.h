// SPDX-License-Identifier: MIT
// Manual pages, in the macros of man(7).
#pragma once

#include <string>
#include <vector>

#include "cooker/cli/command.h"

namespace boxtree::cooker {

struct ManPage {
  std::string name;  // "boxtree-cook", of section 1
  std::string text;
};

/// The page of the program or of one of its commands. Kinds of a command stand in its page.
[[nodiscard]] ManPage man_page(const Command& command);

/// The page of the program and those of all its commands.
[[nodiscard]] std::vector<ManPage> all_man_pages(const Command& program);

}  // namespace boxtree::cooker
