// SPDX-License-Identifier: MIT
// The table of families.
#include "tests/oracle/exact/families.h"

namespace boxtree::oracle {

const std::vector<Family>& all_families() {
  static const std::vector<Family> families = {
      {"pairs", "overlap_pairs, first_contact: exact", 2, run_pairs},
      {"boxes", "overlap_box, overlap_box_within: exact", 1, run_boxes},
      {"points", "closest_point: within 16 ulp, bounds that hold", 4, run_points},
      {"spheres", "overlap_sphere: exact but for 16 ulp", 2, run_spheres},
      {"rays", "closest_hit, any_hit: within 2^-46 of the farthest corner", 1, run_rays},
      {"distances", "distance, overlap_within: bounds that hold, exact classification", 1,
       run_distances},
#ifdef BOXTREE_ORACLE_HAS_CGAL
      {"casts", "cast_closest: nothing missed, bounds that hold, within 2^-46", 1, run_casts},
      {"contacts", "collide: nothing missed, within 2^-46, depths that part", 1, run_contacts},
      {"hulls", "casts and contacts of hulls, likewise", 1, run_hulls},
#endif
      {"scenes", "all queries of a scene under updates, against all placed triangles", 2,
       run_scenes},
  };
  return families;
}

}  // namespace boxtree::oracle
