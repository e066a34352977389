// SPDX-License-Identifier: MIT
// All libraries that this program can measure.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/subject.h"

namespace boxtree::bench {

/// Every library and variant found when this program was built; boxtree's with `builder`.
[[nodiscard]] std::vector<Library> all_libraries(cooker::Builder builder);

/// Names of the libraries that were not found.
[[nodiscard]] std::vector<std::string> missing_libraries();

}  // namespace boxtree::bench
