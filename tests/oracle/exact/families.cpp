// SPDX-License-Identifier: MIT
// The table of families.
#include "tests/oracle/exact/families.h"

namespace boxtree::oracle {

const std::vector<Family>& all_families() {
  static const std::vector<Family> families = {
      {"pairs", "overlap_pairs, first_contact: exact", run_pairs},
      {"boxes", "overlap_box, overlap_box_within: exact", run_boxes},
      {"points", "closest_point: within 16 ulp, bounds that hold", run_points},
      {"spheres", "overlap_sphere: exact but for 16 ulp", run_spheres},
  };
  return families;
}

}  // namespace boxtree::oracle
