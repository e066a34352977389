// SPDX-License-Identifier: MIT
// Each case of stiff contact keeps to its figures, over every codec; and the simulator itself is
// held against closed forms, so that the cases measure trees and not it.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/stiff/cases.h"
#include "tests/stiff/corner_contact.h"
#include "tests/stiff/meshes.h"
#include "tests/stiff/world.h"

namespace boxtree::stiff {
namespace {

class StiffCase : public testing::TestWithParam<CaseInfo> {};

TEST_P(StiffCase, KeepsToItsFigures) {
  const CaseResult result = GetParam().run({true});
  std::size_t limits = 0;
  for (const Row& row : result.rows) {
    EXPECT_EQ(row.id, GetParam().id);
    EXPECT_TRUE(row.pass()) << row.id << ", " << row.setting << ", " << row.what << ": "
                            << row.figure << ", limit " << row.limit;
    limits += row.relation != Row::Limit::kNone ? 1u : 0u;
  }
  // A case that measures nothing has not passed.
  EXPECT_GE(limits, 6u);
  for (const NamedPlot& plot : result.plots) {
    EXPECT_FALSE(plot.plot.series.empty());
    EXPECT_LE(plot.plot.series.size(), 4u) << plot.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, StiffCase, testing::ValuesIn(kCases),
                         [](const auto& test) { return std::string(test.param.id); });

// A ground of two triangles and a box above it, on no tree.
struct Scene {
  Shape ground = make_scan(field(Field::kFlat, 1, 4), exact_store());
  Shape body = make_scan(box({0.2, 0.2, 0.2}), exact_store());
  double height = tread_height(ground, Eigen::Vector3d(0.1, 0, 0));

  [[nodiscard]] World world(const SpringLaw& law, double lowest) const {
    World world(ground, law, {0, 0, -kGravity});
    Body box = make_body(body, {0.2, 0.2, 0.2}, 1);
    box.position = {0.11, 0.07, height + 0.2 + lowest};
    world.bodies.push_back(box);
    return world;
  }
};

TEST(StiffWorld, RestsWhereSpringsCarryTheWeight) {
  const Scene scene;
  const double stiffness = 1e5;
  for (const bool implicit : {false, true}) {
    World world = scene.world({stiffness, 4 * std::sqrt(stiffness)}, 1e-4);
    const double dt = implicit ? 1e-2 : 1e-4;
    for (int i = 0; i < 3000; ++i) {
      implicit ? world.step_implicit(dt) : world.step_symplectic_euler(dt);
    }
    world.find_contacts();
    ASSERT_EQ(world.contacts().size(), 4u);
    for (const Contact& contact : world.contacts()) {
      EXPECT_NEAR(contact.depth, kGravity / (4 * stiffness), 1e-9);
      EXPECT_FALSE(contact.at_edge);
      EXPECT_EQ(contact.normal, Eigen::Vector3d(0, 0, 1));
    }
    EXPECT_LT(world.bodies.front().velocity.norm(), 1e-6);
  }
}

TEST(StiffWorld, OscillatesAtTheFrequencyOfItsSprings) {
  // Around rest by less than the depth of rest, so that all corners stay on their springs.
  const Scene scene;
  const double stiffness = 1e4;
  const double rest = kGravity / (4 * stiffness);
  const double omega = std::sqrt(4 * stiffness);
  World world = scene.world({stiffness, 0}, -1.5 * rest);
  const double dt = 0.01 / omega;
  const double amplitude = 0.5 * rest;
  for (int i = 1; i <= 2000; ++i) {
    world.step_verlet(dt);
    const double above_rest = world.bodies.front().position.z() - (scene.height + 0.2 - rest);
    EXPECT_NEAR(above_rest, -amplitude * std::cos(omega * dt * i), 1e-3 * amplitude) << i;
  }
}

TEST(StiffWorld, ExplicitStepsBeyondTheLimitMakeEnergyAndImplicitOnesTakeIt) {
  const Scene scene;
  const double stiffness = 1e8;
  const double dt = 3 / std::sqrt(4 * stiffness);  // the limit is 2
  const double depth = 1e-5;
  const double as_high_as_springs_lift = 2 * stiffness * depth * depth / kGravity;
  const auto highest = [&](bool implicit) {
    World world = scene.world({stiffness, 0}, -depth);
    double top = 0;
    for (int i = 0; i < 200; ++i) {
      implicit ? world.step_implicit(dt) : world.step_symplectic_euler(dt);
      top = std::max(top, world.bodies.front().position.z() - scene.height - 0.2);
    }
    return top;
  };
  EXPECT_GT(highest(false), 2 * as_high_as_springs_lift);
  EXPECT_LT(highest(true), as_high_as_springs_lift);
}

TEST(StiffWorld, KeepsMomentumBetweenBodies) {
  // Two boxes collide in the air, off centre.
  const Scene scene;
  World world = scene.world({1e5, 10}, 5);
  Body other = world.bodies.front();
  other.position += Eigen::Vector3d(0.41, 0.05, 0.03);
  other.velocity = {-2, 0, 0};
  world.bodies.push_back(other);
  const double fall = 2 * kGravity;
  int touched = 0;
  const double dt = 1e-5;
  constexpr int kSteps = 3000;
  for (int i = 0; i < kSteps; ++i) {
    world.step_symplectic_euler(dt);
    touched += world.contacts().empty() ? 0 : 1;
  }
  const Eigen::Vector3d momentum = world.bodies[0].velocity + world.bodies[1].velocity;
  EXPECT_GT(touched, 0);
  EXPECT_GT(world.bodies[0].spin.norm(), 0.1);
  EXPECT_NEAR(momentum.x(), -2, 1e-9);
  EXPECT_NEAR(momentum.y(), 0, 1e-9);
  EXPECT_NEAR(momentum.z(), -fall * dt * kSteps, 1e-9);
}

TEST(CornerContact, NearestOfFaceAndEdge) {
  // A valley of two faces that meet at x = 0 and rise by 45 degrees.
  const std::array<Eigen::Vector3d, 4> at = {Eigen::Vector3d(0, -1, 0), Eigen::Vector3d(0, 1, 0),
                                             Eigen::Vector3d(1, 0, 1), Eigen::Vector3d(-1, 0, 1)};
  const auto triangle = [&](std::size_t a, std::size_t b, std::size_t c) {
    return WorldTriangle{{at[a], at[b], at[c]}, (at[b] - at[a]).cross(at[c] - at[a]).normalized()};
  };
  const std::vector<WorldTriangle> valley = {triangle(0, 2, 1), triangle(0, 1, 3)};
  ASSERT_GT(valley[0].normal.z(), 0);
  ASSERT_GT(valley[1].normal.z(), 0);
  // Right below the valley the edge is nearest.
  const auto below = depth_of({0, 0, -0.1}, valley, 1);
  ASSERT_TRUE(below);
  EXPECT_TRUE(below->at_edge);
  EXPECT_DOUBLE_EQ(below->depth, 0.1);
  EXPECT_TRUE(below->normal.isApprox(Eigen::Vector3d(0, 0, 1)));
  // Below the slope its plane is.
  const auto slope = depth_of({0.3, 0, 0.3 - 0.02}, valley, 1);
  ASSERT_TRUE(slope);
  EXPECT_FALSE(slope->at_edge);
  EXPECT_NEAR(slope->depth, 0.02 / std::sqrt(2), 1e-15);
  EXPECT_FALSE(depth_of({0.3, 0, 0.3 + 0.02}, valley, 1)) << "above";
  EXPECT_FALSE(depth_of({0, 0, -0.1}, valley, 0.05)) << "too deep";
}

TEST(Row, NotANumberFails) {
  EXPECT_FALSE((Row{"S1", "", "", NAN, Row::Limit::kAtMost, 1}.pass()));
  EXPECT_FALSE((Row{"S1", "", "", NAN, Row::Limit::kAtLeast, 1}.pass()));
  EXPECT_FALSE((Row{"S1", "", "", 2, Row::Limit::kAtMost, 1}.pass()));
}

}  // namespace
}  // namespace boxtree::stiff
