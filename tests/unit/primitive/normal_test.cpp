// SPDX-License-Identifier: MIT
// Unit normals against cross products of 128-bit integers, down to needles, and what poses make of
// them.
#include "runtime/primitive/normal.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include <gtest/gtest.h>

namespace boxtree {
namespace {

using Integers = std::array<std::int64_t, 3>;

Eigen::Vector3d vector_of(const Integers& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

// Coordinates below 2^52, so differences and products of two are exact in 128 bits.
std::array<long double, 3> exact_cross(const Integers& a, const Integers& b, const Integers& c) {
  std::array<long double, 3> cross;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3, j = (k + 2) % 3;
    __extension__ using Wide = __int128;
    const Wide product = Wide{b[i] - a[i]} * (c[j] - a[j]) - Wide{b[j] - a[j]} * (c[i] - a[i]);
    cross[k] = static_cast<long double>(product);
  }
  return cross;
}

void expect_normal(const Integers& a, const Integers& b, const Integers& c, double scale) {
  const std::array<long double, 3> cross = exact_cross(a, b, c);
  const long double length =
      std::sqrt(cross[0] * cross[0] + cross[1] * cross[1] + cross[2] * cross[2]);
  const Eigen::Vector3d normal =
      unit_normal({{scale * vector_of(a), scale * vector_of(b), scale * vector_of(c)}});
  for (std::size_t k = 0; k < 3; ++k) {
    const long double expected = length == 0 ? 0 : cross[k] / length;
    ASSERT_NEAR(normal[static_cast<Eigen::Index>(k)], static_cast<double>(expected), 0x1p-47);
  }
}

TEST(UnitNormal, PointsToWhereCornersRunCounterclockwise) {
  const Triangle triangle{{Eigen::Vector3d(0, 0, 0), {2, 0, 0}, {0, 3, 0}}};
  EXPECT_EQ(unit_normal(triangle), Eigen::Vector3d(0, 0, 1));
  const Triangle turned{{Eigen::Vector3d(0, 0, 0), {0, 3, 0}, {2, 0, 0}}};
  EXPECT_EQ(unit_normal(turned), Eigen::Vector3d(0, 0, -1));
}

TEST(UnitNormal, EqualsExactCrossProducts) {
  std::mt19937_64 random(11);
  for (const int bits : {4, 20, 40, 51}) {
    for (int i = 0; i < 20000; ++i) {
      const auto point = [&]() -> Integers {
        const std::int64_t limit = std::int64_t{1} << bits;
        std::uniform_int_distribution<std::int64_t> coordinate(-limit, limit);
        return {coordinate(random), coordinate(random), coordinate(random)};
      };
      // At the ends of the numbers that trees hold, too.
      const double scale = std::ldexp(1.0, i % 3 == 0 ? 0 : i % 3 == 1 ? 148 : -600);
      expect_normal(point(), point(), point(), scale);
    }
  }
}

// Corners nearly in line: the third is a unit beside the middle of the others, so the cross product
// is what 2^-50 of the edges leaves.
TEST(UnitNormal, OfNeedles) {
  std::mt19937_64 random(12);
  std::uniform_int_distribution<std::int64_t> coordinate(-(std::int64_t{1} << 49),
                                                         std::int64_t{1} << 49);
  std::uniform_int_distribution<std::int64_t> unit(-1, 1);
  for (int i = 0; i < 20000; ++i) {
    const Integers a{coordinate(random), coordinate(random), coordinate(random)};
    const Integers half{coordinate(random), coordinate(random), coordinate(random)};
    Integers b, c;
    for (std::size_t k = 0; k < 3; ++k) {
      b[k] = a[k] + 2 * half[k];
      c[k] = a[k] + half[k] + unit(random);
    }
    expect_normal(a, b, c, 1);
  }
}

TEST(UnitNormal, IsZeroWithoutArea) {
  const Eigen::Vector3d a(0.1, 0.2, 0.3), b(1e10, -3e5, 7);
  EXPECT_EQ(unit_normal({{a, a, a}}), Eigen::Vector3d::Zero());
  EXPECT_EQ(unit_normal({{a, b, a}}), Eigen::Vector3d::Zero());
  EXPECT_EQ(unit_normal({{Eigen::Vector3d(0, 0, 0), {1, 2, 3}, {2, 4, 6}}}),
            Eigen::Vector3d::Zero());
}

TEST(PlacedNormal, StaysOnItsSideInMirrorsAndStretches) {
  const Eigen::Vector3d up(0, 0, 1);
  const Eigen::Vector3d mirrored(-1, 1, 1), flipped(1, 1, -1), stretched(1e60, 1e-60, 3);
  EXPECT_EQ(placed_normal(mirrored.asDiagonal(), up), up);
  EXPECT_EQ(placed_normal(flipped.asDiagonal(), up), Eigen::Vector3d(-up));
  EXPECT_EQ(placed_normal(stretched.asDiagonal(), up), up);
  // Scaled alone, every bit stays.
  const Eigen::Vector3d any =
      unit_normal({{Eigen::Vector3d(0, 0, 0), {1.1, 0.3, 0.7}, {-0.2, 0.9, 0.4}}});
  for (const double scale : {1.0, 0x1p-300, 3.0}) {
    EXPECT_EQ(placed_normal(Eigen::Vector3d::Constant(scale).asDiagonal(), any), any);
  }
  // A plane x + z = 0 stretched along x turns toward z.
  const Eigen::Vector3d slope = Eigen::Vector3d(1, 0, 1) / std::sqrt(2.0);
  const Eigen::Vector3d wide(4, 1, 1);
  const Eigen::Vector3d expected = Eigen::Vector3d(0.25, 0, 1) / std::sqrt(1.0625);
  EXPECT_LT((placed_normal(wide.asDiagonal(), slope) - expected).cwiseAbs().maxCoeff(), 1e-15);
}

}  // namespace
}  // namespace boxtree
