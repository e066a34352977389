// SPDX-License-Identifier: MIT
// What each library answers for single pairs of triangles.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runtime/primitive/triangle.h"

namespace boxtree::test {

/// Whether two triangles share a point, as one library says. Coordinates are floats.
struct PairTester {
  std::string library;
  std::string variant;
  std::function<bool(const Triangle&, const Triangle&)> intersect;
  unsigned every = 1;  // only every n-th pair, of slow ones
};

// Each library adds its own; those that are not installed are not compiled.
void add_boxtree_testers(std::vector<PairTester>& testers);
void add_cgal_testers(std::vector<PairTester>& testers);
void add_fcl_testers(std::vector<PairTester>& testers);
void add_bullet_testers(std::vector<PairTester>& testers);
void add_ode_testers(std::vector<PairTester>& testers);

}  // namespace boxtree::test
