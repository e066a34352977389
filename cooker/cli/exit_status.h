// SPDX-License-Identifier: MIT
// The exit statuses of the program.
#pragma once

#include <array>

namespace boxtree::cooker {

inline constexpr int kExitUsage = 1;
inline constexpr int kExitInputOutput = 2;
inline constexpr int kExitBadInput = 3;
inline constexpr int kExitInternal = 4;
inline constexpr int kExitUnsupported = 5;
inline constexpr int kExitDifference = 7;

struct ExitStatus {
  int number;
  const char* name;
  const char* meaning;
};
inline constexpr std::array kExitStatuses = {
    ExitStatus{0, "ok", "Everything was done, or every file is valid."},
    ExitStatus{kExitUsage, "usage", "The command line or a query is not valid."},
    ExitStatus{kExitInputOutput, "input/output", "A file cannot be read or written."},
    ExitStatus{kExitBadInput, "bad input",
               "A mesh, a profile, a .bxt or another input file is not valid."},
    ExitStatus{kExitInternal, "internal", "An internal error, or too little memory."},
    ExitStatus{
        kExitUnsupported, "unsupported",
        "The file needs what this program, the format, or what was cooked into it, does not have."},
    ExitStatus{kExitDifference, "difference",
               "`cook --audit` has found other bytes in the cache than a cook makes."},
};

/// Statuses that are none of the program's, in the words of a manual.
inline constexpr const char* kOtherStatuses =
    "127, and 134 where too little memory meets the start-up code of a library, come from the "
    "system before the program runs: a shared library is missing or cannot be loaded, or, in a "
    "shell, there is no such program. 128 and the number of a signal is what a shell makes of a "
    "program that the signal ended.";

}  // namespace boxtree::cooker
