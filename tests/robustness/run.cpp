// SPDX-License-Identifier: MIT
// The table of cases.
#include "tests/robustness/run.h"

#include <algorithm>
#include <exception>
#include <string_view>

namespace boxtree::robustness {

Run run_case(const Case& tested, bool full) {
  Run run(full);
  try {
    tested.run(run);
  } catch (const std::exception& error) {
    run.premise(false, error.what());
  }
  return run;
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  for (const auto& theme :
       {range_cases(), scale_cases(), ray_cases(), cast_cases(), pair_cases(), pose_cases(),
        degenerate_cases(), shape_cases(), store_cases(), file_cases()}) {
    cases.insert(cases.end(), theme.begin(), theme.end());
  }
  // R before E, each by number.
  std::sort(cases.begin(), cases.end(), [](const Case& a, const Case& b) {
    const std::string_view x = a.id, y = b.id;
    return x[0] != y[0] ? x[0] > y[0] : x < y;
  });
  return cases;
}

}  // namespace boxtree::robustness
