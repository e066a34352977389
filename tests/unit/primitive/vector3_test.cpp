// SPDX-License-Identifier: MIT
// Sums come in the order in which they are written, in every build: the numbers are chosen so that
// any other order, or a fused product, rounds otherwise.
#include "runtime/primitive/vector3.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace boxtree {
namespace {

// 1 takes in neither of two halves of a unit in its last place, one after the other; their sum it
// does.
TEST(Vector3, SumsComeInOrder) {
  const Eigen::Vector3d ones(1, 1, 1);
  EXPECT_EQ(dot({1, 0x1p-53, 0x1p-53}, ones), 1);
  EXPECT_EQ(dot({0x1p-53, 0x1p-53, 1}, ones), 1 + 0x1p-52);
  EXPECT_EQ(squared_length({1, 0x1.6a09e667f3bccp-27, 0x1.6a09e667f3bccp-27}), 1);
  EXPECT_EQ(squared_length({0x1.6a09e667f3bcdp-27, 0x1.6a09e667f3bcdp-27, 1}), 1 + 0x1p-52);
  Eigen::Matrix3d rows;
  rows << 1, 0x1p-53, 0x1p-53, 0x1p-53, 0x1p-53, 1, 0x1p-53, 1, 0x1p-53;
  EXPECT_EQ(product(rows, ones), Eigen::Vector3d(1, 1 + 0x1p-52, 1));
  const Eigen::Matrix3d all = Eigen::Matrix3d::Ones();
  for (Eigen::Index j = 0; j < 3; ++j) {
    EXPECT_EQ(matrix_product(rows, all).col(j), Eigen::Vector3d(1, 1 + 0x1p-52, 1));
  }
}

// (1 + 2^-30)^2 - 1 loses 2^-60 when the product is rounded before the sum.
TEST(Vector3, ProductsAreRounded) {
  const double x = 1 + 0x1p-30;
  EXPECT_EQ(dot({x, 1, 0}, {x, -1, 0}), 0x1p-29);
  EXPECT_EQ(cross({x, 1, 0}, {1, x, 0})[2], 0x1p-29);
}

TEST(Vector3, InverseIsExactWhereItCanBe) {
  Eigen::Matrix3d m;
  m << 2, 0, 1, 0, -4, 0, 0, 0, 0.5;
  Eigen::Matrix3d expected;
  expected << 0.5, 0, -1, 0, -0.25, 0, 0, 0, 2;
  EXPECT_EQ(inverse_of(m), expected);
  EXPECT_FALSE(inverse_of(Eigen::Matrix3d::Ones()).allFinite());
}

TEST(Vector3, InverseUndoesTheMap) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    Eigen::Matrix3d m = Eigen::Matrix3d::Identity() * 4;
    for (Eigen::Index k = 0; k < 9; ++k) m(k % 3, k / 3) += unit(random);
    const Eigen::Matrix3d residual = matrix_product(inverse_of(m), m) - Eigen::Matrix3d::Identity();
    EXPECT_LE(residual.cwiseAbs().maxCoeff(), 0x1p-48);
  }
}

}  // namespace
}  // namespace boxtree
