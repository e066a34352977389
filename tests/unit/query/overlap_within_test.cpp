// SPDX-License-Identifier: MIT
// Overlap in three values, against exact answers: pairs against overlap_pairs and distances against
// distance(), which have brute force of their own; boxes against the exact predicate, the box being
// a mesh of twelve triangles.
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/primitive/predicates.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/triangle_reference.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;

class OverlapWithin : public testing::TestWithParam<test::Encoding> {
 protected:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  // By turns a rotation, a scale, a mirror with a shear.
  Pose pose(int turn, double size) {
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::Quaterniond(between(-1, 1), between(-1, 1), between(-1, 1), 0.3)
                        .normalized()
                        .toRotationMatrix();
    if (turn % 3 == 1) pose.scale(Eigen::Vector3d(0.5, 2, 1.25));
    if (turn % 3 == 2) {
      Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
      shear(0, 1) = 0.5;
      shear(2, 2) = -1;
      pose.linear() *= shear;
    }
    pose.translation() =
        Eigen::Vector3d(between(-size, size), between(-size, size), between(-size, size));
    return pose;
  }

  std::mt19937_64 random_{17};
};

TEST_P(OverlapWithin, PairsAreCertainOrClose) {
  int hits = 0, frees = 0, undecided = 0, spent = 0;
  std::vector<std::uint64_t> nodes(6);
  for (const SourceMesh& a : {test::torus(40, 24), test::city(9, 2)}) {
    for (const SourceMesh& b : {test::torus(24, 16), test::soup(60, 3), test::duplicates(1)}) {
      const test::CookedTree first = test::cook_tree(a, GetParam());
      const test::CookedTree second = test::cook_tree(b, GetParam());
      for (int turn = 0; turn < 12; ++turn) {
        SCOPED_TRACE(a.name + " and " + b.name + ", turn " + std::to_string(turn));
        const Pose p = pose(turn, 1), q = pose(turn / 2, 3);
        const bool touch = first_contact(first.tree, p, second.tree, q).has_value();
        const double apart = distance(first.tree, p, second.tree, q)->upper;
        std::uint64_t last = kUnlimitedNodes;
        const std::vector<double> distances{0, 1e-3, 0.1, 0.5, 2, 1e9};
        for (std::size_t i = 0; i < distances.size(); ++i) {
          const auto found = overlap_within(first.tree, p, second.tree, q, distances[i]);
          ASSERT_TRUE(found.ok());
          ASSERT_EQ(found->contact.has_value(), found->overlap == Overlap::kOverlapping);
          ASSERT_NE(found->overlap, Overlap::kBudgetSpent);
          if (found->overlap == Overlap::kOverlapping) {
            ASSERT_TRUE(touch);
          }
          if (found->overlap == Overlap::kDisjoint) {
            ASSERT_FALSE(touch);
          }
          if (found->overlap == Overlap::kUndecided) {
            ASSERT_LT(apart, distances[i]);
          }
          hits += found->overlap == Overlap::kOverlapping;
          frees += found->overlap == Overlap::kDisjoint;
          undecided += found->overlap == Overlap::kUndecided;
          ASSERT_LE(found->nodes_expanded, last);
          last = found->nodes_expanded;
          nodes[i] += last;
        }
        for (const std::uint64_t budget : {0u, 1u, 5u, 20u}) {
          const auto found = overlap_within(first.tree, p, second.tree, q, 0, budget);
          ASSERT_LE(found->nodes_expanded, budget);
          ASSERT_NE(found->overlap, Overlap::kUndecided);
          if (found->overlap == Overlap::kOverlapping) {
            ASSERT_TRUE(touch);
          }
          if (found->overlap == Overlap::kDisjoint) {
            ASSERT_FALSE(touch);
          }
          spent += found->overlap == Overlap::kBudgetSpent;
        }
      }
    }
  }
  EXPECT_GT(hits, 20);
  EXPECT_GT(frees, 20);
  EXPECT_GT(undecided, 20);
  EXPECT_GT(spent, 20);
  EXPECT_LT(nodes[3], nodes[0]);
  EXPECT_EQ(nodes[5], 0u);
}

// Two triangles on either side of the origin, whose boxes share little more than that.
TEST_P(OverlapWithin, FarCornersCountOnEitherSideOfTheOrigin) {
  const auto triangle = [](std::size_t axis, float far, float near) {
    std::array<float, 9> corner{};
    const std::size_t x = axis, y = (axis + 1) % 3;
    corner[x] = corner[y] = corner[3 + x] = corner[6 + y] = far;
    corner[3 + y] = corner[6 + x] = near;
    SourceMesh mesh;
    mesh.positions.f32.assign(corner.begin(), corner.end());
    mesh.faces.push_back({{0, 1, 2, cooker::kNoCorner}});
    return test::cook_tree(mesh, GetParam());
  };
  const Pose here = Pose::Identity();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Long sides lie in the planes x + y = -9 and x + y = 9: more than 12 apart.
    const test::CookedTree low = triangle(axis, -10, 1), high = triangle(axis, 10, -1);
    const auto overlap = [&](const test::CookedTree& first, const test::CookedTree& second,
                             double distance) {
      return overlap_within(first.tree, here, second.tree, here, distance)->overlap;
    };
    EXPECT_EQ(overlap(low, high, 12), Overlap::kDisjoint) << axis;
    EXPECT_EQ(overlap(high, low, 12), Overlap::kDisjoint) << axis;
    EXPECT_EQ(overlap(low, high, 40), Overlap::kUndecided) << axis;
    EXPECT_EQ(overlap(high, low, 40), Overlap::kUndecided) << axis;
  }
}

// Twelve triangles of a box, as an object of its own.
std::vector<Triangle> sides_of(const Eigen::AlignedBox3d& box) {
  std::vector<Triangle> sides;
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (const bool high : {false, true}) {
      std::vector<Eigen::Vector3d> corner;
      for (const unsigned code : {0u, 1u, 3u, 2u}) {
        Eigen::Vector3d c;
        c[axis] = high ? box.max()[axis] : box.min()[axis];
        c[(axis + 1) % 3] = ((code & 1u) != 0 ? box.max() : box.min())[(axis + 1) % 3];
        c[(axis + 2) % 3] = ((code & 2u) != 0 ? box.max() : box.min())[(axis + 2) % 3];
        corner.push_back(c);
      }
      sides.push_back({{corner[0], corner[1], corner[2]}});
      sides.push_back({{corner[0], corner[2], corner[3]}});
    }
  }
  return sides;
}

TEST_P(OverlapWithin, BoxesAreCertainOrClose) {
  int hits = 0, frees = 0, undecided = 0, spent = 0;
  for (const SourceMesh& mesh : {test::torus(12, 8), test::city(9, 2), test::slivers(60, 4)}) {
    SCOPED_TRACE(mesh.name);
    const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
    std::vector<Triangle> triangles = test::all_triangles(cooked.tree);
    for (Triangle& t : triangles) {
      for (auto& c : t.corner)
        c = BoundTree::of(cooked.tree).frame().to_object(c);  // a power of two: exact
    }
    const Eigen::AlignedBox3d bounds =
        BoundTree::of(cooked.tree).to_object(BoundTree::of(cooked.tree).root().box);
    for (int turn = 0; turn < 40; ++turn) {
      Eigen::Vector3d a, b;
      for (Eigen::Index k = 0; k < 3; ++k) {
        a[k] = between(bounds.min()[k] - 0.5, bounds.max()[k] + 0.5);
        b[k] = a[k] + between(-0.3, 0.3);
      }
      if (turn % 4 == 1) a[turn % 3] = b[turn % 3];                                // flat
      if (turn % 4 == 2) a = triangles[static_cast<std::size_t>(turn)].corner[0];  // touching
      const Eigen::AlignedBox3d box(a.cwiseMin(b), a.cwiseMax(b));
      bool touch = false;
      double apart = std::numeric_limits<double>::infinity();
      const std::vector<Triangle> sides = sides_of(box);
      for (const Triangle& t : triangles) {
        touch = touch || box.contains(t.corner[0]);
        for (const Triangle& side : sides) touch = touch || triangles_intersect(t, side);
      }
      for (std::size_t i = 0; i < triangles.size() && !touch; ++i) {
        for (const Triangle& side : sides) {
          apart = std::min(apart, triangle_distance(triangles[i], side).upper);
        }
      }
      if (touch) apart = 0;
      std::uint64_t last = kUnlimitedNodes;
      for (const double distance : {0.0, 1e-3, 0.1, 1.0, 1e9}) {
        const auto found = overlap_box_within(cooked.tree, box, distance);
        ASSERT_TRUE(found.ok());
        ASSERT_EQ(found->face.has_value(), found->overlap == Overlap::kOverlapping);
        if (found->overlap == Overlap::kOverlapping) {
          ASSERT_TRUE(touch);
        }
        if (found->overlap == Overlap::kDisjoint) {
          ASSERT_FALSE(touch);
        }
        if (found->overlap == Overlap::kUndecided) {
          ASSERT_LT(apart, distance);
        }
        ASSERT_LE(found->nodes_expanded, last);
        last = found->nodes_expanded;
        hits += found->overlap == Overlap::kOverlapping;
        frees += found->overlap == Overlap::kDisjoint;
        undecided += found->overlap == Overlap::kUndecided;
      }
      for (const std::uint64_t budget : {0u, 1u, 3u}) {
        const auto found = overlap_box_within(cooked.tree, box, 0, budget);
        ASSERT_LE(found->nodes_expanded, budget);
        if (found->overlap == Overlap::kOverlapping) {
          ASSERT_TRUE(touch);
        }
        if (found->overlap == Overlap::kDisjoint) {
          ASSERT_FALSE(touch);
        }
        spent += found->overlap == Overlap::kBudgetSpent;
      }
    }
  }
  EXPECT_GT(hits, 20);
  EXPECT_GT(frees, 20);
  EXPECT_GT(undecided, 20);
  EXPECT_GT(spent, 20);
}

TEST_P(OverlapWithin, RefusesWhatHasNoMeaning) {
  const test::CookedTree cooked = test::cook_tree(test::city(1, 2), GetParam());
  const Pose here = Pose::Identity();
  for (const double bad : {-1.0, static_cast<double>(NAN)}) {
    EXPECT_EQ(overlap_within(cooked.tree, here, cooked.tree, here, bad).error().message(),
              "invalid_query: distance: expected 0 or more");
    const Eigen::AlignedBox3d box(Eigen::Vector3d(0, 0, 0));
    EXPECT_EQ(overlap_box_within(cooked.tree, box, bad).error().message(),
              "invalid_query: distance: expected 0 or more");
  }
  EXPECT_EQ(overlap_box_within(cooked.tree, Eigen::AlignedBox3d(), 0).error().message(),
            "invalid_query: box: expected finite corners, min not above max on any axis");
  Pose flat = here;
  flat.linear().row(1).setZero();
  EXPECT_EQ(overlap_within(cooked.tree, here, cooked.tree, flat, 0).code(), Errc::kInvalidPose);
}

INSTANTIATE_TEST_SUITE_P(Encodings, OverlapWithin, testing::ValuesIn(test::all_encodings()),
                         test::encoding_name);

}  // namespace
}  // namespace boxtree
