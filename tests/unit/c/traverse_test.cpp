// SPDX-License-Identifier: MIT
// Traversals of the caller's own by the C interface: those of the C++ interface.
#include <boxtree_c.h>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "tests/unit/c/options.h"
#include "tests/unit/c/subjects.h"

namespace boxtree {
namespace {

using test::Answer;
using test::Numbers;
using test::numbers_of;

// What both are given: boxes below a height, and what they found.
struct Search {
  double height;
  std::vector<Numbers> found = {};
};

bool is_below(void* context, const bxt_vec3* min, const bxt_vec3* max) {
  EXPECT_LE(min->x, max->x);
  return min->z < static_cast<Search*>(context)->height;
}
bool keep(void* context, const bxt_triangle* triangle, const bxt_face* face, std::uint32_t half) {
  std::vector<Numbers>& found = static_cast<Search*>(context)->found;
  found.push_back(numbers_of(*triangle) << *face << half);
  return found.size() < 100;
}

TEST(CTraversals, AreThoseOfCpp) {
  std::size_t count = 0;
  test::for_each_tree([&](const Tree& tree, const bxt_tree* c_tree) {
    const double height = tree.bounds().center().z();
    test::for_each_limits(tree, [&](const bxt_limits* c, const QueryLimits& limits) {
      Answer expected;
      const auto test = [&](const Eigen::AlignedBox3d& box) { return box.min().z() < height; };
      const auto visit = [&](const LeafTriangle& found) {
        expected.found.push_back(numbers_of(found.triangle)
                                 << found.face << std::uint32_t{BXT_NO_INSTANCE} << found.half);
        return expected.found.size() < 100;
      };
      note_error(traverse(tree, test, visit, limits), expected);
      count += expected.found.size();
      ASSERT_EQ(test::answer_of_c([&](bxt_error* error, std::vector<Numbers>& found) {
                  Search search{height};
                  const bxt_status status =
                      bxt_tree_traverse(c_tree, is_below, keep, &search, c, error);
                  found = search.found;
                  return status;
                }),
                expected);
    });
  });
  EXPECT_GT(count, 1000u);
}

}  // namespace
}  // namespace boxtree
