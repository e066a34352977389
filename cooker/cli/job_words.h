// SPDX-License-Identifier: MIT
// Options of a job that are words of a file instead of a command line: those of a manifest.
#pragma once

#include <string>
#include <vector>

#include <boxtree/error.h>

#include "cooker/shell/cook_job.h"

namespace boxtree::cooker {

/// The job that `boxtree cook` makes of these options, without inputs and output, which are no
/// words here. `has_profile`: the job has one, with which some options cannot be given. Error:
/// kDocumentInvalid with what is wrong, in the words of the command line.
Result<CookJob> job_of_words(const std::vector<std::string>& options, bool has_profile = false);

}  // namespace boxtree::cooker
