// SPDX-License-Identifier: MIT
// What all commands share: errors on standard error, and text that a terminal may be given.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// Prints "boxtree: WHAT" to standard error.
void complain(std::string_view what) noexcept;

/// Prints "boxtree: NAME: DETAIL" to standard error and returns the exit status of the error.
int fail(const Error& error);

/// Whether the same command may succeed when it runs again, with nothing changed but the state of
/// the machine: exit statuses tell "try again" from "never" (docs/GUIDE.md).
[[nodiscard]] bool may_pass(const Error& error);

/// fail() for a command line that contradicts itself, which is called usage: kExitUsage. `what`
/// begins with the command, "cook: ".
int usage(const std::string& what);

/// Prints "boxtree: warning: WHAT" to standard error: what was done may not be what was meant.
/// Printed with --quiet and --json, too. `what` begins with the file.
void warn(const std::string& what);

/// Says that standard output takes no more; kExitInputOutput.
int fail_to_print();

/// Why an output that is no mesh may not have this name: the ending of a mesh, which a source would
/// be written over by. Empty if it may. `instead`: an ending to name.
[[nodiscard]] std::string mesh_name_fault(const std::filesystem::path& output,
                                          const std::string& instead);

/// Text from a file or a path as a terminal may be given it: control characters, and bytes that are
/// no UTF-8, as \\xNN.
[[nodiscard]] std::string shown(std::string_view text);

}  // namespace boxtree::cooker
