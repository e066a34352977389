// SPDX-License-Identifier: MIT
// All libraries that can be measured here.
#pragma once

#include <string>
#include <vector>

#include "tests/bench/subject.h"

namespace boxtree::bench {

/// Every library and variant that was found when this program was built; ours with `builder`.
[[nodiscard]] std::vector<Library> all_libraries(cooker::Builder builder);

/// Names of those that were not.
[[nodiscard]] std::vector<std::string> missing_libraries();

}  // namespace boxtree::bench
