// SPDX-License-Identifier: MIT
// A fuzz target: a function over bytes that must come back, whatever they are. One source file
// each; libfuzzer_main.cpp hands it to libFuzzer, replay_main.cpp gives it the files of a corpus.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "format/bytes.h"

namespace boxtree::fuzz {

/// Runs one input. What does not hold ends the process by finding().
void run(Bytes input);

/// Ends the process so that libFuzzer keeps the input.
[[noreturn]] inline void finding(std::string_view what) {
  std::fprintf(stderr, "FINDING: %.*s\n", static_cast<int>(what.size()), what.data());
  std::abort();
}

}  // namespace boxtree::fuzz
