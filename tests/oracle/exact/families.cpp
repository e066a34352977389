// SPDX-License-Identifier: MIT
// The table of families.
#include "tests/oracle/exact/families.h"

namespace boxtree::oracle {

const std::vector<Family>& all_families() {
  static const std::vector<Family> families = {
      {"pairs", "overlap_pairs, first_contact: exact", run_pairs},
  };
  return families;
}

}  // namespace boxtree::oracle
