// SPDX-License-Identifier: MIT
// Poses of profiles against Eigen's, and every way to write them wrong.
#include "cooker/scene/profile_pose.h"

#include <tests/unit/scene/profile_files.h>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace boxtree::cooker {
namespace {

constexpr double kPi = static_cast<double>(EIGEN_PI);

// Rotation after scale; the same rotation in three ways.
TEST_F(ProfileTest, Rotations) {
  const Profile profile = load(R"([[mesh]]
name = "m"
file = "m.obj"
[[instance]]
mesh = "m"
axis = [0, 0, 7]
degrees = 90
scale = 2
[[instance]]
mesh = "m"
rotation = [0, 0, 0.70710678, 0.70710678]
[[instance]]
mesh = "m"
axis = [1, 2, 3]
degrees = -450
)");
  const Pose& first = profile.instances[0].pose;
  EXPECT_EQ(first * Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 2, 0)) << "exact";
  EXPECT_EQ(first * Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(-2, 0, 0));
  const Eigen::Matrix3d expected =
      Eigen::AngleAxisd(kPi / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_TRUE(profile.instances[1].pose.linear().isApprox(expected, 1e-15));
  const Eigen::Matrix3d slanted =
      Eigen::AngleAxisd(-kPi / 2, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  EXPECT_TRUE(profile.instances[2].pose.linear().isApprox(slanted, 1e-15));
}

TEST(RotationAbout, AgreesWithTheLibraryForAllAngles) {
  const Eigen::Vector3d axis(2, -1, 0.5);
  for (int k = -2000; k <= 2000; ++k) {
    const double degrees = 0.37 * k;
    const Eigen::Matrix3d expected =
        Eigen::AngleAxisd(degrees * (kPi / 180), axis.normalized()).toRotationMatrix();
    ASSERT_LE((rotation_about(axis, degrees) - expected).cwiseAbs().maxCoeff(), 4e-15) << degrees;
  }
}

TEST(RotationOf, AgreesWithTheLibrary) {
  const Eigen::Vector4d q(0.1, -0.7, 0.3, 0.5);
  const Eigen::Quaterniond expected = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized();
  EXPECT_TRUE(rotation_of(q).isApprox(expected.toRotationMatrix(), 1e-15));
}

TEST(IsInvertible, WhateverTheUnit) {
  Eigen::Matrix3d m;
  m << 1, 2, 3, 4, 5, 6, 7, 8, 9;  // singular
  Eigen::Matrix3d good = m;
  good(2, 2) = 10;
  for (const double unit : {1e-150, 1e-30, 1.0, 1e30, 1e150}) {
    EXPECT_FALSE(is_invertible(m * unit)) << unit;
    EXPECT_TRUE(is_invertible(good * unit)) << unit;
  }
  m << 1e-12, 0, 0, 0, 1, 0, 0, 0, 1e12;
  EXPECT_TRUE(is_invertible(m)) << "flat, but not singular";
  EXPECT_FALSE(is_invertible(Eigen::Matrix3d::Zero()));
}

class PoseFaultTest : public ProfileTest, public ::testing::WithParamInterface<ProfileFault> {};
TEST_P(PoseFaultTest, NamesLineAndWhatWouldBeRight) {
  const std::string before = "[[mesh]]\nname='m'\nfile='m'\n[[instance]]\nmesh='m'\n";
  EXPECT_EQ(fault(before + GetParam().text), "scene.toml:" + std::string(GetParam().message));
}
constexpr ProfileFault kPoses[] = {
    {"rotation = [0, 0, 0, 2]",
     "6: rotation: expected a quaternion x, y, z, w of length 1, found "
     "one of length 2"},
    {"rotation = [0, 0, 0, 0]",
     "6: rotation: expected a quaternion x, y, z, w of length 1, found "
     "one of length 0"},
    {"rotation = [0, 0, 1]",
     "6: rotation: expected the four numbers x, y, z, w of a quaternion, "
     "found an array of 3"},
    {"rotation = [0, 0, 0, nan]", "6: rotation: expected a finite number, found nan"},
    {"translation = [1, 2]", "6: translation: expected three numbers, found an array of 2"},
    {"translation = [1, 2,\n'x']", "7: translation: expected a finite number, found \"x\""},
    {"axis = [0, 0, 1]", "6: axis: expected \"axis\" and \"degrees\" together, found one of them"},
    {"degrees = 4", "6: degrees: expected \"axis\" and \"degrees\" together, found one of them"},
    {"axis = [0, 0, 0]\ndegrees = 4", "6: axis: expected a direction, found 0, 0, 0"},
    {"degrees = 4\naxis = [0, 0, 1]\nrotation = [0, 0, 0, 1]",
     "8: rotation: expected either \"rotation\" or \"axis\", found both"},
    {"scale = 0", "6: scale: expected numbers other than 0, found 0"},
    {"scale = [1, 0, 1]", "6: scale: expected numbers other than 0, found 0"},
    {"scale = [1, 2]", "6: scale: expected a number or three, found an array of 2"},
    {"scale = 'big'", "6: scale: expected a number or three, found \"big\""},
    {"matrix = [1, 2, 3, 0, 4, 5, 6, 0, 7, 8, 9, 0]",
     "6: matrix: expected an invertible matrix, found a singular one"},
    {"matrix = [1, 2, 3]",
     "6: matrix: expected twelve numbers, three rows of four, found an array of 3"},
    {"scale = 2\nmatrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]",
     "7: matrix: expected either \"matrix\" or \"scale\", found both"},
};
INSTANTIATE_TEST_SUITE_P(Poses, PoseFaultTest, ::testing::ValuesIn(kPoses));

}  // namespace
}  // namespace boxtree::cooker
