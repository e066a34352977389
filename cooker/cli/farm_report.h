// SPDX-License-Identifier: MIT
// What is said of a cook by its key.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cooker/cli/json_output.h"
#include "cooker/farm/keyed_cook.h"

namespace boxtree::cooker {

/// What is kept with an output: the warnings of its cook, which whoever gets it from a cache is to
/// be told as well.
[[nodiscard]] std::string keyed_report(const Summary& summary);
/// The warnings in it.
[[nodiscard]] Json warnings_in(const std::string& report);

/// Prints them as warnings; each begins with `place`, if it is not empty.
void warn_all(const std::string& report, const std::string& place = "");

/// Prints what is new of take_warnings() as warnings, and returns them as they were printed. Null:
/// there is no cache.
std::vector<std::string> warn_of_cache(const CookCache* cache);

/// Puts them in front of "warnings" of the document of a job, which need not have any.
void add_warnings(const std::vector<std::string>& of_cache, Json& document);

/// Prints what an audit has found. Its exit status.
int fail_by(const Error& difference);

/// The error of a job that ended with an exception, as main() has it for a whole program.
/// Precondition: called in a handler.
[[nodiscard]] Error error_of_job();

/// Of a job of that output: key, bytes, where they are from, and warnings.
[[nodiscard]] Json outcome_json(const std::string& output, const std::optional<Digest>& key,
                                const KeyedOutcome& outcome, double seconds);
/// `status`: of a cook that ends with the error.
[[nodiscard]] Json error_json(const std::string& output, const std::optional<Digest>& key,
                              const Error& error, int status, double seconds);

}  // namespace boxtree::cooker
