// SPDX-License-Identifier: MIT
// Distances of trees against brute force in extended precision over the decoded triangles: bounds
// are true and as near as requested, for every codec, store, pose, error and budget.
#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/primitive/predicates.h"
#include "runtime/query/relative_pose.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/triangle_reference.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;

struct Truth {
  long double distance = std::numeric_limits<long double>::infinity();
  long double size = 0;  // how far apart the farthest corners are: what rounding is relative to
};

// The distance in the world, of the second tree's triangles where double puts them in the first
// one's space. Spheres around triangles rule out most pairs.
Truth brute_force(const Tree& first, const Pose& first_pose, const Tree& second,
                  const Pose& second_pose) {
  const auto pose =
      RelativePose::make(BoundTree::of(first), first_pose, BoundTree::of(second), second_pose);
  EXPECT_TRUE(pose.has_value());
  const Eigen::Matrix<long double, 3, 3> to_world =
      first_pose.linear().cast<long double>() *
      std::ldexp(1.0L, BoundTree::of(first).scale_exponent());
  struct Placed {
    Triangle local;
    test::LongTriangle world;
    test::LongVector center;
    long double radius;
  };
  std::vector<Placed> p, q;
  const auto place = [&](const Triangle& triangle) {
    Placed placed;
    placed.local = triangle;
    placed.center.setZero();
    for (std::size_t c = 0; c < 3; ++c) {
      placed.world[c] = to_world * triangle.corner[c].cast<long double>();
      placed.center += placed.world[c] / 3;
    }
    placed.radius = 0;
    for (const auto& c : placed.world) {
      placed.radius = std::max(placed.radius, (c - placed.center).norm());
    }
    return placed;
  };
  for (const Triangle& triangle : test::all_triangles(first)) p.push_back(place(triangle));
  for (Triangle triangle : test::all_triangles(second)) {
    for (auto& c : triangle.corner) c = pose->to_first().apply(c);
    q.push_back(place(triangle));
  }
  Truth truth;
  for (const Placed& a : p) {
    for (const Placed& b : q) {
      const long double centers = (a.center - b.center).norm();
      truth.size = std::max(truth.size, centers + a.radius + b.radius);
      if (centers - a.radius - b.radius > truth.distance) continue;
      truth.distance =
          triangles_intersect(a.local, b.local)
              ? 0
              : std::min(truth.distance, test::distance_in_extended_precision(a.world, b.world));
    }
  }
  return truth;
}

struct Random {
  std::mt19937_64 engine{11};
  double between(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  }
  Eigen::Vector3d vector(double size) {
    const double x = between(-size, size);
    const double y = between(-size, size);
    return {x, y, between(-size, size)};
  }
  // By turns a rotation, a scale, a mirror, a shear, a strong shear with uneven scales.
  Pose pose(int turn, double distance) {
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::Quaterniond(between(-1, 1), between(-1, 1), between(-1, 1), 0.3)
                        .normalized()
                        .toRotationMatrix();
    if (turn % 5 == 1) pose.scale(Eigen::Vector3d(0.5, 2, 1.25));
    if (turn % 5 == 2) pose.scale(Eigen::Vector3d(-1, 1, 1));
    if (turn % 5 >= 3) {
      Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
      shear(0, 1) = turn % 5 == 3 ? 0.5 : 3;
      shear(1, 2) = -0.75;
      pose.linear() *= shear;
    }
    if (turn % 5 == 4) pose.scale(Eigen::Vector3d(1, 0.01, 0.3));
    pose.translation() = vector(distance);
    return pose;
  }
};

void check_bounds(const Distance& found, const Truth& truth) {
  ASSERT_LE(found.lower, truth.distance * (1 + 1e-17L) + 1e-18L * truth.size);
  ASSERT_GE(found.upper, truth.distance - 1e-18L * truth.size);
  ASSERT_LE(found.lower, found.upper);
  ASSERT_EQ(found.witness.has_value(), std::isfinite(found.upper));
}

// Two points that far apart, each on the face that is named. `place` is the size of world
// coordinates, which limits how well they can be told.
void check_witness(const Distance& found, const SourceMesh& a, const Pose& a_pose,
                   const SourceMesh& b, const Pose& b_pose, double place) {
  const DistanceWitness& witness = *found.witness;
  ASSERT_NEAR((witness.first - witness.second).norm(), found.upper, 1e-12 * place);
  const auto off = [](const SourceMesh& mesh, const Pose& pose, const FaceRef& face,
                      const Eigen::Vector3d& x) {
    const cooker::Face& f = mesh.faces[face.id];
    const auto at = [&](std::size_t i) -> Eigen::Vector3d {
      return pose * mesh.positions[f.corner[i]];
    };
    double least = test::distance_in_extended_precision(x, Triangle{{at(0), at(1), at(2)}});
    if (f.is_quad()) {
      const Triangle half{{at(0), at(2), at(3)}};
      least = std::min(least, test::distance_in_extended_precision(x, half));
    }
    return least;
  };
  ASSERT_LE(off(a, a_pose, witness.faces.first, witness.first), 1e-12 * place);
  ASSERT_LE(off(b, b_pose, witness.faces.second, witness.second), 1e-12 * place);
}

class Distances : public testing::TestWithParam<test::Encoding> {
 protected:
  static test::CookedTree cook(const SourceMesh& mesh) { return test::cook_tree(mesh, GetParam()); }

  // Each pair of a few meshes in each kind of pose, apart and touching. With a grid, faces of the
  // source are not those that were queried, so `exact` tells whether they may be compared.
  template <class Body>
  void for_each_case(int poses, Body body) {
    const std::vector<SourceMesh> meshes{test::torus(12, 8), test::city(9, 2), test::slivers(40, 4),
                                         test::duplicates(1)};
    Random random;
    for (const SourceMesh& a : meshes) {
      const test::CookedTree first = cook(a);
      for (const SourceMesh& b : meshes) {
        const test::CookedTree second = cook(b);
        for (int turn = 0; turn < poses; ++turn) {
          SCOPED_TRACE(a.name + " and " + b.name + ", turn " + std::to_string(turn));
          const Pose first_pose = random.pose(turn, 3);
          const Pose second_pose = random.pose(turn / 2 + 2, 12);
          body(a, first.tree, first_pose, b, second.tree, second_pose);
          if (HasFatalFailure()) return;
        }
      }
    }
  }
};

TEST_P(Distances, BoundsAreTrueAndAsCloseAsRequested) {
  int apart = 0;
  std::uint64_t exact_nodes = 0, nodes_within = 0;
  for_each_case(10, [&](const SourceMesh& a, const Tree& first, const Pose& first_pose,
                        const SourceMesh& b, const Tree& second, const Pose& second_pose) {
    const Truth truth = brute_force(first, first_pose, second, second_pose);
    apart += truth.distance > 0;
    const auto size = static_cast<double>(truth.size);
    std::uint64_t nodes = std::numeric_limits<std::uint64_t>::max();
    for (const double error : {0.0, 1e-6, 1e-3, 0.01, 0.1, 0.5, 1.0}) {
      SCOPED_TRACE(error);
      const auto found = distance(first, first_pose, second, second_pose, {error, 0});
      ASSERT_TRUE(found.ok());
      ASSERT_TRUE(found->converged);
      check_bounds(*found, truth);
      ASSERT_LE(found->upper, found->lower * (1 + error) + 1e-12 * size);
      ASSERT_LE(found->nodes_expanded, nodes);
      nodes = found->nodes_expanded;
      if (error == 0) {
        ASSERT_EQ(found->upper == 0, truth.distance == 0);
        exact_nodes += nodes;
      }
      if (GetParam().geometry == GeometryId::kExact) {
        check_witness(*found, a, first_pose, b, second_pose, size + 50);
      }
      if (testing::Test::HasFatalFailure()) return;
    }
    for (const double error : {0.001, 0.1, 10.0}) {
      SCOPED_TRACE(error);
      const auto found = distance(first, first_pose, second, second_pose, {0, error});
      check_bounds(*found, truth);
      ASSERT_LE(found->upper, found->lower + error + 1e-12 * size);
      if (error == 0.1) nodes_within += found->nodes_expanded;
    }
  });
  EXPECT_GT(apart, 50);
  EXPECT_LT(nodes_within, exact_nodes);
}

TEST_P(Distances, BudgetsEndTheSearchWithTrueBounds) {
  int spent = 0;
  for_each_case(5, [&](const SourceMesh&, const Tree& first, const Pose& first_pose,
                       const SourceMesh&, const Tree& second, const Pose& second_pose) {
    const Truth truth = brute_force(first, first_pose, second, second_pose);
    double gap = std::numeric_limits<double>::infinity();
    for (const std::uint64_t budget : {0u, 1u, 10u, 40u, 1000u}) {
      SCOPED_TRACE(budget);
      DistanceOptions options;
      options.node_budget = budget;
      const auto found = distance(first, first_pose, second, second_pose, options);
      ASSERT_TRUE(found.ok());
      check_bounds(*found, truth);
      ASSERT_LE(found->nodes_expanded, budget);
      if (!found->converged) {
        ++spent;
        ASSERT_EQ(found->nodes_expanded, budget);
      }
      ASSERT_LE(found->upper - found->lower, gap);  // more nodes never tell less
      gap = found->upper - found->lower;
      if (testing::Test::HasFatalFailure()) return;
    }
    ASSERT_FALSE(
        distance(first, first_pose, second, second_pose, {0, 0, 1e300, 0})->witness.has_value());
  });
  EXPECT_GT(spent, 50);
}

// One of the children is below the triangle and all others are far from it: wherever the budget
// ends, what is left holds the nearest.
TEST_P(Distances, BudgetsLeaveTheNearestChildAmongWhatIsLeft) {
  constexpr std::uint32_t kRow = 256;
  constexpr double kStep = 64, kHeight = 2;
  const auto place = [](SourceMesh& mesh, std::uint32_t number, float height) {
    const float x = static_cast<float>(kStep * number);
    for (const float c : {x, 0.0F, height, x + 1, 0.0F, height, x, 1.0F, height}) {
      mesh.positions.f32.push_back(c);
    }
    const auto corner = static_cast<std::uint32_t>(mesh.positions.size() - 3);
    mesh.faces.push_back({{corner, corner + 1, corner + 2, cooker::kNoCorner}});
  };
  SourceMesh row;
  for (std::uint32_t i = 0; i < kRow; ++i) place(row, i, 0);
  const test::CookedTree second = cook(row);
  for (const std::uint32_t above : {0u, 100u, kRow - 1}) {
    SourceMesh one;
    place(one, above, static_cast<float>(kHeight));
    const test::CookedTree first = cook(one);
    const Truth truth = brute_force(first.tree, Pose::Identity(), second.tree, Pose::Identity());
    int spent = 0;
    for (std::uint64_t budget = 0; budget < 16; ++budget) {
      SCOPED_TRACE(budget);
      DistanceOptions options;
      options.node_budget = budget;
      const auto found =
          distance(first.tree, Pose::Identity(), second.tree, Pose::Identity(), options);
      ASSERT_TRUE(found.ok());
      check_bounds(*found, truth);
      spent += found->converged ? 0 : 1;
    }
    EXPECT_GT(spent, 1);
  }
}

TEST_P(Distances, NothingBeyondTheMaximalDistance) {
  std::uint64_t all_nodes = 0;
  std::uint64_t limited_nodes = 0;
  for_each_case(3, [&](const SourceMesh&, const Tree& first, const Pose& first_pose,
                       const SourceMesh&, const Tree& second, const Pose& second_pose) {
    const auto all = distance(first, first_pose, second, second_pose);
    const auto within = [&](double most) {
      DistanceOptions options;
      options.max_distance = most;
      return *distance(first, first_pose, second, second_pose, options);
    };
    const Distance found = within(1.001 * all->upper);
    ASSERT_EQ(found.upper, all->upper);
    ASSERT_TRUE(found.witness.has_value());
    if (all->lower == 0) return;
    all_nodes += all->nodes_expanded;
    const Distance nothing = within(0.9 * all->lower);
    ASSERT_FALSE(nothing.witness.has_value());
    ASSERT_TRUE(nothing.converged);
    ASSERT_GE(nothing.lower, 0.9 * all->lower * (1 - 1e-12));
    ASSERT_LE(nothing.lower, all->upper);
    limited_nodes += nothing.nodes_expanded;
  });
  EXPECT_LT(limited_nodes, all_nodes);
}

// Neither an allowed error nor a budget makes what is farther away count, and an error hides
// nothing that is not.
TEST_P(Distances, WhatIsFoundIsWithinTheMaximalDistanceWhateverIsAllowed) {
  for_each_case(3, [&](const SourceMesh&, const Tree& first, const Pose& first_pose,
                       const SourceMesh&, const Tree& second, const Pose& second_pose) {
    const auto all = distance(first, first_pose, second, second_pose);
    if (all->lower == 0) return;
    for (const double factor : {0.7, 0.95, 0.999, 1.001, 1.05, 1.4}) {
      SCOPED_TRACE(factor);
      const double most = factor * all->upper;
      for (const double share : {0.01, 0.1, 0.5}) {
        for (const DistanceOptions& options :
             {DistanceOptions{.relative_error = share, .max_distance = most},
              DistanceOptions{.absolute_error = share * all->upper, .max_distance = most}}) {
          const auto found = distance(first, first_pose, second, second_pose, options);
          ASSERT_TRUE(found->converged);
          ASSERT_EQ(found->witness.has_value(), factor > 1);
          ASSERT_LE(found->lower, all->upper);
          ASSERT_EQ(found->upper <= most, factor > 1);
          ASSERT_TRUE(factor > 1 || found->lower >= most * (1 - 1e-12));
        }
      }
      for (const std::uint64_t budget : {0u, 1u, 10u, 100u}) {
        const auto found = distance(first, first_pose, second, second_pose,
                                    {.max_distance = most, .node_budget = budget});
        ASSERT_EQ(found->witness.has_value(), found->upper <= most);
      }
    }
  });
}

// Only the relation of the two poses counts, also a thousand kilometres away and with trees of
// different codecs; and the distance is the same from either side.
TEST_P(Distances, DependsOnTheRelativePoseAlone) {
  const SourceMesh mesh = test::torus(12, 8);
  const test::CookedTree a = cook(mesh);
  const test::CookedTree b = test::cook_tree(test::city(4, 3), CodecId::kPackedF16);
  Random random;
  Pose away = Pose::Identity();
  away.translation() = Eigen::Vector3d(0x1p20, -0x1p20, 0x1p19);
  for (int i = 0; i < 20; ++i) {
    Pose pose = Pose::Identity();
    pose.translation() = Eigen::Vector3d(0.5 * i, 0.25 * (i % 5), 0.125);  // exact when moved away
    const auto here = distance(a.tree, Pose::Identity(), b.tree, pose);
    Pose there = pose;
    there.translation() += away.translation();
    const auto far = distance(a.tree, away, b.tree, there);
    ASSERT_EQ(here->lower, far->lower);
    ASSERT_EQ(here->upper, far->upper);
    const auto swapped = distance(b.tree, pose, a.tree, Pose::Identity());
    ASSERT_NEAR(here->upper, swapped->upper, 1e-12 * 20);
  }
}

INSTANTIATE_TEST_SUITE_P(Encodings, Distances, testing::ValuesIn(test::all_encodings()),
                         test::encoding_name);

// A known distance, with each way of scaling the world.
TEST(Distance, KnownCases) {
  const test::CookedTree cubes = test::cook_tree(test::city(1, 2), CodecId::kWide8);
  const Eigen::AlignedBox3d box =
      BoundTree::of(cubes.tree).to_object(BoundTree::of(cubes.tree).root().box);
  for (const double scale : {0x1p-300, 1e-3, 1.0, 0x1p300}) {
    Pose first = Pose::Identity();
    first.linear() *= scale;
    Pose second = first;
    second.translation() = Eigen::Vector3d(scale * (box.sizes().x() + 2), 0, 0);
    const auto found = distance(cubes.tree, first, cubes.tree, second);
    ASSERT_TRUE(found.ok());
    EXPECT_NEAR(found->lower / scale, 2, 1e-12);
    EXPECT_NEAR(found->upper / scale, 2, 1e-12);
    EXPECT_LE(found->lower, 2 * scale);
    EXPECT_GE(found->upper, 2 * scale);
  }
}

// A mesh that is one place, at small and large coordinates, and a square beside it: as long as
// double tells the corners of the square apart there, the coordinates do not matter.
TEST(Distance, OfAMeshThatIsOnePlace) {
  SourceMesh square;
  square.positions.precision = cooker::Precision::kF64;
  square.positions.f64 = {1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1};  // at x = 1
  square.faces = {{{0, 1, 2, cooker::kNoCorner}}, {{0, 2, 3, cooker::kNoCorner}}};
  const test::CookedTree beside = test::cook_tree(square, CodecId::kWide8);
  for (const int exponent : {-250, -100, -1, 0, 20, 50}) {
    SCOPED_TRACE(exponent);
    const Eigen::Vector3d place(std::ldexp(-1.61, exponent), std::ldexp(0.53, exponent),
                                std::ldexp(-0.91, exponent));
    SourceMesh mesh;
    mesh.positions.precision = cooker::Precision::kF64;
    mesh.positions.f64 = {place[0], place[1], place[2]};
    mesh.faces = {{{0, 0, 0, cooker::kNoCorner}}};
    const test::CookedTree one = test::cook_tree(mesh, CodecId::kWide8);
    Pose pose = Pose::Identity();
    pose.translation() = place;
    const auto found = distance(one.tree, Pose::Identity(), beside.tree, pose);
    const auto swapped = distance(beside.tree, pose, one.tree, Pose::Identity());
    ASSERT_TRUE(found.ok());
    ASSERT_TRUE(swapped.ok());
    for (const Distance& d : {*found, *swapped}) {
      EXPECT_LE(d.lower, 1);
      EXPECT_GE(d.upper, 1);
      EXPECT_LE(d.upper - d.lower, 0x1p-44);
    }
  }
}

// Powers of two of poses and meshes that all but cancel: the poses' product alone is no double.
TEST(Distance, PosesMayUndoTheScalesOfMeshes) {
  const auto square = [](double size) {
    SourceMesh mesh;
    mesh.positions.precision = cooker::Precision::kF64;
    mesh.positions.f64 = {-size, -size, 0, size, -size, 0, size, size, 0, -size, size, 0};
    mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}, {{0, 2, 3, cooker::kNoCorner}}};
    return test::cook_tree(mesh, CodecId::kWide8);
  };
  const test::CookedTree large = square(0x1p490), small = square(0x1p-500);
  Pose shrunk = Pose::Identity();  // the large square's half side is 2^-110
  shrunk.linear() *= 0x1p-600;
  for (const double height : {0.0, 0x1p-70, 0x1p-100}) {
    SCOPED_TRACE(height);
    Pose grown = Pose::Identity();  // the small square's is 2^-70
    grown.linear() *= 0x1p430;
    grown.translation().z() = height;
    const auto found = distance(large.tree, shrunk, small.tree, grown);
    const auto swapped = distance(small.tree, grown, large.tree, shrunk);
    ASSERT_TRUE(found.ok());
    ASSERT_TRUE(swapped.ok());
    for (const Distance& d : {*found, *swapped}) {
      EXPECT_LE(d.lower, height);
      EXPECT_GE(d.upper, height);
      EXPECT_LE(d.upper - d.lower, 1e-12 * 0x1p-70);
    }
    const auto contact = first_contact(large.tree, shrunk, small.tree, grown);
    ASSERT_TRUE(contact.ok());
    EXPECT_EQ(contact.has_value(), height == 0);
  }
}

TEST(Distance, RefusesWhatHasNoMeaning) {
  const test::CookedTree cube = test::cook_tree(test::city(1, 2), CodecId::kWide8);
  const auto refused = [&](const DistanceOptions& options) {
    return distance(cube.tree, Pose::Identity(), cube.tree, Pose::Identity(), options)
        .error()
        .message();
  };
  EXPECT_EQ(refused({-1, 0}), "invalid_query: relative_error: expected 0 or more");
  EXPECT_EQ(refused({NAN, 0}), "invalid_query: relative_error: expected 0 or more");
  EXPECT_EQ(refused({0, -1}), "invalid_query: absolute_error: expected 0 or more");
  EXPECT_EQ(refused({0, NAN}), "invalid_query: absolute_error: expected 0 or more");
  EXPECT_EQ(refused({0, 0, -1}), "invalid_query: max_distance: expected 0 or more");
  EXPECT_EQ(refused({0, 0, NAN}), "invalid_query: max_distance: expected 0 or more");
  Pose flat = Pose::Identity();
  flat.linear().row(1).setZero();
  EXPECT_EQ(distance(cube.tree, flat, cube.tree, Pose::Identity()).code(), Errc::kInvalidPose);
  EXPECT_EQ(distance(cube.tree, Pose::Identity(), cube.tree, flat).code(), Errc::kInvalidPose);
}

SourceMesh square(float size) {
  SourceMesh mesh;
  mesh.positions.f32 = {0, 0, 0, size, 0, 0, size, size, 0, 0, size, 0};
  mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}, {{0, 2, 3, cooker::kNoCorner}}};
  return mesh;
}

// Found by an oracle: squares of axes that another pose had made tiny lost digits, and a lower
// bound was a fifth too large.
TEST(Distance, IsTrueWhereAFlatBodyIsScaledBeyondWhatSquaresHold) {
  SourceMesh peak;
  peak.positions.f32 = {3, 3, 2, 4, 3, 3, 3, 4, 3};
  peak.faces = {{{0, 1, 2, cooker::kNoCorner}}};
  const test::CookedTree first = test::cook_tree(peak, CodecId::kWide8);
  const test::CookedTree second = test::cook_tree(square(7), CodecId::kWide8);
  int answered = 0;
  for (int exponent = 500; exponent < 600; ++exponent) {
    for (const double mantissa : {1.0, 1.285150280408541}) {
      SCOPED_TRACE(exponent);
      Pose high = Pose::Identity();
      high.linear()(2, 2) = std::ldexp(mantissa, exponent);
      for (const std::uint64_t budget : {std::uint64_t{0}, kUnlimitedNodes}) {
        DistanceOptions options;
        options.node_budget = budget;
        const auto found = distance(first.tree, Pose::Identity(), second.tree, high, options);
        if (!found.ok()) continue;  // beyond what a pose may be
        ++answered;
        EXPECT_LE(found->lower, 2.0);
        EXPECT_GE(found->upper, 2.0);
        EXPECT_TRUE(budget == 0 || std::abs(found->upper - 2) < 1e-12);
      }
    }
  }
  EXPECT_GT(answered, 200);
}

// Likewise: a residual that was no number was forgotten, and three gaps at sharp angles counted as
// if they were at right ones.
TEST(Distance, IsTrueWhereAnInverseOverflows) {
  const test::CookedTree first = test::cook_tree(test::sphere(6, 8), CodecId::kWide8);
  const test::CookedTree second = test::cook_tree(square(7), CodecId::kWide8);
  Pose flat = Pose::Identity();
  flat.linear()(1, 1) = 0.1;
  flat.translation().x() = 20;
  Pose sheared = Pose::Identity();
  Eigen::Matrix3d to;
  to << 0, 1, 0, 1, 0, 0, 1, 0, 1;
  sheared.linear() = to.inverse();
  sheared.linear().col(0) *= std::pow(10.0, -308.75);
  const Truth truth = brute_force(first.tree, flat, second.tree, sheared);
  for (const std::uint64_t budget : {std::uint64_t{0}, kUnlimitedNodes}) {
    DistanceOptions options;
    options.node_budget = budget;
    const auto found = distance(first.tree, flat, second.tree, sheared, options);
    ASSERT_TRUE(found.ok());
    check_bounds(*found, truth);
  }
}

// Likewise: the square of a gap that underflows may be rounded up.
TEST(Distance, IsTrueWhereItsSquareUnderflows) {
  const test::CookedTree plate = test::cook_tree(square(7), CodecId::kWide8);
  for (const double scale : {1.0, 1e-3}) {
    for (int exponent = -1000; exponent < -400; ++exponent) {
      Pose below = Pose::Identity(), above = Pose::Identity();
      below.linear() *= scale;
      above.linear() *= scale;
      above.translation().z() = std::ldexp(1.2, exponent);
      for (const std::uint64_t budget : {std::uint64_t{0}, kUnlimitedNodes}) {
        DistanceOptions options;
        options.node_budget = budget;
        const auto found = distance(plate.tree, below, plate.tree, above, options);
        ASSERT_TRUE(found.ok());
        EXPECT_LE(found->lower, above.translation().z()) << exponent;
        EXPECT_GE(found->upper, above.translation().z()) << exponent;
      }
    }
  }
}

// Likewise: where very many triangles are equally near, a search that went on knew less by a
// rounding than one that had ended.
TEST(Distance, OfABodyThatIsAPointNeverKnowsLessByGoingOn) {
  const test::CookedTree first = test::cook_tree(test::sphere(8, 10), CodecId::kPlainF32);
  Random random;
  for (unsigned seed = 0; seed < 12; ++seed) {
    SCOPED_TRACE(seed);
    const test::CookedTree second = test::cook_tree(test::soup(300, seed), CodecId::kWide8);
    const Pose pose = random.pose(3, 20);
    Pose point = Pose::Identity();
    point.linear() *= 1e-100;
    point.translation() = random.vector(100);
    double gap = std::numeric_limits<double>::infinity();
    for (std::uint64_t budget = 0; budget < 400; ++budget) {
      DistanceOptions options;
      options.node_budget = budget;
      const auto found = distance(first.tree, pose, second.tree, point, options);
      ASSERT_TRUE(found.ok());
      ASSERT_LE(found->upper - found->lower, gap) << budget;
      gap = found->upper - found->lower;
      if (found->converged) break;
    }
  }
}

// Trees of nodes and of one leaf are of one codec by name and of two by what is bound.
TEST(Distance, OfATreeOfOneLeafAndOneOfNodes) {
  const test::CookedTree leaf = test::cook_tree(test::duplicates(1), CodecId::kWide8);
  const test::CookedTree nodes = test::cook_tree(test::torus(12, 8), CodecId::kWide8);
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(0, 0, 5);
  const auto found = distance(nodes.tree, Pose::Identity(), leaf.tree, pose);
  const auto swapped = distance(leaf.tree, pose, nodes.tree, Pose::Identity());
  EXPECT_NEAR(found->upper, swapped->upper, 1e-12);
  EXPECT_FALSE(first_contact(nodes.tree, Pose::Identity(), leaf.tree, pose).has_value());
}

}  // namespace
}  // namespace boxtree
