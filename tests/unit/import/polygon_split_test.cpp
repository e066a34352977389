// SPDX-License-Identifier: MIT
#include "cooker/import/polygon_split.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "cooker/import/polygon_normal.h"
#include "runtime/primitive/orientation.h"

namespace boxtree::cooker {
namespace {

using Eigen::Vector3d;
using Polygon = std::vector<Vector3d>;

bool keeps(const std::array<Vector3d, 4>& corners) {
  std::array<RoundedCorner, 4> rounded;
  for (std::size_t i = 0; i < 4; ++i) {
    rounded[i] = {corners[i], corners[i].cwiseAbs() * 0x1p-24};
  }
  return is_planar_convex_quad(rounded);
}

Vector3d as_float(const Vector3d& v) {
  return v.cast<float>().cast<double>();
}

double area_of(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return (b - a).cross(c - a).norm() / 2;
}

double newell_area(const Polygon& polygon) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    sum += polygon[i].cross(polygon[(i + 1) % polygon.size()]);
  }
  return sum.norm() / 2;
}

// What holds for every polygon: n - 2 triangles, every edge of the outline once and every inner
// edge twice, in opposite directions.
void expect_whole(const Polygon& polygon, std::span<const PolygonSplitter::Triangle> triangles) {
  ASSERT_EQ(triangles.size(), polygon.size() - 2);
  std::multiset<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (const auto& t : triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      ASSERT_LT(t[i], polygon.size());
      edges.insert({t[i], t[(i + 1) % 3]});
    }
  }
  const auto count = static_cast<std::uint32_t>(polygon.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    const auto edge = edges.find({i, (i + 1) % count});
    ASSERT_NE(edge, edges.end()) << "outline edge " << i;
    edges.erase(edge);
  }
  for (const auto& [from, to] : edges) ASSERT_EQ(edges.count({to, from}), edges.count({from, to}));
}

double split_area(const Polygon& polygon) {
  PolygonSplitter splitter;
  const auto triangles = splitter.split(polygon);
  expect_whole(polygon, triangles);
  double area = 0;
  for (const auto& t : triangles) area += area_of(polygon[t[0]], polygon[t[1]], polygon[t[2]]);
  return area;
}

// A simple polygon: the triangles overlap nowhere, so their areas add up to its own.
void expect_covered(const Polygon& polygon) {
  EXPECT_NEAR(split_area(polygon), newell_area(polygon), 1e-12 * newell_area(polygon));
}

TEST(QuadTest, PlanarConvexStays) {
  EXPECT_TRUE(keeps({Vector3d(0, 0, 0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_TRUE(keeps({Vector3d(0, 0, 0), {0, 1, 0}, {1, 1, 0}, {1, 0, 0}})) << "clockwise";
  EXPECT_TRUE(keeps({Vector3d(0, 0, 0), {2, 0, 0}, {1, 1, 0}, {0, 2, 0}})) << "flat corner";
}

TEST(QuadTest, ConcaveAndCrossedDoNot) {
  EXPECT_FALSE(keeps({Vector3d(0, 0, 0), {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}}));
  EXPECT_FALSE(keeps({Vector3d(0, 0, 0), {1, 1, 0}, {1, 0, 0}, {0, 1, 0}})) << "bow tie, no area";
  EXPECT_FALSE(keeps({Vector3d(0, 0, 0), {3, 1, 0}, {1, 0, 0}, {0, 1, 0}})) << "bow tie";
  EXPECT_FALSE(keeps({Vector3d(0, 0, 0), {2, 0, 0}, {1, 0, 0}, {1, 1, 0}})) << "spike";
}

TEST(QuadTest, BentIsNotPlanarHoweverLittle) {
  // 2^-20 of the size is 16 times what rounding to f32 explains.
  EXPECT_FALSE(keeps({Vector3d(0, 0, 0), {1, 0, 0}, {1, 1, 0x1p-20}, {0, 1, 0}}));
  EXPECT_TRUE(keeps({Vector3d(0, 0, 0), {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  // Far from the origin the grid of f32 is coarser: half a unit at 1024 is 2^-14.
  EXPECT_TRUE(keeps({Vector3d(0, 0, 1024), {1, 0, 1024}, {1, 1, 1024 + 0x1p-13}, {0, 1, 1024}}));
  EXPECT_FALSE(keeps({Vector3d(0, 0, 1024), {1, 0, 1024}, {1, 1, 1024 + 0x1p-9}, {0, 1, 1024}}));
}

TEST(QuadTest, DegenerateStays) {
  EXPECT_TRUE(keeps({Vector3d(0, 0, 0), {1, 0, 0}, {1, 0, 0}, {0, 1, 0}})) << "repeated corner";
  EXPECT_TRUE(keeps({Vector3d(1, 1, 1), {1, 1, 1}, {1, 1, 1}, {1, 1, 1}})) << "point";
  EXPECT_TRUE(keeps({Vector3d(0, 0, 0), {3, 3, 3}, {1, 1, 1}, {2, 2, 2}})) << "segment";
}

// Planar quads stay planar through any rotation, size and place once rounded to f32; the same quads
// bent by 64 times the rounding do not.
TEST(QuadTest, RoundingIsExplainedAndNoMore) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 20'000; ++i) {
    const double size = std::exp(8 * unit(random));
    const Vector3d center = 4 * size * Vector3d(unit(random), unit(random), unit(random));
    const Vector3d u = Vector3d(unit(random), unit(random), unit(random)).normalized();
    const Vector3d v = u.cross(Vector3d(unit(random), unit(random), unit(random))).normalized();
    std::array<Vector3d, 4> quad;
    for (std::size_t k = 0; k < 4; ++k) {
      const double angle = std::numbers::pi / 2 * (static_cast<double>(k) + 0.3 * unit(random));
      quad[k] = center + size * (std::cos(angle) * u + std::sin(angle) * v);
    }
    std::array<Vector3d, 4> rounded = quad;
    for (Vector3d& corner : rounded) corner = as_float(corner);
    ASSERT_TRUE(keeps(rounded)) << "case " << i;
    quad[2] += u.cross(v) * size * 0x1p-24 * 64 * 5;
    for (Vector3d& corner : quad) corner = as_float(corner);
    ASSERT_FALSE(keeps(quad)) << "case " << i;
  }
}

TEST(QuadTest, AnySizeOfDoubles) {
  for (const double size : {1e-300, 1e-150, 1.0, 1e150, 1e300}) {
    const auto is_kept = [size](double bend) {
      std::array<RoundedCorner, 4> quad = {{{{0, 0, 0}, {0, 0, 0}},
                                            {{size, 0, 0}, {0, 0, 0}},
                                            {{size, size, bend * size}, {0, 0, 0}},
                                            {{0, size, 0}, {0, 0, 0}}}};
      return is_planar_convex_quad(quad);
    };
    EXPECT_TRUE(is_kept(0)) << size;
    EXPECT_FALSE(is_kept(1e-6)) << size;
    EXPECT_FALSE(is_collinear({0, 0, 0}, {size, 0, 0}, {0, size, 0})) << size;
    EXPECT_TRUE(is_collinear({0, 0, 0}, {size, size, size}, {size / 2, size / 2, size / 2}));
  }
}

TEST(PolygonSplit, Quads) {
  PolygonSplitter splitter;
  const auto split = [&splitter](const Polygon& polygon) {
    const auto triangles = splitter.split(polygon);
    return std::vector<PolygonSplitter::Triangle>(triangles.begin(), triangles.end());
  };
  using Triangles = std::vector<PolygonSplitter::Triangle>;
  EXPECT_EQ(split({{0, 0, 0}, {1, 0, 0}, {1, 1, 0.5}, {0, 1, 0}}),
            (Triangles{{0, 1, 2}, {0, 2, 3}}));
  // The diagonal starts at the reflex corner.
  const Polygon dart = {{0, 0, 0}, {2, 0, 0}, {0.5, 0.5, 0}, {0, 2, 0}};
  EXPECT_EQ(split(dart), (Triangles{{0, 1, 2}, {0, 2, 3}}));
  EXPECT_EQ(split({dart[1], dart[2], dart[3], dart[0]}), (Triangles{{1, 2, 3}, {0, 1, 3}}));
}

TEST(PolygonSplit, ConvexConcaveAndCollinear) {
  Polygon circle, star, comb;
  for (int i = 0; i < 40; ++i) {
    const double angle = i * std::numbers::pi / 20, radius = i % 2 == 0 ? 1 : 0.3;
    circle.push_back({std::cos(angle), 2, std::sin(angle)});
    star.push_back({radius * std::cos(angle), radius * std::sin(angle), radius * std::cos(angle)});
  }
  for (int i = 0; i < 10; ++i) {
    comb.push_back({2.0 * i, 0, 1});
    comb.push_back({2.0 * i, 5, 1});
    comb.push_back({2.0 * i + 1, 5, 1});
    comb.push_back({2.0 * i + 1, 0, 1});
  }
  comb.push_back({19, -1, 1});
  comb.push_back({0, -1, 1});
  expect_covered(circle);
  expect_covered(star);
  expect_covered(comb);
  std::reverse(comb.begin(), comb.end());
  expect_covered(comb);
  expect_covered(
      {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}});
  expect_covered({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}, {2, 3, 0}});
}

TEST(PolygonSplit, HoleOnABridge) {
  // A square with a square hole, joined by a bridge that is walked twice.
  expect_covered({{0, 0, 0},
                  {4, 0, 0},
                  {4, 4, 0},
                  {0, 4, 0},
                  {0, 0, 0},
                  {1, 1, 0},
                  {1, 3, 0},
                  {3, 3, 0},
                  {3, 1, 0},
                  {1, 1, 0}});
  // The hole touches the outline at a corner that is the tip of a would-be ear.
  expect_covered({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0}, {0, 0, 0}, {1, 2, 0}, {2, 1, 0}});
}

TEST(PolygonSplit, DegenerateStillCoversEveryEdge) {
  split_area({{0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  split_area({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {5, 5, 5}, {3, 3, 3}});
  split_area({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}});
  Polygon pentagram;
  for (int i = 0; i < 5; ++i) {
    const double angle = i * 4 * std::numbers::pi / 5;
    pentagram.push_back({std::cos(angle), std::sin(angle), 0});
  }
  split_area(pentagram);
}

// Star-shaped polygons with random radii, in random planes, with corners repeated and put on edges.
TEST(PolygonSplit, RandomSimplePolygons) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 3000; ++i) {
    const auto any = [&] { return Vector3d(unit(random), unit(random), unit(random) - 0.5); };
    const Vector3d u = any().normalized();
    const Vector3d v = u.cross(any()).normalized();
    const int count = 5 + static_cast<int>(random() % 40);
    Polygon polygon;
    for (int k = 0; k < count; ++k) {
      const double angle = 2 * std::numbers::pi * k / count, radius = 0.1 + unit(random);
      polygon.push_back(radius * (std::cos(angle) * u + std::sin(angle) * v));
      if (random() % 8 == 0) polygon.push_back(polygon.back());
    }
    ASSERT_NO_FATAL_FAILURE(expect_covered(polygon)) << "case " << i;
  }
}

// Random closed walks: crossing, touching, doubling back. Only what holds for all is tested.
TEST(PolygonSplit, RandomWalksOnAGrid) {
  std::mt19937 random(13);
  for (int i = 0; i < 5000; ++i) {
    Polygon polygon(5 + random() % 12);
    for (Vector3d& corner : polygon) {
      corner = {static_cast<double>(random() % 4), static_cast<double>(random() % 4), 0};
    }
    ASSERT_NO_FATAL_FAILURE(split_area(polygon)) << "case " << i;
  }
}

TEST(PolygonSplit, ManyCornersEnd) {
  // Teeth of three corners: clipping every other corner without looking would cut into them.
  Polygon comb;
  constexpr int kTeeth = 4000;
  for (int i = 0; i < kTeeth; ++i) {
    comb.push_back({3.0 * i, 0, 0});
    comb.push_back({3.0 * i + 1, 100, 0});
    comb.push_back({3.0 * i + 2, 100, 0});
  }
  comb.push_back({3.0 * kTeeth, -1, 0});
  comb.push_back({0, -1, 0});
  // Covered once, so it took fewer than kMaxTests: beyond them ears are clipped without looking.
  expect_covered(comb);
}

// 40 000 corners that were looked at again for each one clipped took 14 s: now each is looked at
// when its neighbours change. Counted by what it gives; the test's time limit is its bound.
TEST(PolygonSplit, LongLinesAreSplitToo) {
  constexpr std::uint32_t kCorners = 40000;
  std::vector<Eigen::Vector3d> line, spiral;
  for (std::uint32_t i = 0; i < kCorners; ++i) line.emplace_back(i, 0, 0);
  for (std::uint32_t i = 0; i < kCorners / 2; ++i) {
    const double turn = 0.05 * i;
    spiral.emplace_back(turn * std::cos(turn), turn * std::sin(turn), 0);
  }
  for (std::uint32_t i = kCorners / 2; i-- > 0;) {
    const double turn = 0.05 * i;
    spiral.emplace_back((turn + 1) * std::cos(turn), (turn + 1) * std::sin(turn), 0);
  }
  PolygonSplitter splitter;
  for (const auto& corners : {line, spiral}) {
    const auto triangles = splitter.split(corners);
    ASSERT_EQ(triangles.size(), kCorners - 2);
    // Each edge of the polygon is one of a triangle, in the polygon's direction.
    std::vector<bool> is_there(kCorners, false);
    for (const PolygonSplitter::Triangle& triangle : triangles) {
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t from = triangle[k], to = triangle[(k + 1) % 3];
        if (to == (from + 1) % kCorners) is_there[from] = true;
      }
    }
    EXPECT_EQ(std::count(is_there.begin(), is_there.end(), false), 0);
  }
}

// Found by tests/import_oracle: two simple polygons that look along x; the sums of products along z
// have terms of 1e72 and 1e65 that leave nothing of the rest.
TEST(PolygonSplit, SizesOfAllFloatsBesideEachOther) {
  const Polygon polygons[] = {
      {{-1.761108664929747e+19, 9.999999680285692e+37, -4.86989118874583e+16},
       {5.0, -7.698565607184826e-39, 1.0},
       {-5.142526717195398e+34, 1.5046851810486649e+19, 0.0},
       {1.9373735996430618e-39, 4.8939395983588495e-39, 9.688619621295715e-40},
       {5.0, -3.42867206200026e-05, -0.0}},
      {{1e+23, 1e+23, 9.486848911703125e+42},
       {9.586399684720747e-07, 0.0, 1000.0},
       {-6.012546416333867e-39, 6274184081.974787, -378549678822.0396},
       {1.0, 3.4028235677973366e+38, -7.5},
       {-0.0, 261.7002179325145, 25605695430.0}}};
  for (const Polygon& polygon : polygons) {
    EXPECT_EQ(dominant_axis(polygon_normal(polygon)), 0);
    PolygonSplitter splitter;
    const auto triangles = splitter.split(polygon);
    expect_whole(polygon, triangles);
    // Seen along x all turn as the polygon does: counter-clockwise.
    for (const auto& t : triangles) {
      const auto seen = [&](std::uint32_t i) {
        return Eigen::Vector2d(polygon[i][1], polygon[i][2]);
      };
      EXPECT_GE(orient2d(seen(t[0]), seen(t[1]), seen(t[2])), 0);
    }
  }
}

// Against sums of 128 bits: coordinates are multiples of 2^-20 up to 2^33.
TEST(PolygonNormal, AgainstLongIntegers) {
  __extension__ using Long = __int128;
  std::mt19937 random(5);
  std::size_t misled = 0;  // polygons of which doubles alone say something else
  for (int i = 0; i < 50'000; ++i) {
    Polygon polygon(3 + random() % 6);
    // Along a line, but for one unit here and there; every other one anywhere.
    const auto long_number = [&random] {
      return static_cast<double>((std::uint64_t{random()} << 17 | random() >> 15)) * 0x1p-20;
    };
    const Vector3d along(long_number(), long_number(), long_number());
    for (Vector3d& corner : polygon) {
      corner = along * static_cast<double>(random() % 15);
      corner[static_cast<int>(random() % 3)] +=
          (static_cast<double>(random() % 3) - 1) * (i % 2 == 0 ? 0x1p-20 : 0x1p20);
    }
    std::array<double, 3> exact{};
    Vector3d plain = Vector3d::Zero();
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      const auto units = [](double x) { return static_cast<Long>(std::ldexp(x, 20)); };
      Long sum = 0;
      for (std::size_t k = 0; k < polygon.size(); ++k) {
        const Vector3d &a = polygon[k], &b = polygon[(k + 1) % polygon.size()];
        sum += units(a[u]) * units(b[v]) - units(a[v]) * units(b[u]);
        plain[axis] += a[u] * b[v] - a[v] * b[u];
      }
      exact[static_cast<std::size_t>(axis)] = static_cast<double>(sum);
    }
    const double largest = std::max({std::abs(exact[0]), std::abs(exact[1]), std::abs(exact[2])});
    const auto is_right = [&](const Vector3d& normal) {
      const int axis = dominant_axis(normal);
      const double there = exact[static_cast<std::size_t>(axis)];
      return 2 * std::abs(there) >= largest && (normal[axis] > 0) == (there > 0) &&
             (normal[axis] < 0) == (there < 0);
    };
    ASSERT_TRUE(is_right(polygon_normal(polygon))) << i;
    misled += is_right(plain) ? 0u : 1u;
  }
  EXPECT_GT(misled, 10u);
}

TEST(CornerSet, FindsTheNextOneAround) {
  std::mt19937_64 random(7);
  for (const std::uint32_t count : {1u, 2u, 63u, 64u, 65u, 4096u, 4097u, 300000u}) {
    CornerSet set;
    std::set<std::uint32_t> expected;
    set.reset(count, true);
    EXPECT_EQ(set.next_around(count - 1), count - 1);
    set.reset(count, false);
    EXPECT_EQ(set.next_around(0), CornerSet::kNone);
    for (int i = 0; i < 3000; ++i) {
      const auto number = static_cast<std::uint32_t>(random() % count);
      if (random() % 2 == 0) {
        set.insert(number);
        expected.insert(number);
      } else {
        set.erase(number);
        expected.erase(number);
      }
      const auto from = static_cast<std::uint32_t>(random() % count);
      auto next = expected.lower_bound(from);
      if (next == expected.end()) next = expected.begin();
      ASSERT_EQ(set.next_around(from), next == expected.end() ? CornerSet::kNone : *next);
    }
  }
}

}  // namespace
}  // namespace boxtree::cooker
