// SPDX-License-Identifier: MIT
// orient3d and orient2d against 128-bit integers, on points that lie on or next to the plane.
#include "runtime/primitive/orientation.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <random>
#include <tests/unit/primitive/exact_simplex.h>
#include <tests/unit/primitive/triangle_cases.h>

#include <gtest/gtest.h>

#include "runtime/primitive/expansion.h"
#include "runtime/primitive/wide_integer.h"

namespace boxtree {
namespace {

constexpr int kCases = 20000;

test::IntVector difference(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const test::IntVector p = test::to_integer(a), q = test::to_integer(b);
  return {p.x - q.x, p.y - q.y, p.z - q.z};
}

// A lattice point on the plane through a, b, c, moved by at most one unit.
Eigen::Vector3d near_plane(test::TriangleCases& cases, const Triangle& t) {
  const auto weight = [&cases] { return static_cast<double>(cases.integer(-3, 3)); };
  const auto& c = t.corner;
  Eigen::Vector3d on = c[0] + weight() * (c[1] - c[0]);
  on += weight() * (c[2] - c[0]);
  return cases.integer(0, 2) == 0 ? on : Eigen::Vector3d(on + cases.point(1));
}

TEST(Orient3d, SignMatchesItsDescription) {
  const Eigen::Vector3d a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);  // counter-clockwise from above
  EXPECT_EQ(orient3d(a, b, c, {0.25, 0.25, -1}), 1);
  EXPECT_EQ(orient3d(a, b, c, {0.25, 0.25, 1}), -1);
  EXPECT_EQ(orient3d(a, b, c, {7, -9, 0}), 0);
  EXPECT_EQ(orient2d({0, 0}, {1, 0}, {0, 1}), 1);
  EXPECT_EQ(orient2d({0, 0}, {0, 1}, {1, 0}), -1);
  EXPECT_EQ(orient2d({0, 0}, {1, 1}, {3, 3}), 0);
}

TEST(Orient3d, AgreesWithIntegersNextToThePlane) {
  for (const int bits : {6, 12, 24, 36}) {
    test::TriangleCases cases(0x0a1e, 64);
    std::array<int, 3> seen{};
    for (int i = 0; i < kCases; ++i) {
      const Triangle t = cases.triangle(std::int64_t{1} << bits);
      const Eigen::Vector3d d = near_plane(cases, t);
      const auto& c = t.corner;
      const int expected =
          test::determinant_sign(difference(c[0], d), difference(c[1], d), difference(c[2], d));
      ++seen[static_cast<std::size_t>(expected + 1)];
      ASSERT_EQ(orient3d(c[0], c[1], c[2], d), expected) << bits << " bits, case " << i;
      ASSERT_EQ(orient3d_exact(c[0], c[1], c[2], d), expected) << bits << " bits, case " << i;
    }
    for (const int count : seen) EXPECT_GT(count, kCases / 10);
  }
}

TEST(Orient3d, IsAntisymmetricAndScales) {
  test::TriangleCases cases(0xa5, 64);
  for (int i = 0; i < kCases; ++i) {
    Triangle t = cases.triangle(std::int64_t{1} << 40);
    Eigen::Vector3d d = near_plane(cases, t);
    const int sign = orient3d(t.corner[0], t.corner[1], t.corner[2], d);
    const double scale = std::ldexp(1.0, static_cast<int>(cases.integer(-1074, 150)));
    for (auto& c : t.corner) c *= scale;
    d *= scale;
    const auto& [a, b, c] = t.corner;
    ASSERT_EQ(orient3d(a, b, c, d), sign) << i;
    ASSERT_EQ(orient3d(b, a, c, d), -sign) << i;
    ASSERT_EQ(orient3d(a, c, b, d), -sign) << i;
    ASSERT_EQ(orient3d(a, b, d, c), -sign) << i;
    ASSERT_EQ(orient3d(d, b, c, a), -sign) << i;
    ASSERT_EQ(orient3d(d, c, b, a), sign) << i;
  }
}

// Differences that need two doubles: the part that a subtraction rounds away decides.
TEST(Orient3d, KeepsTheTailsOfDifferences) {
  const double far = 0x1p60;
  for (const double height : {0x1p-60, -0x1p-60, 0.0}) {
    const Eigen::Vector3d a(0, 0, 0), b(far, 1, 0), c(1, far, 0), d(far, far, height);
    EXPECT_EQ(orient3d(a, b, c, d), height > 0 ? -1 : (height < 0 ? 1 : 0));
  }
}

// Each of the nine differences in its turn is the only one that a double does not hold, and the
// unit that it loses is the whole determinant.
TEST(Orient3d, KeepsTheTailOfEachDifference) {
  // Rows are a - d, b - d, c - d; at row 1 and column 0 stands 2^60 less what is lost. Its minor is
  // 1, and the rest of the determinant -2^60.
  const double big = 0x1p60, half = 0x1p30;
  const std::array<std::array<double, 3>, 3> corner{{{half, 0, 1}, {0, 0, half}, {0, 1, 0}}};
  for (std::size_t turn = 0; turn < 3; ++turn) {
    for (std::size_t shift = 0; shift < 3; ++shift) {
      for (const double lost : {0.0, 1.0, 2.0}) {
        std::array<Eigen::Vector3d, 3> p;
        for (std::size_t row = 0; row < 3; ++row) {
          for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool is_big = row == 1 && axis == 0;
            const double value = is_big ? big : corner[row][axis] + (axis == 0 ? lost : 0);
            p[(row + turn) % 3][static_cast<Eigen::Index>((axis + shift) % 3)] = value;
          }
        }
        Eigen::Vector3d d = Eigen::Vector3d::Zero();
        d[static_cast<Eigen::Index>(shift)] = lost;
        const int expected = lost > 0 ? -1 : 0;
        EXPECT_EQ(orient3d(p[0], p[1], p[2], d), expected) << turn << ' ' << shift << ' ' << lost;
        EXPECT_EQ(orient3d(p[1], p[0], p[2], d), -expected) << turn << ' ' << shift << ' ' << lost;
      }
    }
  }
}

TEST(Orient2d, AgreesWithIntegersNextToTheLine) {
  for (const int bits : {8, 24, 50}) {
    test::TriangleCases cases(0x2d, 64);
    for (int i = 0; i < kCases; ++i) {
      const std::int64_t range = std::int64_t{1} << (bits - 3);
      const Eigen::Vector3d a = cases.point(range), step = cases.point(range);
      const Eigen::Vector3d b = a + static_cast<double>(cases.integer(-3, 3)) * step;
      Eigen::Vector3d c = a + static_cast<double>(cases.integer(-3, 3)) * step;
      if (cases.integer(0, 2) != 0) c += cases.point(1);
      const test::IntVector p = difference(a, c), q = difference(b, c);
      const int expected = test::sign_of(test::Int128(p.x) * q.y - test::Int128(p.y) * q.x);
      ASSERT_EQ(orient2d(a.head<2>(), b.head<2>(), c.head<2>()), expected) << i;
    }
  }
}

TEST(Expansion, SumsAndProductsAreExact) {
  test::TriangleCases cases(0xe, 64);
  const std::int64_t range = std::int64_t{1} << 53;
  for (int i = 0; i < kCases; ++i) {
    const std::int64_t a = cases.integer(-range, range), b = cases.integer(-range, range);
    const auto x = static_cast<double>(a), y = static_cast<double>(b);
    const Rounded product = two_product(x, y);
    ASSERT_EQ(test::Int128(product.value) + test::Int128(product.error), test::Int128(a) * b);
    const Rounded sum = two_sum(x, y);
    ASSERT_EQ(test::Int128(sum.value) + test::Int128(sum.error), test::Int128(a) + b);
    const auto zero = exact_product(x, y) - exact_product(y, x);
    ASSERT_EQ(zero.size, 0u);
    // (x + y) (x - y) - x x + y y = 0, through every operation there is.
    const auto square = exact_product(x, x) - exact_product(y, y);
    const auto factored = exact_difference(x, -y) * exact_difference(x, y);
    ASSERT_EQ((factored - square).sign(), 0);
    ASSERT_EQ((factored - square + exact_product(1, 1)).sign(), 1);
  }
}

// Each axis scaled by a power of its own: no sign changes, but products of three underflow where
// expansions could not hold them.
TEST(Orient3d, AxesMayDifferByAnyPower) {
  test::TriangleCases cases(0x3a9, 64);
  std::array<int, 3> seen{};
  for (int i = 0; i < kCases; ++i) {
    const Triangle t = cases.triangle(1 << 12);
    const Eigen::Vector3d d = near_plane(cases, t);
    const auto& c = t.corner;
    const int expected =
        test::determinant_sign(difference(c[0], d), difference(c[1], d), difference(c[2], d));
    ++seen[static_cast<std::size_t>(expected + 1)];
    const auto power = [&] {
      return std::ldexp(1.0, static_cast<int>(cases.integer(-1074, i % 2 == 0 ? 180 : -1000)));
    };
    const Eigen::Vector3d scale(power(), power(), power());
    const auto scaled = [&](const Eigen::Vector3d& v) -> Eigen::Vector3d {
      return v.cwiseProduct(scale);
    };
    ASSERT_EQ(orient3d(scaled(c[0]), scaled(c[1]), scaled(c[2]), scaled(d)), expected) << i;
    const auto flat = [&](const Eigen::Vector3d& v) -> Eigen::Vector2d { return v.head<2>(); };
    const int turn = orient2d(flat(c[0]), flat(c[1]), flat(c[2]));
    ASSERT_EQ(orient2d(flat(scaled(c[0])), flat(scaled(c[1])), flat(scaled(c[2]))), turn) << i;
  }
  for (const int count : seen) EXPECT_GT(count, kCases / 10);
}

// Nothing is promised of the sign; but no walk over corrupt bytes may leave its arrays.
TEST(Orient3d, WhatIsNoNumberHasSomeSign) {
  for (const double x :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    const Eigen::Vector3d a(x, x, x), b(1, 2, 0x1p-60), c(x, 0x1p60, 3), d(0x1p-60, x, 1);
    EXPECT_LE(std::abs(orient3d_exact(a, b, c, d)), 1);
    EXPECT_LE(std::abs(orient2d_exact({x, 1}, {0x1p-60, x}, {x, 0x1p60})), 1);
  }
}

TEST(WideInteger, DifferencesAndProductsAreExact) {
  const double least = std::numeric_limits<double>::denorm_min();
  const double large = 0x1p200;
  EXPECT_EQ(wide_integer(0.0).sign(), 0);
  EXPECT_EQ(wide_integer(least).sign(), 1);
  EXPECT_EQ(wide_integer(-least).sign(), -1);
  EXPECT_EQ((wide_difference(large, least) - wide_integer(large)).sign(), -1);
  EXPECT_EQ((wide_difference(large, least) - wide_integer(large) + wide_integer(least)).sign(), 0);
  // (2^200 + 2^-1074)(2^200 - 2^-1074) = 2^400 - 2^-2148.
  const auto sum = wide_integer(large) + wide_integer(least);
  const auto product = sum * wide_difference(large, least);
  const auto square = wide_integer(large) * wide_integer(large);
  EXPECT_EQ((product - square + wide_integer(least) * wide_integer(least)).sign(), 0);
  EXPECT_EQ((product - square).sign(), -1);
  // Every place of the mantissa: two neighbours differ by one unit.
  for (int e = -1074; e <= 199; ++e) {
    const double x = std::ldexp(1.0, e);
    const double next = std::nextafter(x, large * 2);
    EXPECT_EQ((wide_difference(next, x) - wide_integer(next - x)).sign(), 0) << e;
    EXPECT_EQ((wide_integer(x) + wide_integer(x) - wide_integer(2 * x)).sign(), 0) << e;
  }
}

// Found by fuzzing scenes: coordinates of corrupt files overflow, and the terms of a product were
// one more than there was room for.
TEST(Expansion, WhatOverflowsKeepsWithinItsMemory) {
  std::mt19937_64 random(1);
  const double kinds[] = {0x1p1023,
                          -0x1.fffffffffffffp1023,
                          0x1p600,
                          -0x1p-1074,
                          1.0,
                          0.0,
                          std::numeric_limits<double>::infinity(),
                          std::numeric_limits<double>::quiet_NaN()};
  const auto any = [&] {
    return kinds[random() % std::size(kinds)] * std::ldexp(1.0, static_cast<int>(random() % 3));
  };
  for (int i = 0; i < 100000; ++i) {
    const Expansion<2> a = exact_difference(any(), any()), b = exact_product(any(), any());
    const Expansion<8> product = a * b;
    const Expansion<16> sum = product - b * a;
    ASSERT_LE((a * any()).size, 4u);
    ASSERT_LE(product.size, 8u);
    ASSERT_LE(sum.size, 16u);
    const auto point = [&] { return Eigen::Vector2d{any(), any()}; };
    static_cast<void>(orient2d(point(), point(), point()));
  }
}

}  // namespace
}  // namespace boxtree
