// SPDX-License-Identifier: MIT
// Bounds of stretch against a singular value decomposition, rule S3 against figures worked out by
// hand.
#include "cooker/scene/precision.h"

#include <cmath>
#include <random>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <gtest/gtest.h>

namespace boxtree::cooker {
namespace {

double true_stretch(const Eigen::Matrix3d& linear) {
  using Wide = Eigen::Matrix<long double, 3, 3>;
  return static_cast<double>(
      Eigen::JacobiSVD<Wide>(linear.cast<long double>()).singularValues()[0]);
}

TEST(LargestStretch, ExactAlongAxes) {
  Eigen::Matrix3d m = Eigen::Matrix3d::Identity();
  EXPECT_EQ(largest_stretch(m), 1);
  m.diagonal() = Eigen::Vector3d(0.25, -3, 2);
  EXPECT_EQ(largest_stretch(m), 3);
  m << 0, -0.1, 0, 0.1, 0, 0, 0, 0, 0.1;
  EXPECT_EQ(largest_stretch(m), 0.1);
}

TEST(LargestStretch, NeverBelowAndHardlyAbove) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> number(-1, 1);
  std::uniform_int_distribution<int> exponent(-200, 200);
  for (int round = 0; round < 20000; ++round) {
    Eigen::Matrix3d m;
    for (int k = 0; k < 9; ++k) m(k / 3, k % 3) = number(random);
    if (round % 4 == 1) m.row(2) = 2 * m.row(0) - m.row(1);           // singular
    if (round % 4 == 2) m.col(0) *= std::ldexp(1, exponent(random));  // badly scaled
    if (round % 4 == 3) m *= std::ldexp(1, exponent(random));
    const double truth = true_stretch(m);
    const double bound = largest_stretch(m);
    ASSERT_GE(bound, truth * (1 - 1e-15)) << m;
    ASSERT_LE(bound, truth * 1.0001) << m;
  }
}

// Directions that no matrix of the bound may stretch by more.
TEST(LargestStretch, HoldsForEveryVector) {
  std::mt19937_64 random(8);
  std::normal_distribution<double> number;
  for (int round = 0; round < 200; ++round) {
    Eigen::Matrix3d m;
    for (int k = 0; k < 9; ++k) m(k / 3, k % 3) = number(random);
    const double bound = largest_stretch(m);
    for (int k = 0; k < 200; ++k) {
      const Eigen::Vector3d v(number(random), number(random), number(random));
      ASSERT_LE((m * v).norm(), bound * v.norm());
    }
  }
}

TEST(LargestStretch, RotationsAreNearlyOne) {
  for (int k = 1; k < 100; ++k) {
    const Eigen::Matrix3d rotation =
        Eigen::AngleAxisd(k, Eigen::Vector3d(1, k, 3).normalized()).toRotationMatrix();
    EXPECT_NEAR(largest_stretch(rotation), 1, 1e-4);
    EXPECT_GE(largest_stretch(rotation), true_stretch(rotation) * (1 - 1e-15));
  }
}

ContactRule rule_of(double stiffness, double mass, double jump) {
  ContactRule rule;
  rule.stiffness.value = stiffness;
  rule.mass.value = mass;
  rule.jump.value = jump;
  return rule;
}

// d = sqrt(2e-3 m g L / k), with a jump of a thousandth of L.
TEST(LargestSurfaceError, OfAJump) {
  // sqrt(2 * 1 * 9.81 * 0.001 / 1e6) = sqrt(1.962e-8)
  EXPECT_NEAR(largest_surface_error(rule_of(1e6, 1, 0.001)), 1.400714104e-4, 1e-13);
  // sqrt(2 * 80 * 9.81 * 0.0005 / 2e5) = sqrt(3.924e-6)
  EXPECT_NEAR(largest_surface_error(rule_of(2e5, 80, 0.0005)), 1.980908882e-3, 1e-12);
  ContactRule moon = rule_of(1e6, 1, 0.002);
  moon.gravity.value = 2;
  EXPECT_NEAR(largest_surface_error(moon), 8.944271910e-5, 1e-14);  // sqrt(8e-9)
}

// d = 0.1 m g / k.
TEST(LargestSurfaceError, Invisible) {
  ContactRule rule = rule_of(1e6, 1, 0.001);
  rule.invisible.value = true;
  EXPECT_NEAR(largest_surface_error(rule), 9.81e-7, 1e-21);
  rule.mass.value = 80;
  EXPECT_NEAR(largest_surface_error(rule), 7.848e-5, 1e-19);
}

// The energy that a swap of surfaces stores lifts the body by no more than was allowed.
TEST(LargestSurfaceError, EnergyIsThatOfTheJump) {
  for (const double stiffness : {1e3, 1e5, 1e8}) {
    const double d = largest_surface_error(rule_of(stiffness, 3, 0.01));
    EXPECT_NEAR(0.5 * stiffness * d * d, 3 * 9.81 * 0.01, 1e-14);
  }
}

TEST(DividedBelow, NeverAbove) {
  EXPECT_EQ(divided_below(1, 4), 0.25);
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> number(0.1, 10);
  int rounded = 0;
  for (int round = 0; round < 10000; ++round) {
    const double length = number(random), scale = number(random);
    const double quotient = divided_below(length, scale);
    // 106 bits of a product of doubles need more than a long double holds: both halves apart.
    const double product = quotient * scale;
    const double rest = std::fma(quotient, scale, -product);
    ASSERT_TRUE(product < length || (product == length && rest <= 0));
    ASSERT_GE(quotient, length / scale * (1 - 1e-15));
    rounded += quotient < length / scale ? 1 : 0;
  }
  EXPECT_GT(rounded, 1000);
}

}  // namespace
}  // namespace boxtree::cooker
