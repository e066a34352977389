// SPDX-License-Identifier: MIT
// triangles_intersect against exact integer arithmetic, and its symmetries.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <tests/unit/primitive/exact_simplex.h>
#include <tests/unit/primitive/triangle_cases.h>

#include <gtest/gtest.h>

#include "runtime/primitive/predicates.h"

namespace boxtree {
namespace {

constexpr int kPairsPerFamily = 20000;

std::array<test::IntVector, 3> to_integer(const Triangle& t) {
  return {test::to_integer(t.corner[0]), test::to_integer(t.corner[1]),
          test::to_integer(t.corner[2])};
}

bool exact_answer(const Triangle& p, const Triangle& q) {
  return test::hulls_intersect(to_integer(p), to_integer(q));
}

Triangle permuted(const Triangle& t, int permutation) {
  std::array<std::size_t, 3> order = {0, 1, 2};
  for (int i = 0; i < permutation; ++i) std::next_permutation(order.begin(), order.end());
  return {{t.corner[order[0]], t.corner[order[1]], t.corner[order[2]]}};
}

class TriangleTriangleFamily : public testing::TestWithParam<test::Family> {};

TEST_P(TriangleTriangleFamily, AgreesWithExactArithmetic) {
  // Small coordinates meet often; large ones need more than 53 bits for a determinant.
  for (const std::int64_t range : {std::int64_t{64}, std::int64_t{1} << 32}) {
    test::TriangleCases cases(0x5eed + static_cast<std::uint64_t>(range), range);
    int intersecting = 0;
    for (int i = 0; i < kPairsPerFamily / 2; ++i) {
      const auto [p, q] = cases.pair(GetParam());
      const bool expected = exact_answer(p, q);
      intersecting += expected;
      ASSERT_EQ(triangles_intersect(p, q), expected) << "range " << range << ", pair " << i;
    }
    EXPECT_GT(intersecting, kPairsPerFamily / 200) << "the family tests nothing";
    EXPECT_LT(intersecting, kPairsPerFamily / 2) << "the family tests nothing";
  }
}

TEST_P(TriangleTriangleFamily, IsSymmetricAndIgnoresCornerOrder) {
  test::TriangleCases cases(0xacce55, 1 << 20);
  for (int i = 0; i < kPairsPerFamily / 20; ++i) {
    const auto [p, q] = cases.pair(GetParam());
    const bool expected = triangles_intersect(p, q);
    for (int a = 0; a < 6; ++a) {
      for (int b = 0; b < 6; ++b) {
        ASSERT_EQ(triangles_intersect(permuted(p, a), permuted(q, b)), expected) << "pair " << i;
        ASSERT_EQ(triangles_intersect(permuted(q, b), permuted(p, a)), expected) << "pair " << i;
      }
    }
  }
}

TEST_P(TriangleTriangleFamily, DoesNotDependOnScale) {
  test::TriangleCases cases(0x5ca1e, 1 << 20);
  for (int i = 0; i < kPairsPerFamily / 20; ++i) {
    const auto [p, q] = cases.pair(GetParam());
    const bool expected = triangles_intersect(p, q);
    for (const int exponent : {-1000, -400, -300, -60, 170}) {
      const double scale = std::ldexp(1.0, exponent);
      Triangle ps = p, qs = q;
      for (auto& c : ps.corner) c *= scale;
      for (auto& c : qs.corner) c *= scale;
      ASSERT_EQ(triangles_intersect(ps, qs), expected) << "pair " << i << ", 2^" << exponent;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(All, TriangleTriangleFamily, testing::ValuesIn(test::kFamilies),
                         [](const auto& tested) {
                           std::string name = test::name_of(tested.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

// R24: two triangles a gap apart, swept by powers of two around contact: one flip, at zero.
TEST(TriangleTriangle, TouchIsClosedAndGapIsMonotone) {
  const Triangle floor{{{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}}};
  const auto spike_at = [](double z) { return Triangle{{{{1, 1, z}, {1, 2, 3}, {2, 1, 3}}}}; };
  EXPECT_TRUE(triangles_intersect(floor, spike_at(1)));
  for (int k = 0; k <= 52; ++k) {
    EXPECT_FALSE(triangles_intersect(floor, spike_at(1 + std::ldexp(1.0, -k)))) << k;
    EXPECT_TRUE(triangles_intersect(floor, spike_at(1 - std::ldexp(1.0, -k)))) << k;
  }
}

}  // namespace
}  // namespace boxtree
