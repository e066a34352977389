// SPDX-License-Identifier: MIT
// triangle_distance against a reference that shares no idea with it: the distance of a point to the
// hull of all differences of corners, by a descent over the pairs of points in extended precision,
// and against the exact overlap predicate.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <tests/unit/primitive/triangle_cases.h>

#include <gtest/gtest.h>

#include "runtime/primitive/predicates.h"
#include "tests/support/triangle_reference.h"

namespace boxtree {
namespace {

constexpr int kPairsPerFamily = 4000;

double largest_coordinate(const Triangle& p, const Triangle& q) {
  double largest = 0;
  for (const Triangle* t : {&p, &q}) {
    for (const auto& c : t->corner) largest = std::max(largest, c.cwiseAbs().maxCoeff());
  }
  return largest;
}

class TriangleDistanceFamily : public testing::TestWithParam<test::Family> {};

void check(const Triangle& p, const Triangle& q) {
  const TriangleDistance found = triangle_distance(p, q);
  const double max_abs = largest_coordinate(p, q);
  const bool touch = triangles_intersect(p, q);
  // The reference is good to its own rounding, far below that of double.
  const double expected = touch ? 0 : test::distance_in_extended_precision(p, q);
  ASSERT_LE(found.lower, expected * (1 + 1e-17) + 1e-19 * max_abs);
  ASSERT_GE(found.upper, expected - 1e-19 * max_abs);
  // Two that touch under a small angle do so in a place that double finds only so well.
  ASSERT_LE(found.upper - expected, (touch ? 1e-9 : 1e-14) * max_abs);
  ASSERT_NEAR((found.second - found.first).norm(), found.upper, 1e-14 * max_abs);
  const auto off = [](const Eigen::Vector3d& x, const Triangle& t) {
    return test::distance_in_extended_precision(x, t);
  };
  ASSERT_LE(off(found.first, p), 1e-13 * max_abs);
  ASSERT_LE(off(found.second, q), 1e-13 * max_abs);
  if (touch) {
    ASSERT_EQ(found.lower, 0);
  }
}

TEST_P(TriangleDistanceFamily, BoundsAreTrue) {
  for (const std::int64_t range : {std::int64_t{64}, std::int64_t{1} << 20}) {
    test::TriangleCases cases(0xd157 + static_cast<std::uint64_t>(range), range);
    for (int i = 0; i < kPairsPerFamily; ++i) {
      SCOPED_TRACE(i);
      const auto [p, q] = cases.pair(GetParam());
      check(p, q);
      if (HasFatalFailure()) return;
    }
  }
}

// Apart by more than rounding, the bounds leave no doubt: far, near and very near.
TEST_P(TriangleDistanceFamily, BoundsAreNarrow) {
  test::TriangleCases cases(0xd158, 64);
  double widest = 0;
  int apart = 0;
  for (int i = 0; i < kPairsPerFamily; ++i) {
    auto [p, q] = cases.pair(GetParam());
    const TriangleDistance here = triangle_distance(p, q);
    if (here.lower == 0) continue;
    ++apart;
    for (const double share : {-8.0, 0.0, 0.9, 1 - 1e-6, 1 - 1e-10}) {
      const Eigen::Vector3d shift = share * (here.second - here.first);
      Triangle nearer = p;
      for (auto& c : nearer.corner) c += shift;
      const TriangleDistance found = triangle_distance(nearer, q);
      widest = std::max(widest, (found.upper - found.lower) / largest_coordinate(nearer, q));
    }
  }
  EXPECT_GT(apart, kPairsPerFamily / 10);
  EXPECT_LT(widest, 1e-11);
}

INSTANTIATE_TEST_SUITE_P(All, TriangleDistanceFamily, testing::ValuesIn(test::kFamilies),
                         [](const auto& tested) {
                           std::string name = test::name_of(tested.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// By hand: corner to face, corner to corner, edge to edge, edge to corner.
TEST(TriangleDistance, KnownCases) {
  const Triangle floor{{{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}}};
  const auto expect = [&](const Triangle& other, double distance, const Eigen::Vector3d& first) {
    const TriangleDistance found = triangle_distance(floor, other);
    EXPECT_NEAR(found.lower, distance, 1e-13);
    EXPECT_NEAR(found.upper, distance, 1e-13);
    EXPECT_NEAR((found.first - first).norm(), 0, 1e-13);
    const TriangleDistance swapped = triangle_distance(other, floor);
    EXPECT_NEAR(swapped.upper, distance, 1e-13);
    EXPECT_NEAR((swapped.second - first).norm(), 0, 1e-13);
  };
  expect({{{{1, 1, 2}, {1, 2, 5}, {2, 1, 5}}}}, 2, {1, 1, 0});
  expect({{{{-3, -4, 0}, {-9, -9, 1}, {-9, -8, -1}}}}, 5, {0, 0, 0});
  expect({{{{3, 3, -1}, {3, 3, 1}, {9, 9, 0}}}}, std::sqrt(2.0), {2, 2, 0});
  expect({{{{2, -3, 0}, {1, -7, 1}, {3, -8, 2}}}}, 3, {2, 0, 0});
  expect({{{{1, 1, 7}, {1, 1, 7}, {1, 1, 7}}}}, 7, {1, 1, 0});
}

// Rounding is relative: the same at every size that coordinates may have.
TEST(TriangleDistance, DoesNotDependOnScale) {
  test::TriangleCases cases(0x5ca1f, 1 << 20);
  for (int i = 0; i < 2000; ++i) {
    const auto [p, q] = cases.pair(test::kFamilies[static_cast<std::size_t>(i) % 8]);
    const TriangleDistance here = triangle_distance(p, q);
    for (const int exponent : {-200, -60, 60, 170}) {
      const double scale = std::ldexp(1.0, exponent);
      Triangle ps = p, qs = q;
      for (auto& c : ps.corner) c *= scale;
      for (auto& c : qs.corner) c *= scale;
      const TriangleDistance there = triangle_distance(ps, qs);
      ASSERT_EQ(there.lower, here.lower * scale) << i << ", 2^" << exponent;
      ASSERT_EQ(there.upper, here.upper * scale) << i << ", 2^" << exponent;
    }
  }
}

}  // namespace
}  // namespace boxtree
