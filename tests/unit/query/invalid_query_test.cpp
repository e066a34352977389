// SPDX-License-Identifier: MIT
// What queries say of arguments that they do not take.
#include <limits>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "tests/support/cooked.h"
#include "tests/support/meshes.h"

namespace boxtree {
namespace {

// Every argument and field that a query refuses.
TEST(InvalidQuery, EveryRefusedFieldSaysWhatIsExpected) {
  const test::CookedTree cooked = test::cook_tree(test::sphere(6, 8), CodecId::kWide8);
  const Tree& tree = cooked.tree;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto says_more = [](const auto& outcome) {
    const Error error = outcome.error();
    EXPECT_EQ(error.code, Errc::kInvalidQuery);
    const std::string start = "invalid_query: " + error.detail + ": expected ";
    EXPECT_EQ(error.message().compare(0, start.size(), start), 0) << error.message();
  };
  const auto all = [](const auto&) { return true; };
  const Eigen::Vector3d origin(0, 0, 0), along(0, 0, 1), bad(nan, 0, 0);
  says_more(closest_hit(tree, {bad, along}));
  says_more(closest_hit(tree, {origin, origin}));
  says_more(closest_hit(tree, {origin, along, -1}));
  says_more(closest_hit(tree, {origin, along, 0, -1}));
  says_more(closest_point(tree, bad));
  says_more(closest_point(tree, origin, -1));
  says_more(overlap_sphere(tree, {bad, 1}, all));
  says_more(overlap_sphere(tree, {origin, -1}, all));
  says_more(overlap_box(tree, Eigen::AlignedBox3d(), all));
  says_more(overlap_capsule(tree, {bad, origin, 1}, all));
  says_more(overlap_capsule(tree, {origin, bad, 1}, all));
  says_more(overlap_oriented_box(tree, {bad, {1, 1, 1}}, all));
  says_more(overlap_oriented_box(tree, {origin, {1, -1, 1}}, all));
  says_more(cast_closest(tree, Sphere{origin, 1}, {bad}));
  says_more(cast_closest(tree, Sphere{origin, 1}, {along, -1}));
  says_more(cast_closest(tree, ConvexHull{}, {along}));
}

}  // namespace
}  // namespace boxtree
