// SPDX-License-Identifier: MIT
// How long what a command reports has taken.
#pragma once

#include <chrono>

namespace boxtree::cooker {

[[nodiscard]] inline double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace boxtree::cooker
