// SPDX-License-Identifier: MIT
#include "cooker/cli/job_words.h"

#include <utility>

#include "cooker/cli/command.h"
#include "cooker/cli/cook_arguments.h"

namespace boxtree::cooker {

Result<CookJob> job_of_words(const std::vector<std::string>& options, bool has_profile) {
  Command program("boxtree", "", "");
  Command& cook = program.add_command("cook", "");
  CookArguments arguments;
  declare_cook_options(cook, arguments);
  std::vector<std::string> words{cook.name()};
  if (has_profile) words.insert(words.end(), {"--profile", "its own"});
  words.insert(words.end(), options.begin(), options.end());
  std::string fault = program.take(words);
  if (fault.empty() && arguments.inputs->count() > 0) {
    fault = "'" + arguments.job.inputs.front().string() + "' is no option";
  }
  if (fault.empty() && arguments.output->count() > 0) fault = "--output is no option here";
  if (fault.empty()) fault = finish_cook_options(arguments);
  if (!fault.empty()) return Error{Errc::kDocumentInvalid, fault};
  if (has_profile) arguments.job.profile.clear();
  return std::move(arguments.job);
}

}  // namespace boxtree::cooker
