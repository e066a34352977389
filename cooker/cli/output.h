// SPDX-License-Identifier: MIT
// What all commands share: exit statuses, errors on standard error, parsing of vectors.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <nlohmann/json.hpp>

#include <boxtree/error.h>

#include "runtime/tree/geometry.h"

namespace boxtree::cooker {

using Json = nlohmann::ordered_json;

inline constexpr int kExitUsage = 1;
inline constexpr int kExitInputOutput = 2;
inline constexpr int kExitBadInput = 3;
inline constexpr int kExitInternal = 4;

/// Prints "boxtree: WHAT" to standard error.
void complain(std::string_view what) noexcept;

/// Prints "boxtree: CODE: DETAIL" to standard error and returns the exit status of the code.
int fail(const Error& error);

/// The same for a command line that contradicts itself, without a code: kExitUsage.
int usage(const std::string& what);

/// Says that standard output takes no more; kExitInputOutput.
int fail_to_print();

/// Text from a file or a path as a terminal may be given it: control characters, and bytes that are
/// no UTF-8, as \\xNN.
[[nodiscard]] std::string shown(std::string_view text);

/// Prints one JSON document to standard output, behind the number of the schema that all documents
/// of this program follow: keys may be added under it, none is renamed. Bytes that are no UTF-8
/// become U+FFFD.
void print(const Json& document);
/// What print() prints.
[[nodiscard]] std::string document_text(const Json& document);
/// What is said of each of several files: the only one as it is, several as {"files": [...]}.
void print_files(std::vector<Json> documents);
/// The same in one line, as text.
[[nodiscard]] std::string line_of(const Json& value);

/// A vector as three numbers.
[[nodiscard]] Json to_json(const Eigen::Vector3d& vector);

/// An option like "1,-2.5,3e4"; reports a bad one as CLI11 reports bad options. `out` has to live
/// until the command line has been parsed.
CLI::Option* add_vector_option(CLI::App& command, const std::string& option, Eigen::Vector3d& out,
                               const std::string& help);

/// Each command adds itself to `app` and stores its exit status in `status` when it has run.
void add_cook_command(CLI::App& app, int& status);
void add_info_command(CLI::App& app, int& status);
void add_verify_command(CLI::App& app, int& status);
void add_query_command(CLI::App& app, int& status);
void add_bench_command(CLI::App& app, int& status);
void add_report_command(CLI::App& app, int& status);
void add_export_command(CLI::App& app, int& status);

}  // namespace boxtree::cooker
