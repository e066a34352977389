// SPDX-License-Identifier: MIT
// What is wrong with a command line, and the name that was probably meant.
#pragma once

#include <string>

#include <CLI/CLI.hpp>

namespace boxtree::cooker {

/// The command of `app` with that name; null if there is none.
[[nodiscard]] const CLI::App* find_command(const CLI::App& app, const std::string& name);

/// "'quary' is no command; did you mean 'query'?", of the commands of `app`.
[[nodiscard]] std::string unknown_command(const CLI::App& app, const std::string& word);

/// The message for an error of parsing, with line ends: for CLI::App::failure_message.
[[nodiscard]] std::string usage_message(const CLI::App* app, const CLI::Error& error);

}  // namespace boxtree::cooker
