// SPDX-License-Identifier: MIT
// How --help looks: a usage line, then options with what they take and what they do, within 79
// columns. Common options first; --help-all shows the rest too, in the manner of zstd.
#pragma once

#include <string>
#include <vector>

#include "cooker/cli/command_app.h"

namespace boxtree::cooker {

/// For Commands alone.
class HelpFormatter : public CLI::Formatter {
 public:
  std::string make_help(const CLI::App* app, std::string name,
                        CLI::AppFormatMode mode) const override;
  std::string make_usage(const CLI::App* app, std::string name) const override;
  std::string make_group(std::string group, bool is_positional,
                         std::vector<const CLI::Option*> options) const override;
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_description(const CLI::App* app) const override;
  std::string make_footer(const CLI::App* app) const override;

 private:
  // What the functions that make_help calls are not told.
  mutable bool all_ = false;
  mutable const CLI::App* app_ = nullptr;
};

}  // namespace boxtree::cooker
