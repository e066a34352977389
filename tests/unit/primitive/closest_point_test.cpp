// SPDX-License-Identifier: MIT
// closest_point_on_triangle against extended precision, against sampling, and on degenerate
// triangles (R13, R16) against the segment that is left.
#include "runtime/primitive/closest_point.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <tests/unit/primitive/triangle_cases.h>

#include <gtest/gtest.h>

namespace boxtree {
namespace {

using LongVector = Eigen::Matrix<long double, 3, 1>;

constexpr double kUlp = std::numeric_limits<double>::epsilon();

LongVector widen(const Eigen::Vector3d& v) {
  return v.cast<long double>();
}

LongVector closest_on_segment(const LongVector& p, const LongVector& a, const LongVector& b) {
  const LongVector edge = b - a;
  const long double squared = edge.dot(edge);
  if (squared == 0) return a;
  return a + std::clamp((p - a).dot(edge) / squared, 0.0L, 1.0L) * edge;
}

LongVector cross(const LongVector& a, const LongVector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Best of the three segments and, if its foot is inside, of the plane: no regions, no shortcuts.
LongVector reference(const Eigen::Vector3d& point, const Triangle& t) {
  const LongVector p = widen(point);
  const std::array<LongVector, 3> c = {widen(t.corner[0]), widen(t.corner[1]), widen(t.corner[2])};
  LongVector best = c[0];
  const auto consider = [&](const LongVector& q) {
    if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
  };
  for (std::size_t i = 0; i < 3; ++i) consider(closest_on_segment(p, c[i], c[(i + 1) % 3]));
  const LongVector n = cross(c[1] - c[0], c[2] - c[0]);
  bool inside = n.squaredNorm() > 0;
  for (std::size_t i = 0; i < 3; ++i) {
    inside = inside && cross(c[(i + 1) % 3] - c[i], p - c[i]).dot(n) >= 0;
  }
  if (inside) consider(p - (n.dot(p - c[0]) / n.squaredNorm()) * n);
  return best;
}

// For collinear corners, where a plane's foot would be noise in extended precision, too.
LongVector reference_of_segments(const Eigen::Vector3d& point, const Triangle& t) {
  const LongVector p = widen(point);
  LongVector best = widen(t.corner[0]);
  for (std::size_t i = 0; i < 3; ++i) {
    const LongVector q = closest_on_segment(p, widen(t.corner[i]), widen(t.corner[(i + 1) % 3]));
    if ((q - p).squaredNorm() < (best - p).squaredNorm()) best = q;
  }
  return best;
}

double max_abs_of(const Eigen::Vector3d& p, const Triangle& t) {
  double max_abs = p.cwiseAbs().maxCoeff();
  for (const auto& c : t.corner) max_abs = std::max(max_abs, c.cwiseAbs().maxCoeff());
  return max_abs;
}

double distance(const Eigen::Vector3d& a, const LongVector& b) {
  return static_cast<double>((widen(a) - b).norm());
}

struct Source {
  std::mt19937_64 random;
  std::uniform_real_distribution<double> unit{-1, 1};

  Eigen::Vector3d point() {
    const double x = unit(random), y = unit(random);
    return {x, y, unit(random)};
  }
  Triangle triangle() { return {{point(), point(), point()}}; }
  // A height of 2^-k times the longest edge: needles and caps.
  Triangle sliver(int k) {
    Triangle t = triangle();
    const double along = random() % 2 == 0 ? std::abs(unit(random)) : 0;
    t.corner[2] = t.corner[0] + along * (t.corner[1] - t.corner[0]) + std::ldexp(1.0, -k) * point();
    std::shuffle(t.corner.begin(), t.corner.end(), random);
    return t;
  }
};

TEST(ClosestPoint, AgreesWithExtendedPrecision) {
  Source source{std::mt19937_64(0xc105)};
  for (int i = 0; i < 20000; ++i) {
    const Triangle t = source.triangle();
    const Eigen::Vector3d p = 2 * source.point();
    const LongVector n = cross(widen(t.corner[1] - t.corner[0]), widen(t.corner[2] - t.corner[0]));
    // Triangles of a height above 1/50 or so; slivers have a test of their own.
    if (n.norm() < 0.05L) continue;
    ASSERT_LE(distance(closest_point_on_triangle(p, t), reference(p, t)), 1e-12) << i;
  }
}

// The point itself may slide along a sliver by the rounding of its corners over its height, but
// the distance, which is what queries compare, may not.
TEST(ClosestPoint, DistanceIsAccurateForSlivers) {
  Source source{std::mt19937_64(0x51e)};
  for (int i = 0; i < 40000; ++i) {
    const Triangle t = source.sliver(i % 60);
    const Eigen::Vector3d p = source.point();
    const Eigen::Vector3d q = closest_point_on_triangle(p, t);
    const double expected = distance(p, reference(p, t));
    ASSERT_NEAR(distance(p, widen(q)), expected, 8 * kUlp * max_abs_of(p, t)) << i;
    ASSERT_LE(distance(q, reference(q, t)), 4 * kUlp * max_abs_of(p, t))
        << "off the triangle " << i;
  }
}

TEST(ClosestPoint, NoSampleIsCloser) {
  Source source{std::mt19937_64(0x5a3)};
  for (int i = 0; i < 500; ++i) {
    const Triangle t = i % 2 == 0 ? source.triangle() : source.sliver(i % 20);
    const Eigen::Vector3d p = source.point();
    const double found = (closest_point_on_triangle(p, t) - p).norm();
    constexpr int kSteps = 40;
    for (int u = 0; u <= kSteps; ++u) {
      for (int v = 0; u + v <= kSteps; ++v) {
        const Eigen::Vector3d sample =
            (u * t.corner[0] + v * t.corner[1] + (kSteps - u - v) * t.corner[2]) / kSteps;
        ASSERT_LE(found, (sample - p).norm() + 1e-14) << i;
      }
    }
  }
}

// R16: within 4 ulp of the segment's answer, for all six kinds of degenerate triangle.
TEST(ClosestPoint, DegenerateTrianglesAreSegments) {
  test::TriangleCases cases(0xde6, 64);
  for (int i = 0; i < 60000; ++i) {
    Triangle t = cases.degenerate(i % 6, i % 4 == 0 ? 3 : 1 << 20);
    Eigen::Vector3d p = cases.point(1 << 21);
    const double scale = std::ldexp(1.0, static_cast<int>(cases.integer(-60, 60)));
    for (auto& c : t.corner) c *= scale;
    p *= scale;
    const Eigen::Vector3d q = closest_point_on_triangle(p, t);
    ASSERT_LE(distance(q, reference(p, t)), 4 * kUlp * max_abs_of(p, t)) << i;
  }
}

// Collinear corners whose differences round, so that their cross product is noise, not zero.
TEST(ClosestPoint, NoiseIsNotTakenForAnArea) {
  test::TriangleCases cases(0x2015e, 64);
  const std::int64_t range = std::int64_t{1} << 49;
  int noisy = 0;
  for (int i = 0; i < 40000; ++i) {
    const Eigen::Vector3d direction = cases.point(7);
    Triangle t;
    for (auto& c : t.corner) {
      const int exponent = static_cast<int>(cases.integer(-6, 0));
      c = std::ldexp(static_cast<double>(cases.integer(-range, range)), exponent) * direction;
    }
    const LongVector n = cross(widen(t.corner[1] - t.corner[0]), widen(t.corner[2] - t.corner[0]));
    noisy += n.squaredNorm() > 0;
    // On the line, even the areas with the point are of the order of the noise.
    Eigen::Vector3d p = 4 * cases.point(range);
    if (i % 4 != 0) p = static_cast<double>(cases.integer(-range, range)) * direction;
    const Eigen::Vector3d q = closest_point_on_triangle(p, t);
    ASSERT_LE(distance(q, reference_of_segments(p, t)), 4 * kUlp * max_abs_of(p, t)) << i;
  }
  EXPECT_GT(noisy, 10000);
}

// The foot of the perpendicular is known; only its distance to the three corners differs.
TEST(ClosestPoint, PointsAboveNeedlesProjectIntoThem) {
  Source source{std::mt19937_64(0x4eed1e)};
  for (int i = 0; i < 60000; ++i) {
    const int thinness = i % 50;
    Triangle t = source.triangle();
    t.corner[2] = t.corner[1] + std::ldexp(1.0, -thinness) * source.point();
    std::rotate(t.corner.begin(), t.corner.begin() + i % 3, t.corner.end());
    const double u = 0.1 + 0.3 * std::abs(source.unit(source.random));
    const double v = 0.1 + 0.3 * std::abs(source.unit(source.random));
    const Eigen::Vector3d p =
        (1 - u - v) * t.corner[0] + u * t.corner[1] + v * t.corner[2];  // in the plane, nearly
    const Eigen::Vector3d q = closest_point_on_triangle(p, t);
    ASSERT_LE((p - q).norm(), 8 * kUlp * max_abs_of(p, t)) << i << ", 2^-" << thinness;
  }
}

// Weights made of areas are noise in a needle with a sine of 2e-7: they gave 1.75e-9 for 1.6e-18.
TEST(ClosestPoint, PointOnAnF32NeedleIsThere) {
  const Triangle needle{{{{-0x1.653c92p-1, -0x1.dca2c0p-1, 0x1.d9c93ep-1},
                          {0x1.cf2d7cp-1, 0x1.7b47c4p-1, -0x1.e0881cp-1},
                          {0x1.d1bacep-4, -0x1.59a3e8p-4, -0x1.2f3040p-6}}}};
  const Eigen::Vector3d p(-0.1798261320874685, -0.39061641377862116, 0.32293281964430331);
  for (int i = 0; i < 3; ++i) {
    Triangle turned = needle;
    std::rotate(turned.corner.begin(), turned.corner.begin() + i, turned.corner.end());
    EXPECT_LE((closest_point_on_triangle(p, turned) - p).norm(), 4 * kUlp);
  }
}

// A face of size 2^-k beside coordinates of any other size has an interior like any other. Scaled
// by a power of two, the answer is scaled by it, to the bit.
TEST(ClosestPoint, TinyTrianglesHaveAnInterior) {
  Source source{std::mt19937_64(0x717)};
  for (int i = 0; i < 20000; ++i) {
    const Triangle t = i % 2 == 0 ? source.triangle() : source.sliver(i % 30);
    const Eigen::Vector3d p = source.point();
    const Eigen::Vector3d expected = closest_point_on_triangle(p, t);
    const int exponent = static_cast<int>(source.random() % 1080) - 900;
    const double scale = std::ldexp(1.0, exponent);
    Triangle scaled = t;
    for (auto& c : scaled.corner) c *= scale;
    const Eigen::Vector3d found = closest_point_on_triangle(p * scale, scaled);
    // Triangles with very short edges are moved to the origin first, which rounds once more.
    const double off = exponent < -400 ? 8 * kUlp * scale : 0;
    ASSERT_LE((found - expected * scale).cwiseAbs().maxCoeff(), off) << i << ", 2^" << exponent;
  }
}

// One edge far shorter than the others, down to the least number: a segment to within rounding.
TEST(ClosestPoint, OneVeryShortEdge) {
  Source source{std::mt19937_64(0x5e)};
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d a = source.point(), b = source.point();
    const double shortness = std::ldexp(1.0, -60 - static_cast<int>(source.random() % 1014));
    const Eigen::Vector3d origin = i % 2 == 0 ? a : Eigen::Vector3d::Zero();
    Triangle t{{origin, origin + shortness * source.point(), b}};
    std::rotate(t.corner.begin(), t.corner.begin() + i % 3, t.corner.end());
    const Eigen::Vector3d p =
        i % 5 == 0 ? Eigen::Vector3d(origin + 0.3 * (b - origin)) : source.point();
    const double expected = distance(p, reference_of_segments(p, t));
    ASSERT_NEAR(distance(p, widen(closest_point_on_triangle(p, t))), expected,
                8 * kUlp * max_abs_of(p, t))
        << i;
  }
}

TEST(ClosestPoint, CornersAndInnerPointsAnswerThemselves) {
  const Triangle t{{{{0, 0, 0}, {8, 0, 0}, {0, 8, 0}}}};
  for (const auto& c : t.corner) EXPECT_EQ(closest_point_on_triangle(c, t), c);
  EXPECT_EQ(closest_point_on_triangle({2, 2, 5}, t), Eigen::Vector3d(2, 2, 0));
  EXPECT_EQ(closest_point_on_triangle({-1, 3, -2}, t), Eigen::Vector3d(0, 3, 0));
  EXPECT_EQ(closest_point_on_triangle({-1, -1, 4}, t), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(closest_point_on_triangle({8, 8, 1}, t), Eigen::Vector3d(4, 4, 0));
}

TEST(ClosestPoint, IsNeverNaN) {
  constexpr std::array kValues = {0.0,      -0.0,     1.0,       -3.0,      0x1p200,
                                  -0x1p200, 0x1p-200, 0x1p-1074, 0x1p-1022, 0x1.fffffffffffffp-3};
  std::mt19937_64 random(0xa4);
  const auto point = [&]() -> Eigen::Vector3d {
    const auto value = [&] { return kValues[random() % kValues.size()]; };
    const double x = value(), y = value();
    return {x, y, value()};
  };
  for (int i = 0; i < 200000; ++i) {
    const Triangle t{{point(), point(), point()}};
    const Eigen::Vector3d p = point();
    const Eigen::Vector3d q = closest_point_on_triangle(p, t);
    ASSERT_TRUE(q.allFinite()) << i;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double low = std::min({t.corner[0][k], t.corner[1][k], t.corner[2][k]});
      const double high = std::max({t.corner[0][k], t.corner[1][k], t.corner[2][k]});
      const double slack = 4 * kUlp * std::max(std::abs(low), std::abs(high));
      ASSERT_GE(q[k], low - slack) << i;
      ASSERT_LE(q[k], high + slack) << i;
    }
  }
}

}  // namespace
}  // namespace boxtree
