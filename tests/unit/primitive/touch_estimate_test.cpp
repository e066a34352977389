// SPDX-License-Identifier: MIT
// Estimates of touches before distances in extended precision. Nothing rests on them but the time
// that a cast takes: a wrong one costs steps of a search.
#include "runtime/primitive/touch_estimate.h"

#include <cmath>
#include <cstdint>
#include <random>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tests/support/shape_reference.h"

namespace boxtree {
namespace {

class TouchEstimates : public testing::Test {
 protected:
  double number(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }
  Eigen::Vector3d vector(double most) {
    return {number(-most, most), number(-most, most), number(-most, most)};
  }
  Corners triangle_near(const Eigen::Vector3d& center) {
    return {center + vector(1), center + vector(1), center + vector(1)};
  }

  // Whether the shape touches where the estimate says, and nowhere before.
  static bool is_first(const ConvexShape& shape, const Eigen::Vector3d& direction,
                       const Corners& corner, double s) {
    constexpr long double kNear = 1e-9L;
    const test::LongShape exact = test::long_shape(
        Capsule{-shape.half[0] * shape.axis[0], shape.half[0] * shape.axis[0], shape.radius});
    const test::LongTriangle triangle = test::long_triangle({corner});
    const test::LongVector moved = direction.cast<long double>();
    const long double there =
        test::distance(exact, test::LongVector(s * moved), triangle) - exact.radius;
    return std::abs(there) < kNear && !test::touches_between(exact, moved, 0, s - 1e-6L, triangle);
  }

  static ConvexShape capsule(const Eigen::Vector3d& arm, double radius) {
    ConvexShape shape;
    shape.axes = 1;
    shape.axis[0] = arm;
    shape.half[0] = 1;
    shape.radius = radius;
    return shape;
  }

  // Of how many the estimate is not the first touch; `touches`: how many do touch.
  template <class Next>
  void expect_few_wrong(const Next& next) {
    int touches = 0, wrong = 0;
    for (int i = 0; i < 2000; ++i) {
      ConvexShape shape;
      Corners corner;
      Eigen::Vector3d direction;
      next(shape, corner, direction);
      const TouchEstimate found = estimated_touch(shape, direction, corner);
      if (!std::isfinite(found.s)) continue;
      ++touches;
      const bool is_right = is_first(shape, direction, corner, found.s);
      wrong += is_right ? 0 : 1;
      if (shape.axes == 0 || !is_right) continue;
      // The part of the core that is said to touch does.
      Corners there = corner;
      for (Eigen::Vector3d& c : there) c -= found.s * direction;
      EXPECT_NE(found.core, CoreGuess::kNone);
      EXPECT_NEAR(guessed_points(shape, there, found.core).upper, shape.radius, 1e-8);
    }
    EXPECT_GT(touches, 300);
    EXPECT_LE(wrong, touches / 500);
  }

 private:
  std::mt19937_64 random_{1};
};

TEST_F(TouchEstimates, OfSpheresAreTheFirstTouch) {
  expect_few_wrong([&](ConvexShape& shape, Corners& corner, Eigen::Vector3d& direction) {
    shape.radius = number(0.01, 1);
    corner = triangle_near({3, 0, 0});
    direction = Eigen::Vector3d(1, 0, 0) + vector(0.2);
  });
}

TEST_F(TouchEstimates, OfCapsulesAreTheFirstTouch) {
  expect_few_wrong([&](ConvexShape& shape, Corners& corner, Eigen::Vector3d& direction) {
    shape = capsule(vector(0.8), number(0.01, 0.5));
    corner = triangle_near({4, 0, 0});
    direction = Eigen::Vector3d(1, 0, 0) + vector(0.2);
  });
}

// As a capsule lies on a slope: the sum of core and triangle is flat but for rounding, and any side
// of it in front.
TEST_F(TouchEstimates, OfCapsulesAlongTheTriangleAreTheFirstTouch) {
  expect_few_wrong([&](ConvexShape& shape, Corners& corner, Eigen::Vector3d& direction) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(number(0, 3), vector(1).normalized()).toRotationMatrix();
    shape = capsule(turn * Eigen::Vector3d(number(-1, 1), number(-1, 1), 0), number(0.01, 0.5));
    corner = triangle_near({0, 0, 0});
    const double floor = number(-3, -2);
    for (Eigen::Vector3d& c : corner) {
      c[2] = floor;
      c = turn * c;
    }
    direction = turn * Eigen::Vector3d(number(-0.3, 0.3), number(-0.3, 0.3), -1);
  });
}

// Thin prisms, seen along their faces.
TEST_F(TouchEstimates, OfCapsulesBesideNeedlesAreTheFirstTouch) {
  expect_few_wrong([&](ConvexShape& shape, Corners& corner, Eigen::Vector3d& direction) {
    shape = capsule(vector(0.8), number(0.1, 0.5));
    corner = triangle_near({4, 0, 0});
    corner[2] = corner[0] + 0.3 * (corner[1] - corner[0]) + vector(1e-3);
    direction = Eigen::Vector3d(1, 0, 0) + vector(0.1);
  });
}

TEST_F(TouchEstimates, AreInfiniteForWhatMovesAway) {
  for (int i = 0; i < 200; ++i) {
    const Corners corner = triangle_near({4, 0, 0});
    const Eigen::Vector3d away = Eigen::Vector3d(-1, 0, 0) + vector(0.1);
    ConvexShape sphere;
    sphere.radius = 0.5;
    EXPECT_FALSE(std::isfinite(estimated_touch(sphere, away, corner).s));
    EXPECT_FALSE(std::isfinite(estimated_touch(capsule(vector(0.5), 0.5), away, corner).s));
  }
}

}  // namespace
}  // namespace boxtree
