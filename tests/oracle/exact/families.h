// SPDX-License-Identifier: MIT
// The families of queries: one file each.
#pragma once

#include <vector>

#include "tests/oracle/exact/draw.h"
#include "tests/oracle/exact/tally.h"

namespace boxtree::oracle {

struct Family {
  const char* name;
  const char* what;  // is compared with what
  unsigned share;    // of the answers; 0: only runs when it is named
  /// Draws meshes and queries, and compares all answers.
  void (*run_case)(Draw& draw, Tally& tally, std::uint64_t number);
};

void run_pairs(Draw& draw, Tally& tally, std::uint64_t number);
void run_boxes(Draw& draw, Tally& tally, std::uint64_t number);
void run_points(Draw& draw, Tally& tally, std::uint64_t number);
void run_spheres(Draw& draw, Tally& tally, std::uint64_t number);
void run_rays(Draw& draw, Tally& tally, std::uint64_t number);
void run_distances(Draw& draw, Tally& tally, std::uint64_t number);
#ifdef BOXTREE_ORACLE_HAS_CGAL
void run_casts(Draw& draw, Tally& tally, std::uint64_t number);
void run_contacts(Draw& draw, Tally& tally, std::uint64_t number);
void run_hulls(Draw& draw, Tally& tally, std::uint64_t number);
#endif
void run_scenes(Draw& draw, Tally& tally, std::uint64_t number);

[[nodiscard]] const std::vector<Family>& all_families();

}  // namespace boxtree::oracle
