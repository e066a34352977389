// SPDX-License-Identifier: MIT
// Contacts of two trees whose sizes, scales and offsets differ by any power of two: the same pairs
// as a loop over all triangles, whatever the codecs, the order of the trees and the pose. Float
// filters once lost all of them where a product overflowed.
#include <cmath>
#include <random>
#include <set>
#include <utility>

#include <gtest/gtest.h>

#include "runtime/primitive/predicates.h"
#include "runtime/query/pair_walk.h"
#include "runtime/query/relative_pose.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/require.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;
using test::CookedTree;
using test::require;

using Pairs = std::set<std::pair<std::uint32_t, std::uint32_t>>;

struct Placed {
  const Tree& tree;
  Pose pose;
};

SourceMesh mesh_of(const std::vector<Triangle>& triangles, cooker::Precision precision) {
  SourceMesh mesh;
  mesh.positions.precision = precision;
  for (const Triangle& t : triangles) {
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Eigen::Vector3d& c : t.corner) {
      for (const double x : c) {
        if (precision == cooker::Precision::kF32) {
          mesh.positions.f32.push_back(static_cast<float>(x));
        } else {
          mesh.positions.f64.push_back(x);
        }
      }
    }
    mesh.faces.push_back({{first, first + 1, first + 2, cooker::kNoCorner}});
  }
  return mesh;
}

class PairRange : public testing::Test {
 protected:
  double unit() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  // A float, so that f32 meshes hold it times any power of two.
  Eigen::Vector3d point() {
    const auto x = static_cast<float>(unit()), y = static_cast<float>(unit());
    return {x, y, static_cast<float>(unit())};
  }
  std::vector<Triangle> soup(int count) {
    std::vector<Triangle> triangles;
    for (int i = 0; i < count; ++i) triangles.push_back({{point(), point(), point()}});
    return triangles;
  }
  // Triangles with the origin inside: exactly, for coordinates of eight bits.
  std::vector<Triangle> through_the_middle(int count) {
    std::vector<Triangle> triangles;
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d a = (point() * 0x1p7).array().round() * 0x1p-7;
      const Eigen::Vector3d b = (point() * 0x1p7).array().round() * 0x1p-7;
      triangles.push_back({{a, b, -(a + b)}});
    }
    return triangles;
  }
  // Some of each.
  std::vector<Triangle> mixed(int count) {
    std::vector<Triangle> triangles = soup(count);
    const std::vector<Triangle> more = through_the_middle(count / 4);
    triangles.insert(triangles.end(), more.begin(), more.end());
    return triangles;
  }
  static std::vector<Triangle> scaled(std::vector<Triangle> triangles, int exponent,
                                      const Eigen::Vector3d& offset = Eigen::Vector3d::Zero()) {
    for (Triangle& t : triangles) {
      for (Eigen::Vector3d& c : t.corner) c = (c + offset) * std::ldexp(1.0, exponent);
    }
    return triangles;
  }

  static Pairs found(const Placed& first, const Placed& second) {
    Pairs pairs;
    const auto visit =
        overlap_pairs(first.tree, first.pose, second.tree, second.pose, [&](const FacePair& pair) {
          EXPECT_TRUE(pairs.emplace(pair.first.id, pair.second.id).second) << "reported twice";
          return true;
        });
    EXPECT_TRUE(visit.ok()) << visit.error().detail;
    return pairs;
  }

  // By brute force in the first one's tree space.
  static Pairs expected(const Placed& first, const SourceMesh& first_mesh, const Placed& second,
                        const SourceMesh& second_mesh) {
    const auto pose = RelativePose::make(BoundTree::of(first.tree), first.pose,
                                         BoundTree::of(second.tree), second.pose);
    EXPECT_TRUE(pose.has_value());
    Pairs pairs;
    const auto triangle = [](const Tree& tree, const SourceMesh& mesh, std::uint32_t face) {
      Triangle t;
      for (std::size_t c = 0; c < 3; ++c) {
        t.corner[c] =
            BoundTree::of(tree).frame().to_tree(mesh.positions[mesh.faces[face].corner[c]]);
      }
      return t;
    };
    for (std::uint32_t j = 0; j < second_mesh.faces.size(); ++j) {
      const Triangle moved = pose->to_first().apply(triangle(second.tree, second_mesh, j));
      for (std::uint32_t i = 0; i < first_mesh.faces.size(); ++i) {
        if (triangles_intersect(triangle(first.tree, first_mesh, i), moved)) pairs.emplace(i, j);
      }
    }
    return pairs;
  }

  // Every pair of the codecs that walk differently, both orders. Returns the contacts of the first
  // order.
  std::size_t compare(const SourceMesh& a, const Pose& pose_a, const SourceMesh& b,
                      const Pose& pose_b, const std::string& what) {
    SCOPED_TRACE(what);
    std::size_t contacts = 0;
    for (const auto& [codec_a, codec_b] : {std::pair{CodecId::kWide8, CodecId::kWide8},
                                           {CodecId::kWide4, CodecId::kWide4},
                                           {CodecId::kWide8, CodecId::kWide4},
                                           {CodecId::kPlainF32, CodecId::kPlainF32},
                                           {CodecId::kPackedF16, CodecId::kWide8}}) {
      SCOPED_TRACE(std::string(codec_name(codec_a)) + " " + std::string(codec_name(codec_b)));
      const CookedTree first = test::cook_tree(a, codec_a), second = test::cook_tree(b, codec_b);
      const Placed one{first.tree, pose_a}, other{second.tree, pose_b};
      const Pairs forward = found(one, other);
      EXPECT_EQ(forward, expected(one, a, other, b));
      EXPECT_EQ(found(other, one), expected(other, b, one, a));
      contacts = forward.size();
    }
    return contacts;
  }

  std::mt19937_64 random_{17};
};

// The case that was reported: large triangles through the middle of a small soup, no pose.
TEST_F(PairRange, LargeTrianglesThroughASmallSoup) {
  const SourceMesh small = mesh_of(mixed(24), cooker::Precision::kF32);
  const std::vector<Triangle> large = through_the_middle(16);
  for (int e = -100; e <= 100; e += 5) {
    const SourceMesh other = mesh_of(scaled(large, e), cooker::Precision::kF32);
    EXPECT_GT(
        compare(small, Pose::Identity(), other, Pose::Identity(), "size 2^" + std::to_string(e)),
        0u);
  }
}

// A scale in the pose undoes that of the mesh: the very same contacts at every exponent.
TEST_F(PairRange, ScaleOfThePoseUndoesThatOfTheMesh) {
  const std::vector<Triangle> triangles = soup(30);
  const SourceMesh first = mesh_of(soup(30), cooker::Precision::kF64);
  std::size_t contacts = 0;
  for (int e = -900; e <= 900; e += 60) {
    const SourceMesh second = mesh_of(scaled(triangles, -e), cooker::Precision::kF64);
    Pose pose = Pose::Identity();
    pose.linear() *= std::ldexp(1.0, e);
    const std::size_t now =
        compare(first, Pose::Identity(), second, pose, "scale 2^" + std::to_string(e));
    if (contacts != 0) {
      EXPECT_EQ(now, contacts) << e;
    }
    contacts = now;
    EXPECT_GT(contacts, 0u);
  }
}

// Both poses scaled alike.
TEST_F(PairRange, OnlyTheRelationOfThePosesCounts) {
  const SourceMesh first = mesh_of(soup(20), cooker::Precision::kF32);
  const SourceMesh second = mesh_of(soup(20), cooker::Precision::kF32);
  const Pose at = [&] {
    Pose pose = Pose::Identity();
    pose.translate(0.3 * point());
    pose.rotate(Eigen::AngleAxisd(1, Eigen::Vector3d(1, 2, 3).normalized()));
    return pose;
  }();
  std::size_t contacts = 0;
  for (int e = -900; e <= 900; e += 100) {
    Pose one = Pose::Identity(), other = at;
    one.affine() *= std::ldexp(1.0, e);
    other.affine() *= std::ldexp(1.0, e);
    const std::size_t now = compare(first, one, second, other, "both 2^" + std::to_string(e));
    if (contacts != 0) {
      EXPECT_EQ(now, contacts) << e;
    }
    contacts = now;
    EXPECT_GT(contacts, 0u);
  }
}

// Baked far from the origin, brought back by the pose under a scale.
TEST_F(PairRange, BakedFarOutAndScaled) {
  const SourceMesh first = mesh_of(mixed(24), cooker::Precision::kF32);
  const Eigen::Vector3d offset = Eigen::Vector3d::Constant(0x1p16);
  const SourceMesh second = mesh_of(scaled(mixed(24), 0, offset), cooker::Precision::kF32);
  for (const int e : {0, 20, 60, 90, 94, 96, 97, 98, 100, 110, 120}) {
    Pose pose = Pose::Identity();
    pose.linear() *= std::ldexp(1.0, e);
    pose.translation() = -offset * std::ldexp(1.0, e);
    EXPECT_GT(compare(first, Pose::Identity(), second, pose, "2^" + std::to_string(e)), 0u);
  }
}

// Turned, sheared, mirrored and stretched by any power on each axis.
TEST_F(PairRange, AnyAffinePose) {
  const SourceMesh first = mesh_of(soup(24), cooker::Precision::kF32);
  const SourceMesh second = mesh_of(soup(24), cooker::Precision::kF32);
  std::size_t contacts = 0;
  for (int i = 0; i < 120; ++i) {
    const int range = 1 + 140 * (i % 4);  // of exponents: none, and up to 2^+-420
    const auto power = [&] { return std::ldexp(1.0, static_cast<int>(0.5 * range * unit())); };
    Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
    shear(0, 1) = unit();
    shear(2, 0) = i % 3 == 0 ? unit() * power() : 0;
    const Eigen::Quaterniond turn = Eigen::Quaterniond{unit(), unit(), unit(), unit()}.normalized();
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::Vector3d(power(), power(), -power()).asDiagonal();
    if (i % 2 == 0) pose.linear() = pose.linear() * turn.toRotationMatrix() * shear;
    pose.translation() = 0.2 * pose.linear().cwiseAbs().maxCoeff() * point();
    Pose back = Pose::Identity();
    if (i % 5 == 0) back.linear() = pose.linear();
    const auto relative_works = [&] {
      const CookedTree a = test::cook_tree(first, CodecId::kPlainF32);
      const CookedTree b = test::cook_tree(second, CodecId::kPlainF32);
      const BoundTree& in_a = BoundTree::of(a.tree);
      const BoundTree& in_b = BoundTree::of(b.tree);
      return RelativePose::make(in_a, back, in_b, pose) &&
             RelativePose::make(in_b, pose, in_a, back);
    };
    if (!relative_works())
      continue;  // cannot be undone in double, or leads beyond kMaxCoordinate: refused
    contacts += compare(first, back, second, pose, "pose " + std::to_string(i));
  }
  EXPECT_GT(contacts, 500u);
}

}  // namespace
}  // namespace boxtree
