// SPDX-License-Identifier: MIT
// Poses decomposed for glTF, and which of them mirror.
#include "cooker/export/placed_shape.h"

#include <cmath>
#include <random>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace boxtree::cooker {
namespace {

Pose pose_of(const Eigen::Matrix3d& linear) {
  Pose pose = Pose::Identity();
  pose.linear() = linear;
  return pose;
}

double largest_cosine(const Eigen::Matrix3d& linear) {
  double largest = 0;
  for (int i = 0; i < 3; ++i) {
    const double cosine = linear.col(i).normalized().dot(linear.col((i + 1) % 3).normalized());
    largest = std::max(largest, std::abs(cosine));
  }
  return largest;
}

TEST(NodeMatrices, WithoutShearThePoseStaysAsItIs) {
  std::mt19937_64 random(1);
  for (int i = 0; i < 1000; ++i) {
    Pose pose = test::random_pose(random, 100, false);
    pose.linear() = pose.linear() * Eigen::DiagonalMatrix<double, 3>(1e-3, -7, 500);
    if (i % 2 == 0) pose.matrix() = pose.matrix().cast<float>().cast<double>();
    const std::vector<Pose> matrices = node_matrices(pose);
    ASSERT_EQ(matrices.size(), 1u);
    ASSERT_EQ(matrices[0].matrix(), pose.matrix());
  }
}

TEST(NodeMatrices, ShearIsTheProductOfTwoThatGltfAllows) {
  std::mt19937_64 random(2);
  for (int i = 0; i < 1000; ++i) {
    const Pose pose = test::random_pose(random, 100, true);
    const std::vector<Pose> matrices = node_matrices(pose);
    if (matrices.size() == 1) {
      ASSERT_LT(largest_cosine(pose.linear()), 1e-6);
      continue;
    }
    ASSERT_EQ(matrices.size(), 2u);
    for (const Pose& matrix : matrices) ASSERT_LT(largest_cosine(matrix.linear()), 1e-14);
    ASSERT_NEAR(matrices[1].linear().determinant(), 1, 1e-14) << "a rotation";
    ASSERT_EQ(matrices[0].linear().determinant() < 0, pose.linear().determinant() < 0);
    ASSERT_EQ(matrices[0].translation(), pose.translation());
    ASSERT_TRUE(matrices[1].translation().isZero(0));
    const Eigen::Matrix3d product = matrices[0].linear() * matrices[1].linear();
    ASSERT_LT((product - pose.linear()).norm(), 1e-14 * pose.linear().norm());
  }
}

TEST(Mirrors, IsExactAtAnySize) {
  EXPECT_FALSE(mirrors(Pose::Identity()));
  std::mt19937_64 random(3);
  for (int i = 0; i < 1000; ++i) {
    Pose pose = test::random_pose(random, 1, i % 2 == 1);
    ASSERT_EQ(mirrors(pose), i % 2 == 1);
    for (const int exponent : {-900, -400, 400, 900}) {
      Pose scaled = pose;
      scaled.linear() *= std::ldexp(1.0, exponent);
      ASSERT_EQ(mirrors(scaled), i % 2 == 1) << exponent;
    }
  }
  // (2^27 + 1) (2^27 - 1) - 2^54 = -1, of which double leaves 0.
  constexpr double kHalf = 0x1p27;
  Eigen::Matrix3d near_flat;
  near_flat << kHalf + 1, kHalf, 0, kHalf, kHalf - 1, 0, 0, 0, 1;
  EXPECT_TRUE(mirrors(pose_of(near_flat)));
  near_flat.col(2) = -near_flat.col(2);
  EXPECT_FALSE(mirrors(pose_of(near_flat)));
}

}  // namespace
}  // namespace boxtree::cooker
