// SPDX-License-Identifier: MIT
// Bounds of placements against long double and against singular values.
#include "runtime/scene/placement.h"

#include <random>

#include <Eigen/SVD>
#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace boxtree {
namespace {

TEST(Stretch, BoundsSingularValues) {
  std::mt19937_64 random(1);
  double worst = 1;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Matrix3d linear = test::random_pose(random, 1, i % 2 == 1).linear();
    const Eigen::Vector3d values = Eigen::JacobiSVD<Eigen::Matrix3d>(linear).singularValues();
    const Stretch stretch = stretch_of(linear);
    ASSERT_LE(stretch.least, values[2] * (1 + 1e-15));
    ASSERT_GE(stretch.most, values[0] * (1 - 1e-15));
    // Tight for what levels are made of: turned, moved, evenly scaled.
    if (i % 2 == 0) {
      ASSERT_GE(stretch.least, values[2] * (1 - 1e-14));
      ASSERT_LE(stretch.most, values[0] * (1 + 1e-14));
    }
    worst = std::max(worst, values[2] / stretch.least);
  }
  EXPECT_LE(worst, std::sqrt(3.0) * 1.0001);  // the Frobenius norm
}

TEST(Stretch, OfASingularMapSaysNothing) {
  Eigen::Matrix3d flat = Eigen::Matrix3d::Identity();
  flat(2, 2) = 0;
  EXPECT_EQ(stretch_of(flat).least, 0);
  EXPECT_GE(stretch_of(flat).most, 1);
}

TEST(Placement, RefusesWhatCannotBeUndone) {
  Pose pose = Pose::Identity();
  EXPECT_TRUE(Placement::make(Frame(), pose).has_value());
  pose.linear()(1, 1) = 0;
  EXPECT_FALSE(Placement::make(Frame(), pose).has_value());
  pose.linear()(1, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(Placement::make(Frame(), pose).has_value());
  pose = Pose::Identity();
  pose.translation()[0] = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(Placement::make(Frame(), pose).has_value());
  pose.translation()[0] = 2 * kMaxCoordinate;
  EXPECT_FALSE(Placement::make(Frame(), pose).has_value());
}

TEST(Placement, HasNoBoundsBeyondTheLargestCoordinate) {
  Pose pose = Pose::Identity();
  const auto placed = Placement::make(Frame(), pose);
  ASSERT_TRUE(placed.has_value());
  EXPECT_TRUE(placed->bounds({{-1, -1, -1}, {1, 1, 1}}).has_value());
  EXPECT_FALSE(placed->bounds({{-1, -1, -1}, {1, 2 * kMaxCoordinate, 1}}).has_value());
}

// There and back in long double: what the bounds promise of coordinates that were rounded.
TEST(Placement, ErrorsHoldWhatRoundingDoes) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> unit(-1, 1);
  const Box<double> root{{-3, -3, -3}, {3, 3, 3}};
  for (int i = 0; i < 2000; ++i) {
    const double far = std::exp2(unit(random) * 30);
    const Pose pose = test::random_pose(random, far, true);
    const auto placed = Placement::make(Frame({far * unit(random), 0, 1}, 3), pose);
    ASSERT_TRUE(placed.has_value());
    const auto bounds = placed->bounds(root);
    ASSERT_TRUE(bounds.has_value());
    const Eigen::Vector3d tree(3 * unit(random), 3 * unit(random), 3 * unit(random));
    const Eigen::Vector3d world = placed->to_world().apply(tree);
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_GE(world[static_cast<Eigen::Index>(k)], bounds->world.low[k]);
      ASSERT_LE(world[static_cast<Eigen::Index>(k)], bounds->world.high[k]);
    }
    const Eigen::Vector3d back = placed->to_tree(world);
    const Eigen::Matrix<long double, 3, 3> linear = placed->to_world().linear.cast<long double>();
    const Eigen::Matrix<long double, 3, 1> exact = linear * (back - tree).cast<long double>();
    ASSERT_LE(static_cast<double>(exact.norm()),
              placed->distance_error(back, world, root) + 3 * bounds->error());
  }
}

}  // namespace
}  // namespace boxtree
