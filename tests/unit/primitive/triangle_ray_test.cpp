// SPDX-License-Identifier: MIT
// intersect_ray_triangle: no leak through edges and corners of closed meshes (R11), values against
// extended precision, degenerate triangles (R13), the triangle of bepuphysics2 #143 (R30).
#include "runtime/primitive/triangle_ray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <random>
#include <tests/unit/primitive/closed_meshes.h>
#include <tests/unit/primitive/triangle_cases.h>
#include <vector>

#include <gtest/gtest.h>

namespace boxtree {
namespace {

struct Source {
  std::mt19937_64 random;
  std::uniform_real_distribution<double> unit{-1, 1};

  Eigen::Vector3d point() {
    const double x = unit(random), y = unit(random);
    return {x, y, unit(random)};
  }
};

bool escapes(const std::vector<Triangle>& mesh, const Eigen::Vector3d& origin,
             const Eigen::Vector3d& direction) {
  const RayShear ray(origin, direction);
  return std::none_of(mesh.begin(), mesh.end(), [&ray](const Triangle& t) {
    const auto hit = intersect_ray_triangle(ray, t);
    return hit && hit->t > 0;
  });
}

// Aims at all corners and at random points of all edges, from the given inner points.
template <class OriginOf>
int count_escapes(const std::vector<Triangle>& mesh, int rays, Source& source, OriginOf origin_of) {
  int escaped = 0;
  for (int i = 0; i < rays; ++i) {
    const auto& c = mesh[static_cast<std::size_t>(i) % mesh.size()].corner;
    const std::size_t k = source.random() % 3;
    const double part = i % 3 == 0 ? 0 : (source.unit(source.random) + 1) / 2;
    const Eigen::Vector3d target = c[k] + part * (c[(k + 1) % 3] - c[k]);
    const Eigen::Vector3d origin = origin_of(target, i);
    escaped += escapes(mesh, origin, target - origin);
  }
  return escaped;
}

TEST(TriangleRay, NothingEscapesFromASphere) {
  Source source{std::mt19937_64(0x1ea4)};
  const std::vector<Triangle> mesh = test::icosphere(3);
  EXPECT_EQ(count_escapes(mesh, 20000, source,
                          [&](const Eigen::Vector3d&, int i) -> Eigen::Vector3d {
                            // From the center, symmetry makes many areas exactly zero.
                            if (i % 2 == 0) return Eigen::Vector3d::Zero();
                            return 0.5 * source.point();
                          }),
            0);
}

TEST(TriangleRay, NothingEscapesFromATorus) {
  Source source{std::mt19937_64(0x70125)};
  const std::vector<Triangle> mesh = test::torus(40, 20);
  const auto inside = [](const Eigen::Vector3d& target, int) -> Eigen::Vector3d {
    return 3 * Eigen::Vector3d(target[0], target[1], 0).normalized();
  };
  EXPECT_EQ(count_escapes(mesh, 20000, source, inside), 0);
}

// Far from the origin and flattened, so that areas cancel to zero and below.
TEST(TriangleRay, NothingEscapesFromFlatSpheresFarAway) {
  Source source{std::mt19937_64(0xfa4)};
  for (const double flatness : {1e-3, 1e-9}) {
    std::vector<Triangle> mesh = test::icosphere(2);
    const Eigen::Vector3d offset(1000, -2000, 0);
    for (Triangle& t : mesh) {
      for (auto& c : t.corner) c = c.cwiseProduct(Eigen::Vector3d(1, 1, flatness)) + offset;
    }
    const auto origin = [&](const Eigen::Vector3d&, int i) -> Eigen::Vector3d {
      if (i % 2 == 0) return offset;
      return offset + 0.5 * source.point().cwiseProduct(Eigen::Vector3d(1, 1, flatness));
    };
    EXPECT_EQ(count_escapes(mesh, 10000, source, origin), 0) << flatness;
  }
}

// A box on integers, rays along the axes and diagonals through its corners and edges: every sheared
// coordinate and many areas are exact zeros, and side faces are edge-on.
TEST(TriangleRay, NothingEscapesFromABoxOnTheGrid) {
  std::vector<Triangle> mesh;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-2.0, 2.0}) {
      const auto corner = [&](double x, double y) {
        Eigen::Vector3d v;
        v[axis] = side;
        v[(axis + 1) % 3] = x;
        v[(axis + 2) % 3] = y;
        return v;
      };
      mesh.push_back({{corner(-2, -2), corner(2, -2), corner(2, 2)}});
      mesh.push_back({{corner(-2, -2), corner(2, 2), corner(-2, 2)}});
    }
  }
  test::TriangleCases cases(0x6a1d, 64);
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d origin = cases.point(1);
    const Eigen::Vector3d direction = cases.point(2);
    if (direction.isZero(0)) continue;
    ASSERT_FALSE(escapes(mesh, origin, direction)) << i;
  }
}

// A solution of x t - y s = 1 for coprime x and y (Euclid).
std::array<std::int64_t, 2> bezout(std::int64_t x, std::int64_t y) {
  if (y == 0) return {0, 1};
  const auto [s, t] = bezout(y, x % y);
  return {-t - (x / y) * s, -s};
}

// Triangles around the ray whose areas all round to zero although none of them is: taken for
// edge-on they would be holes. Corners p, q and -p - q with det(p, q) = 1 have three areas of
// exactly 1, differences of products of about 2^100.
TEST(TriangleRay, AreasThatRoundToZeroAreNotEdgeOn) {
  test::TriangleCases cases(0xfa15e, 64);
  const std::int64_t range = std::int64_t{1} << 51;
  int zeros = 0;
  for (int i = 0; i < 20000; ++i) {
    const std::int64_t x = cases.integer(range / 2, range), y = cases.integer(range / 2, range);
    if (std::gcd(x, y) != 1) continue;
    const auto [s, t] = bezout(x, y);
    const auto point = [](std::int64_t px, std::int64_t py) -> Eigen::Vector3d {
      return {static_cast<double>(px), static_cast<double>(py), 1};
    };
    const Triangle triangle{{point(x, y), point(s, t), point(-x - s, -y - t)}};
    const auto& [a, b, c] = triangle.corner;
    zeros += a[0] * b[1] == a[1] * b[0] && b[0] * c[1] == b[1] * c[0] && c[0] * a[1] == c[1] * a[0];
    const auto hit = intersect_ray_triangle(RayShear({0, 0, 0}, {0, 0, 0x1p60}), triangle);
    ASSERT_TRUE(hit) << i;
    // With a rounded area above zero the others may vanish beside it, but never all three.
    ASSERT_TRUE(hit->u >= 0 && hit->v >= 0 && hit->u + hit->v <= 1 + 0x1p-50) << i;
  }
  EXPECT_GT(zeros, 100);
}

// Solves for t, u, v in extended precision (Cramer) where the answer is not in doubt.
TEST(TriangleRay, AgreesWithExtendedPrecision) {
  using Long = Eigen::Matrix<long double, 3, 1>;
  const auto det = [](const Long& a, const Long& b, const Long& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
           a[2] * (b[0] * c[1] - b[1] * c[0]);
  };
  Source source{std::mt19937_64(0xa9)};
  int hits = 0;
  for (int i = 0; i < 40000; ++i) {
    const Triangle t{{source.point(), source.point(), source.point()}};
    const Eigen::Vector3d origin = source.point(), direction = source.point();
    const Long a = t.corner[0].cast<long double>(), e = t.corner[1].cast<long double>() - a;
    const Long f = t.corner[2].cast<long double>() - a, d = -direction.cast<long double>();
    const Long w = origin.cast<long double>() - a;
    const long double volume = det(d, e, f);
    const long double s = det(w, e, f) / volume, u = det(d, w, f) / volume,
                      v = det(d, e, w) / volume;
    if (std::abs(volume) < 1e-3L) continue;
    const long double least = std::min({u, v, 1 - u - v});
    if (std::abs(least) < 1e-9L) continue;
    const auto hit = intersect_ray_triangle(RayShear(origin, direction), t);
    ASSERT_EQ(hit.has_value(), least > 0) << i;
    if (!hit) continue;
    ++hits;
    ASSERT_NEAR(hit->t, static_cast<double>(s), 1e-11) << i;
    ASSERT_NEAR(hit->u, static_cast<double>(u), 1e-11) << i;
    ASSERT_NEAR(hit->v, static_cast<double>(v), 1e-11) << i;
  }
  EXPECT_GT(hits, 3000);
}

// Found by an independent oracle: rays hit faces without area, and such that they see edge-on, at
// any of their points, also behind the ray's. The point that is hit is where the ray is.
TEST(TriangleRay, AFaceThatIsNearlyALineIsHitWhereTheRayIs) {
  Source source{std::mt19937_64(0x11e)};
  std::uniform_real_distribution<double> share(0, 1);
  const auto check = [](const Triangle& t, const Eigen::Vector3d& origin,
                        const Eigen::Vector3d& direction) {
    const auto hit = intersect_ray_triangle(RayShear(origin, direction), t);
    if (!hit) return 0;
    const Eigen::Vector3d point =
        t.corner[0] + hit->u * (t.corner[1] - t.corner[0]) + hit->v * (t.corner[2] - t.corner[0]);
    EXPECT_LT((origin + hit->t * direction - point).norm(), 1e-11);
    return 1;
  };
  const Triangle line{{{{3, 4, -7}, {4, 5, -9}, {0, 1, -1}}}};
  check(line, {1.4386468037501103, 2.6561631531449601, -4.0948099568950704}, {-1, 3, -2});
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const Eigen::Vector3d on =
        line.corner[2] + share(source.random) * (line.corner[1] - line.corner[2]);
    const Eigen::Vector3d direction = source.point();
    hits += check(line, on - 3 * share(source.random) * direction, direction);
    const Triangle t{{source.point(), source.point(), source.point()}};
    // In its plane, but for rounding.
    const Eigen::Vector3d in_plane = share(source.random) * (t.corner[1] - t.corner[0]) -
                                     share(source.random) * (t.corner[2] - t.corner[0]);
    const Eigen::Vector3d inside = (t.corner[0] + t.corner[1] + t.corner[2]) / 3;
    hits += check(t, inside - 2 * in_plane, in_plane);
  }
  EXPECT_GT(hits, 2000);
}

TEST(TriangleRay, BothSidesAndWindingsAndNegativeParameters) {
  const Triangle front{{{{0, 0, 1}, {4, 0, 1}, {0, 4, 1}}}};
  const Triangle back{{front.corner[0], front.corner[2], front.corner[1]}};
  for (const double sign : {1.0, -1.0}) {
    const RayShear ray({1, 0.5, 0}, {0, 0, 2 * sign});
    const auto hit = intersect_ray_triangle(ray, front);
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->t, 0.5 * sign);
    EXPECT_EQ(hit->u, 0.25);
    EXPECT_EQ(hit->v, 0.125);
    const auto turned = intersect_ray_triangle(ray, back);
    ASSERT_TRUE(turned);
    EXPECT_EQ(turned->u, 0.125);
    EXPECT_EQ(turned->v, 0.25);
  }
}

TEST(TriangleRay, DegenerateAndEdgeOnTrianglesAreNotHit) {
  test::TriangleCases cases(0xde6e, 64);
  for (int i = 0; i < 20000; ++i) {
    const Triangle t = cases.degenerate(i % 6, 8);
    const Eigen::Vector3d origin = cases.point(8);
    Eigen::Vector3d direction = t.corner[static_cast<std::size_t>(i) % 3] - origin;
    // Grid directions of a power of two shear without rounding: degenerate stays degenerate.
    direction = 4 * Eigen::Vector3d::Unit(i % 3) + 4 * (i % 2) * Eigen::Vector3d::Unit((i + 1) % 3);
    ASSERT_FALSE(intersect_ray_triangle(RayShear(origin, direction), t)) << i;
    const Eigen::Vector3d at_corner = t.corner[static_cast<std::size_t>(i) % 3] - direction;
    ASSERT_FALSE(intersect_ray_triangle(RayShear(at_corner, direction), t)) << i;
  }
  const Triangle wall{{{{0, 0, 0}, {4, 0, 0}, {0, 0, 4}}}};
  EXPECT_FALSE(intersect_ray_triangle(RayShear({1, 0, -5}, {0, 0, 1}), wall));
}

TEST(TriangleRay, BepuTriangleIsHit) {
  const Triangle t{
      {{{2832.862, 200, -641.5822}, {2834.611, 200.0066, -643.3685}, {2834.289, 200, -640.1809}}}};
  const Eigen::Vector3d middle = (t.corner[0] + t.corner[1] + t.corner[2]) / 3;
  for (const double height : {1e-6, 0.01, 1.0, 1e4}) {
    for (const double sign : {1.0, -1.0}) {
      const Eigen::Vector3d origin = middle + Eigen::Vector3d(0, sign * height, 0);
      const auto hit = intersect_ray_triangle(RayShear(origin, {0, -sign, 0}), t);
      ASSERT_TRUE(hit) << height;
      EXPECT_NEAR(hit->t, height, 1e-11);
    }
    for (const auto& c : t.corner) {
      const Eigen::Vector3d above = c + Eigen::Vector3d(0, height, 0);
      EXPECT_TRUE(intersect_ray_triangle(RayShear(above, {0, -1, 0}), t)) << height;
    }
  }
}

TEST(TriangleRay, IsNeverNaN) {
  constexpr std::array kValues = {0.0,      -0.0,     1.0,       -3.0,      0x1p200,
                                  -0x1p200, 0x1p-200, 0x1p-1074, 0x1p-1022, 0x1.fffffffffffffp-3};
  std::mt19937_64 random(0xa5);
  const auto point = [&]() -> Eigen::Vector3d {
    const auto value = [&] { return kValues[random() % kValues.size()]; };
    const double x = value(), y = value();
    return {x, y, value()};
  };
  for (int i = 0; i < 400000; ++i) {
    const Triangle t{{point(), point(), point()}};
    const Eigen::Vector3d direction = point();
    if (direction.isZero(0)) continue;
    const auto hit = intersect_ray_triangle(RayShear(point(), direction), t);
    if (!hit) continue;
    ASSERT_FALSE(std::isnan(hit->t)) << i;
    ASSERT_TRUE(hit->u >= 0 && hit->u <= 1 && hit->v >= 0 && hit->v <= 1) << i;
  }
}

// Neighbours get the same numbers only if the axes of a ray are always chosen alike.
TEST(RayShear, TheLargestComponentIsTheMainAxisAndTheFirstOfEqualOnes) {
  struct Case {
    Eigen::Vector3d direction;
    int x, y, z;
  };
  const Case cases[] = {{{3, 1, 2}, 1, 2, 0},  {{1, 3, 2}, 2, 0, 1},   {{1, 2, 3}, 0, 1, 2},
                        {{-3, 1, 2}, 1, 2, 0}, {{1, -3, 2}, 2, 0, 1},  {{1, 2, -3}, 0, 1, 2},
                        {{1, 1, 1}, 1, 2, 0},  {{-1, 1, 1}, 1, 2, 0},  {{1, 2, 2}, 2, 0, 1},
                        {{2, 1, -2}, 1, 2, 0}, {{2, 2, 1}, 1, 2, 0},   {{0, 0, 1}, 0, 1, 2},
                        {{0, 1, 0}, 2, 0, 1},  {{1, 0, -0.0}, 1, 2, 0}};
  for (const Case& expected : cases) {
    const RayShear shear(Eigen::Vector3d::Zero(), expected.direction);
    EXPECT_EQ(shear.axis_x, expected.x) << expected.direction.transpose();
    EXPECT_EQ(shear.axis_y, expected.y) << expected.direction.transpose();
    EXPECT_EQ(shear.axis_z, expected.z) << expected.direction.transpose();
  }
}

}  // namespace
}  // namespace boxtree
