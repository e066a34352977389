// SPDX-License-Identifier: MIT
// What is wrong with a command line, and the name that was probably meant.
#pragma once

#include <string>

#include "cooker/cli/command.h"

namespace CLI {
class App;
class Error;
}  // namespace CLI

namespace boxtree::cooker {

/// "'quary' is no command; did you mean 'query'?", of the commands of `command`.
[[nodiscard]] std::string unknown_command(const Command& command, const std::string& word);

/// What is wrong, without line ends: "cook: --output is required".
[[nodiscard]] std::string usage_fault(const CLI::App* app, const CLI::Error& error);

/// The message for an error of parsing, with line ends: for CLI::App::failure_message.
[[nodiscard]] std::string usage_message(const CLI::App* app, const CLI::Error& error);

}  // namespace boxtree::cooker
