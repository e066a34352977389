// SPDX-License-Identifier: MIT
// Commands as CLI11 has them: for what parses them and what CLI11 calls back.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

#include "cooker/cli/command.h"

namespace boxtree::cooker {

/// All apps of the program are CommandApps, as Command alone makes them.
class CommandApp : public CLI::App {
 public:
  CommandApp(const Command& made_by, const std::string& description, CLI::App* parent);
  ~CommandApp() override;  // elsewhere, so that CLI11 is compiled there alone

  const Command& command;
};

[[nodiscard]] inline const Command& command_of(const CLI::App& app) {
  return static_cast<const CommandApp&>(app).command;
}

[[nodiscard]] OptionText text_of(const Command& command, const CLI::Option& option);

}  // namespace boxtree::cooker
