// SPDX-License-Identifier: MIT
// The options of one job of a cook, for every command that takes them: what they are called, which
// exclude each other, and which CookOptions they stand for.
#pragma once

#include <string>
#include <vector>

#include "cooker/cli/command.h"
#include "cooker/shell/cook_job.h"

namespace boxtree::cooker {

/// Values as a command line gives them, and the options that were declared for them.
struct CookArguments {
  CookJob job;
  std::string format;  // of standard input
  std::string codec = "auto";
  std::string goal = "balance";
  std::string builder = "sah";
  std::string widths = "exact";
  std::string grid_step;
  bool exact = false;
  bool external = false;
  bool no_face_ids = false;
  bool strip = false;
  bool trusted = false;
  bool f64 = false;

  std::vector<Option*> all;  // but MESH
  Option* inputs = nullptr;
  Option* output = nullptr;  // whether it is needed is for the command to say
  Option* profile = nullptr;
  Option* grid_bits_option = nullptr;
  Option* grid_step_option = nullptr;
};

/// Adds MESH and all options of a job to a command. `arguments` has to live until it has run.
void declare_cook_options(Command& command, CookArguments& arguments);

/// Sets the options of the job to what was parsed. Returns what is wrong with the job as a whole;
/// nothing if it may be cooked.
[[nodiscard]] std::string finish_cook_options(CookArguments& arguments);

/// Reads the input - from standard input, if it is one. Errors: those of standard_mesh.
Status take_standard_mesh(CookArguments& arguments);

/// Of a callback: refuses a command line without MESH or --profile.
void require_source(const CookArguments& arguments);

}  // namespace boxtree::cooker
