// SPDX-License-Identifier: MIT
// triangle_intersects_box: exact, touching included, for shapes of any size and place.
#include "runtime/primitive/triangle_box.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <tests/unit/primitive/exact_simplex.h>
#include <tests/unit/primitive/triangle_cases.h>
#include <vector>

#include <gtest/gtest.h>

namespace boxtree {
namespace {

struct BoxCase {
  Triangle triangle;
  Eigen::Vector3d low;
  Eigen::Vector3d high;
};

// Separating axes in exact integers, all of them: 3 of the box, 9 edge products, and normals.
bool exactly_apart(const BoxCase& c) {
  using test::Int128;
  std::vector<std::array<Int128, 3>> points;
  for (const auto& corner : c.triangle.corner) {
    const test::IntVector v = test::to_integer(corner);
    points.push_back({v.x, v.y, v.z});
  }
  const test::IntVector low = test::to_integer(c.low), high = test::to_integer(c.high);
  for (int i = 0; i < 8; ++i) {
    points.push_back({i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z});
  }
  const auto apart_along = [&points](const std::array<Int128, 3>& axis) {
    std::array<Int128, 2> least{}, most{};
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Int128 p = axis[0] * points[i][0] + axis[1] * points[i][1] + axis[2] * points[i][2];
      const std::size_t shape = i < 3 ? 0 : 1;
      if (i == 0 || i == 3 || p < least[shape]) least[shape] = p;
      if (i == 0 || i == 3 || p > most[shape]) most[shape] = p;
    }
    return least[0] > most[1] || least[1] > most[0];
  };
  const auto cross = [](const std::array<Int128, 3>& a,
                        const std::array<Int128, 3>& b) -> std::array<Int128, 3> {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
  };
  std::array<std::array<Int128, 3>, 3> edge;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) edge[i][k] = points[(i + 1) % 3][k] - points[i][k];
  }
  bool apart = apart_along(cross(edge[0], edge[1]));
  for (std::size_t k = 0; k < 3; ++k) {
    std::array<Int128, 3> unit{};
    unit[k] = 1;
    apart = apart || apart_along(unit);
    for (const auto& e : edge) apart = apart || apart_along(cross(unit, e));
  }
  return apart;
}

BoxCase random_case(test::TriangleCases& cases, std::int64_t range, std::int64_t box) {
  BoxCase c;
  const std::int64_t kind = cases.integer(0, 9);
  c.triangle = kind < 6 ? cases.degenerate(kind, range / 8) : cases.triangle(range);
  c.low = cases.point(range);
  c.high = c.low + cases.point(box).cwiseAbs();
  // Usually put a box corner or edge on or next to a lattice point of the triangle's plane.
  const auto& t = c.triangle.corner;
  if (cases.integer(0, 3) != 0) {
    const auto i = static_cast<double>(cases.integer(0, 2));
    const auto j = static_cast<double>(cases.integer(0, 2));
    // An eighth of the edges, so that lattice points fall inside.
    const Eigen::Vector3d e = ((t[1] - t[0]) / 8).array().floor();
    const Eigen::Vector3d f = ((t[2] - t[0]) / 8).array().floor();
    c.triangle.corner[1] = t[0] + 8 * e;
    c.triangle.corner[2] = t[0] + 8 * f;
    Eigen::Vector3d touched = t[0] + i * e + j * f;
    if (cases.integer(0, 1) == 0) touched += cases.point(1);
    const Eigen::Vector3d extent = c.high - c.low;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const std::int64_t side = cases.integer(0, 2);
      c.low[k] =
          side == 0 ? touched[k]
                    : (side == 1 ? touched[k] - extent[k] : touched[k] - std::floor(extent[k] / 2));
    }
    c.high = c.low + extent;
  }
  return c;
}

TEST(TriangleBox, AgreesWithIntegers) {
  int intersecting = 0;
  for (const int bits : {4, 12, 20, 36}) {
    const std::int64_t range = std::int64_t{1} << bits;
    test::TriangleCases cases(0xb0c5 + static_cast<std::uint64_t>(bits), 64);
    for (int i = 0; i < 20000; ++i) {
      const BoxCase c = random_case(cases, range, i % 2 == 0 ? range / 2 : 3);
      const bool expected = !exactly_apart(c);
      intersecting += expected;
      ASSERT_EQ(triangle_intersects_box(c.triangle, c.low, c.high), expected)
          << bits << " bits, case " << i;
    }
  }
  EXPECT_GT(intersecting, 20000);
}

// The integer oracle above is separating axes, too; this one is not.
TEST(TriangleBox, AgreesWithHullOfDifferences) {
  test::TriangleCases cases(0xcafe, 64);
  for (int i = 0; i < 2000; ++i) {
    const BoxCase c = random_case(cases, 8, 3);
    std::array<test::IntVector, 3> triangle;
    for (std::size_t k = 0; k < 3; ++k) triangle[k] = test::to_integer(c.triangle.corner[k]);
    const test::IntVector low = test::to_integer(c.low), high = test::to_integer(c.high);
    std::array<test::IntVector, 8> box;
    for (std::size_t k = 0; k < 8; ++k) {
      box[k] = {k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z};
    }
    const bool expected = test::hulls_intersect(triangle, box);
    ASSERT_EQ(!exactly_apart(c), expected) << i;
    ASSERT_EQ(triangle_intersects_box(c.triangle, c.low, c.high), expected) << i;
  }
}

// Arbitrary doubles far from the origin: a box that has a corner of the triangle on its surface.
TEST(TriangleBox, TouchingCornersAreFoundAtAnyScale) {
  std::mt19937_64 random(0x70c4);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 20000; ++i) {
    const double scale = std::ldexp(1.0, static_cast<int>(random() % 380) - 190);
    const Eigen::Vector3d offset = scale * 1000 * Eigen::Vector3d(unit(random), 0, unit(random));
    const auto point = [&]() -> Eigen::Vector3d {
      const double x = unit(random), y = unit(random);
      return offset + scale * Eigen::Vector3d(x, y, unit(random));
    };
    const Triangle t{{point(), point(), point()}};
    Eigen::Vector3d low = t.corner[random() % 3], high = low;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const std::uint64_t side = random() % 3;
      if (side == 0) low[k] -= scale * std::abs(unit(random));
      if (side == 1) high[k] += scale * std::abs(unit(random));
    }
    ASSERT_TRUE(triangle_intersects_box(t, low, high)) << i;
  }
}

// A point that lies off a needle by 5e-11: rounded axes cannot tell.
TEST(TriangleBox, PointBesideNeedleIsOutside) {
  const auto f = [](float x) { return static_cast<double>(x); };
  const Triangle needle{{{{f(0.449580342f), f(0.0254973192f), f(0.995158195f)},
                          {f(-0.392861456f), f(0.944356561f), f(-0.267133474f)},
                          {f(0.437879264f), f(0.0382597372f), f(0.977625728f)}}}};
  const Eigen::Vector3d point(0.14530125936476984, 0.35737735792912168, 0.53923483493778979);
  EXPECT_FALSE(triangle_intersects_box(needle, point, point));
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(1e-10);
  EXPECT_TRUE(triangle_intersects_box(needle, point - margin, point + margin));
}

// Products of the least numbers underflow in expansions; signs are exact all the same.
TEST(TriangleBox, LeastNumbersBesideLargeOnes) {
  const double least = std::numeric_limits<double>::denorm_min();
  for (const double large : {1.0, 0x1p15, 0x1p200}) {
    // A plane that passes the origin at the least distance there is.
    const Triangle above{{{{large, 0, least}, {-large, large, least}, {-large, -large, least}}}};
    const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
    EXPECT_FALSE(triangle_intersects_box(above, zero, zero));
    EXPECT_TRUE(triangle_intersects_box(above, zero, {0, 0, least}));
    // A slanted one through it, and boxes that touch it or lie off by the least number.
    const Triangle through{
        {{{large, 0, large}, {-large, large, -large}, {-large, -large, -large}}}};
    EXPECT_TRUE(triangle_intersects_box(through, {-least, -least, -least}, {least, least, least}));
    EXPECT_TRUE(triangle_intersects_box(through, {least, 0, least}, {least, 0, least}));
    EXPECT_FALSE(triangle_intersects_box(through, {least, 0, -least}, {least, 0, -least}));
    EXPECT_FALSE(triangle_intersects_box(through, {0, -least, least}, {0, least, 2 * least}));
    // Beside an edge that runs through the origin.
    const Triangle beside{{{{-large, -large, 0}, {large, large, 0}, {large, -large, 0}}}};
    EXPECT_TRUE(triangle_intersects_box(beside, {least, least, 0}, {least, least, 0}));
    EXPECT_TRUE(triangle_intersects_box(beside, {least, -least, 0}, {least, -least, 0}));
    EXPECT_FALSE(triangle_intersects_box(beside, {-least, least, 0}, {-least, least, 0}));
    EXPECT_FALSE(triangle_intersects_box(beside, {-least, 0, 0}, {-least, large, 0}));
  }
}

}  // namespace
}  // namespace boxtree
