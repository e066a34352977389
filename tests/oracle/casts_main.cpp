// SPDX-License-Identifier: MIT
// boxtree_casts: draws a triangle and a moving shape after the other and compares when they touch,
// and how they part where they touch at the start, with distances in extended precision. Half of
// the cases, or as many as are wished, are degenerate: needles, segments, points, motions in the
// plane and without length, touches at the start, grazes, shared edges. Exits with 7 when an answer
// is wrong.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "runtime/primitive/convex_points.h"
#include "runtime/primitive/moving_shape.h"
#include "runtime/primitive/penetration.h"
#include "runtime/primitive/vector3.h"
#include "tests/support/program_options.h"
#include "tests/support/shape_reference.h"

namespace boxtree::oracle {
namespace {

using test::depth_along;
using test::LongShape;
using test::LongTriangle;
using test::LongVector;

constexpr int kDifferenceFound = 7;  // as the command line of the cooker has it
constexpr std::uint32_t kHull = 4;   // beside the numbers of axes of other shapes

struct Case {
  Triangle triangle;
  ConvexShape shape;
  std::vector<Eigen::Vector3d> points;  // of a hull, relative to its center
  Eigen::Vector3d direction;
};

class Draw {
 public:
  /// `degenerate`: so many of a hundred cases.
  Draw(std::uint64_t seed, std::uint32_t degenerate) : random_(seed), degenerate_(degenerate) {}

  Case next(std::uint32_t axes) {
    Case drawn;
    const double size = std::pow(10.0, 2 * unit());
    for (Eigen::Vector3d& corner : drawn.triangle.corner) corner = size * coarse(vector());
    drawn.shape.axes = std::min(axes, 3u);
    if (axes == kHull) {
      draw_hull(drawn, length(size));
    } else if (axes == 1) {
      drawn.shape.axis[0] = size * coarse(vector());
      drawn.shape.half[0] = 1;
    }
    if (axes == 3) {
      Eigen::Quaterniond turn(unit(), unit(), unit(), unit());
      turn.normalize();
      if (random_() % 3 == 0) turn.setIdentity();
      for (int k = 0; k < 3; ++k) {
        drawn.shape.axis[static_cast<std::size_t>(k)] = turn.toRotationMatrix().col(k);
        drawn.shape.half[static_cast<std::size_t>(k)] = length(size);
      }
    } else if (axes != kHull) {
      drawn.shape.radius = length(size);
    }
    drawn.shape.center = 3 * size * coarse(vector());
    const Eigen::Vector3d to = size * vector();
    drawn.direction = to - drawn.shape.center;
    if (random_() % 100 < degenerate_) make_degenerate(drawn, size);
    // Its largest component in [1/2, 1).
    const double largest = largest_magnitude(drawn.direction);
    if (largest > 0) drawn.direction = std::ldexp(1.0, -std::ilogb(largest) - 1) * drawn.direction;
    return drawn;
  }

  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Eigen::Vector3d vector() { return {unit(), unit(), unit()}; }

 private:
  // Some coordinates are whole, so that planes and lines are met exactly.
  Eigen::Vector3d coarse(const Eigen::Vector3d& v) {
    if (random_() % 3 != 0) return v;
    return (8 * v).array().round().matrix() / 8;
  }
  // One to seven points; some of them flat, in line, the same, or the corners of a box.
  void draw_hull(Case& drawn, double size) {
    const std::size_t count = 1 + random_() % 7;
    const std::uint64_t kind = random_() % 6;
    const Eigen::Vector3d along = vector(), across = vector();
    for (std::size_t i = 0; i < (kind == 4 ? 8 : count); ++i) {
      Eigen::Vector3d p = coarse(vector());
      if (kind == 1) p[2] = 0;
      if (kind == 2) p = p[0] * along;
      if (kind == 3 && i % 2 == 1) p = drawn.points.back() / size;
      if (kind == 4) p = Eigen::Vector3d(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 0.5 : -0.5);
      if (kind == 5) p = p[0] * along + p[1] * across;
      drawn.points.push_back(size * p);
    }
    for (int k = 0; k < 3; ++k) {
      double& half = drawn.shape.half[static_cast<std::size_t>(k)];
      drawn.shape.axis[static_cast<std::size_t>(k)] = Eigen::Vector3d::Unit(k);
      for (const Eigen::Vector3d& p : drawn.points) half = std::max(half, std::abs(p[k]));
    }
  }

  double length(double size) { return size * std::pow(10.0, -1.5 + 1.5 * unit()); }

  void make_degenerate(Case& drawn, double size) {
    auto& [a, b, c] = drawn.triangle.corner;
    switch (random_() % 11) {
      case 0:  // a needle
        c = a + 0.5 * (1 + unit()) * (b - a) + std::pow(10.0, -12 + 5 * unit()) * size * vector();
        break;
      case 1:
        c = b;
        break;
      case 2:
        b = c = a;
        break;
      case 3:  // in the plane
        drawn.direction = unit() * (b - a) + unit() * (c - a);
        break;
      case 4:  // along an axis
        drawn.direction = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(random_() % 3));
        break;
      case 5:  // at the start
        drawn.shape.center = a + 0.5 * (1 + unit()) * (b - a);
        break;
      case 6:
        drawn.direction.setZero();
        drawn.shape.center = a + drawn.shape.radius * vector();
        break;
      case 7:  // grazes a plane
        rest_on_plane(drawn);
        drawn.direction[2] = 0;
        break;
      case 8:  // touches a plane at the start
        rest_on_plane(drawn);
        break;
      case 9: {  // an edge of the triangle is one of the shape, at s = 1 of the way
        const auto [p, q] = edge_of(drawn);
        a = drawn.shape.center + drawn.direction + p;
        b = drawn.shape.center + drawn.direction + q;
        break;
      }
      default:  // far away
        drawn.shape.center = 1e6 * size * vector().normalized();
        drawn.direction = a - drawn.shape.center + size * vector();
    }
  }

  // The triangle at z = 0, the shape on it.
  static void rest_on_plane(Case& drawn) {
    for (Eigen::Vector3d& corner : drawn.triangle.corner) corner[2] = 0;
    drawn.shape.center[2] = drawn.shape.axes == 3 ? drawn.shape.half[2] : drawn.shape.radius;
  }

  // Relative to its center. That of a sphere is across its lowest point.
  static std::pair<Eigen::Vector3d, Eigen::Vector3d> edge_of(const Case& drawn) {
    const ConvexShape& shape = drawn.shape;
    if (!drawn.points.empty()) return {drawn.points.front(), drawn.points.back()};
    if (shape.axes == 3) {
      const Eigen::Vector3d side = shape.half[1] * shape.axis[1] + shape.half[2] * shape.axis[2];
      return {side - shape.half[0] * shape.axis[0], side + shape.half[0] * shape.axis[0]};
    }
    const Eigen::Vector3d low(0, 0, -shape.radius), across(shape.radius, 0, 0);
    if (shape.axes == 1) return {low - shape.axis[0], low + shape.axis[0]};
    return {low - across, low + across};
  }

  std::mt19937_64 random_;
  std::uint32_t degenerate_;
};

LongShape long_shape_of(const Case& drawn) {
  const ConvexShape& shape = drawn.shape;
  const LongVector center = shape.center.cast<long double>();
  if (!drawn.points.empty()) {
    std::vector<LongVector> points;
    for (const Eigen::Vector3d& p : drawn.points) points.push_back(center + p.cast<long double>());
    return test::long_hull(points);
  }
  if (shape.axes == 3) {
    std::array<LongVector, 3> axis;
    std::array<long double, 3> half{};
    for (std::size_t k = 0; k < 3; ++k) {
      axis[k] = shape.axis[k].cast<long double>();
      half[k] = shape.half[k];
    }
    return test::long_box(center, axis, half);
  }
  LongShape out;
  const LongVector arm = shape.half[0] * shape.axis[0].cast<long double>();
  out.core = {{LongVector(center - arm), LongVector(center + arm), LongVector(center + arm)}};
  out.radius = shape.radius;
  out.center = center;
  out.reach = arm.norm();
  return out;
}

struct Tally {
  std::uint64_t cases = 0, touches = 0, at_start = 0;
  std::uint64_t missed = 0;    // touched, and not told
  std::uint64_t early = 0;     // touched before it was told
  std::uint64_t invented = 0;  // not touched, and not within what is allowed
  std::uint64_t parted = 0;    // contacts whose normal or depth is wrong
  long double farthest = 0;    // from touching, at t, in units of 2^-53 of the largest coordinate
};

// Whether the shape, at `s` of its way or before, is nearer to the triangle than its radius. A
// direction along which they are apart, and which the motion only shortens, settles most.
bool touches_before(const LongShape& shape, const LongVector& direction, long double s,
                    const test::BoundedTriangle& triangle, const LongVector& normal,
                    long double size) {
  const long double along = direction.dot(normal);
  if (along <= 0 && depth_along(shape, normal, triangle.corner) - s * along <= 0) return false;
  if (shape.radius > 0) {
    return test::least_of(triangle, shape, direction, s, shape.radius) <
           shape.radius * (1 - 1e-18L);
  }
  // Without a radius it may touch at `s`; so a little before, if long double tells the difference.
  const long double before = s * (1 - 0x1p-50L);
  return (s - before) * direction.norm() > 0x1p-58L * size &&
         test::least_of(triangle, shape, direction, before, 0) <= 0;
}

void check(const Case& drawn, Draw& draw, Tally& tally) {
  double near = 2 * largest_magnitude(drawn.shape.half_extents());
  for (const Eigen::Vector3d& corner : drawn.triangle.corner) {
    near = std::max(near,
                    largest_magnitude(corner) + 2 * largest_magnitude(drawn.shape.half_extents()));
  }
  const double far = largest_magnitude(drawn.shape.center);
  ConvexShape placed = drawn.shape;
  const ConvexPoints hull{drawn.points, hull_distance, hull_penetration};
  if (!drawn.points.empty()) placed.hull = &hull;
  const MovingShape moving{placed, drawn.direction, MovingShape::doubt_of(near, far)};
  const double to = 8 * (near + far);
  const long double size = near + far / 8.0L;
  const long double allowed = 0x1p-46L * size;

  const LongShape shape = long_shape_of(drawn);
  const LongVector direction = drawn.direction.cast<long double>();
  const LongTriangle triangle = test::long_triangle(drawn.triangle);
  const test::BoundedTriangle bounded(triangle);
  ++tally.cases;
  const std::optional<MovingShape::Touch> touch = moving.first_touch(drawn.triangle, 0, to);
  if (!touch) {
    tally.missed += test::touches_between(shape, direction, 0, to, triangle) ? 1u : 0u;
    return;
  }
  ++tally.touches;
  const MovingShape::Contact contact = moving.contact_at(drawn.triangle, *touch);
  if (touch->s > 0) {
    tally.early += touches_before(shape, direction, touch->s, bounded,
                                  contact.normal.cast<long double>(), size);
  }
  // At that time, or before.
  long double beyond =
      test::distance(shape, LongVector(contact.by * direction), triangle) - shape.radius;
  if (beyond / size * 0x1p53L > tally.farthest) {
    // From where nothing has touched yet: steps over all of the way would not resolve its end.
    const long double least =
        test::least_distance(shape, direction, touch->s, contact.by, triangle);
    beyond = least - shape.radius;
    tally.farthest = std::max(tally.farthest, beyond / size * 0x1p53L);
  }
  tally.invented += beyond > allowed;
  if (touch->s > 0) return;
  ++tally.at_start;
  MovingShape at_rest = moving;
  at_rest.direction = Eigen::Vector3d::Zero();
  const std::optional<Penetration> touched = at_rest.contact_at_rest(drawn.triangle);
  if (!touched) {
    ++tally.parted;
    return;
  }
  const Penetration& at = *touched;
  const LongVector normal = at.normal.cast<long double>();
  bool is_wrong = std::abs(normal.norm() - 1) > 1e-12L || !(at.depth >= 0) ||
                  depth_along(shape, normal, triangle) > at.depth + 8 * allowed;
  for (int i = 0; i < 20; ++i) {
    LongVector other = draw.vector().cast<long double>().normalized();
    if (i % 2 == 0) other = (normal + 0.01L * other).normalized();
    is_wrong |= depth_along(shape, other, triangle) < at.depth - 8 * allowed;
  }
  tally.parted += is_wrong;
}

int run(std::uint64_t count, std::uint32_t degenerate, std::uint64_t seed,
        const std::vector<std::string>& shapes) {
  bool is_right = true;
  fmt::print(
      "shape    cases      touches    at start   missed  early  invented  contacts  farthest, "
      "2^-53\n");
  for (const auto& [name, axes] :
       {std::pair("sphere", 0u), {"capsule", 1u}, {"box", 3u}, {"hull", kHull}}) {
    if (!shapes.empty() && std::find(shapes.begin(), shapes.end(), name) == shapes.end()) continue;
    Draw draw(seed * 8 + axes, degenerate);
    Tally tally;
    for (std::uint64_t i = 0; i < count; ++i) check(draw.next(axes), draw, tally);
    fmt::print("{:8} {:<10} {:<10} {:<10} {:<7} {:<6} {:<9} {:<9} {:.1f}\n", name, tally.cases,
               tally.touches, tally.at_start, tally.missed, tally.early, tally.invented,
               tally.parted, static_cast<double>(tally.farthest));
    is_right &= tally.missed + tally.early + tally.invented + tally.parted == 0;
    // A program that never draws a touch checks nothing.
    is_right &= count < 1000 || (tally.touches > count / 10 && tally.at_start > count / 1000);
    std::fflush(stdout);
  }
  return is_right ? 0 : kDifferenceFound;
}

}  // namespace
}  // namespace boxtree::oracle

int main(int argc, char** argv) {
  boxtree::test::ProgramOptions program(
      "Casts and contacts of single triangles against extended precision");
  std::uint64_t count = 2000, seed = 1;
  std::vector<std::string> shapes;
  program.add("--cases", count, "Of each shape").shows_default();
  std::uint32_t degenerate = 50;
  program.add("--degenerate", degenerate, "So many of a hundred").shows_default();
  program.add("--seed", seed).shows_default();
  program.add("--shape", shapes, "sphere, capsule, box or hull [all]");
  if (const std::optional<int> status = program.parse(argc, argv)) return *status;
  return boxtree::oracle::run(count, degenerate, seed, shapes);
}
