// SPDX-License-Identifier: MIT
// CGAL in plain doubles.
#include <CGAL/Simple_cartesian.h>

#include "tests/oracle/cgal_classifier.h"
#include "tests/oracle/pair_tester.h"

namespace boxtree::test {

void add_cgal_testers(std::vector<PairTester>& testers) {
  testers.push_back(
      {"cgal", "inexact kernel", cgal_triangles_intersect<CGAL::Simple_cartesian<double>>});
}

}  // namespace boxtree::test
