// SPDX-License-Identifier: MIT
#include "cooker/choose/cost.h"

#include <gtest/gtest.h>

namespace boxtree::cooker {
namespace {

TEST(Cost, IsASumOfSteps) {
  const CodecCost known[] = {
      {CodecId::kWide8, GeometryId::kArrays, {{{100, 10, 1}, {0, 2, 0}, {0, 0, 3}, {7, 0, 0}}}}};
  const WorkOfKinds work = {{{5, 2}, {6, 9}, {4, 8}, {1, 1}}};
  const QueryCost expected = {152, 12, 24, 7};
  EXPECT_EQ(cost_of(work, CodecId::kWide8, GeometryId::kArrays, Precision::kF32, known), expected);
  EXPECT_EQ(cost_of(work, CodecId::kWide8, GeometryId::kExternal, Precision::kF32, known),
            expected);
}

TEST(Cost, EveryCodecAndStoreHasConstants) {
  const WorkOfKinds work = {{{5, 2}, {6, 9}, {4, 8}, {3, 3}}};
  for (const CodecInfo& codec : kCodecs) {
    for (const GeometryId geometry : {GeometryId::kArrays, GeometryId::kExact, GeometryId::kGrid}) {
      if (geometry == GeometryId::kExact && !is_wide(codec.id)) continue;  // they have arrays
      for (const Precision precision : {Precision::kF32, Precision::kF64}) {
        for (const double ns : cost_of(work, codec.id, geometry, precision)) {
          EXPECT_GT(ns, 0) << codec.name;
        }
      }
    }
  }
}

// Leaves of doubles take twice the bytes, and are rounded to floats.
TEST(Cost, PositionsOfF64TakeTheirOwnTime) {
  const WorkOfKinds work = {{{5, 2}, {6, 9}, {4, 8}, {3, 3}}};
  for (const CodecId codec : {CodecId::kWide8, CodecId::kWide4}) {
    for (const GeometryId geometry : {GeometryId::kArrays, GeometryId::kExact}) {
      const QueryCost f32 = cost_of(work, codec, geometry);
      const QueryCost f64 = cost_of(work, codec, geometry, Precision::kF64);
      for (std::size_t kind = 0; kind < kQueryKinds; ++kind) EXPECT_GT(f64[kind], f32[kind]);
    }
    EXPECT_EQ(cost_of(work, codec, GeometryId::kGrid, Precision::kF64),
              cost_of(work, codec, GeometryId::kGrid));
  }
}

TEST(FitSteps, FindsTheStepsThatMadeTheTimes) {
  const StepCost truth{80, 15, 40};
  std::vector<Measured> measured;
  for (const Work work : {Work{3, 1}, Work{10, 2}, Work{40, 31}, Work{100, 12}}) {
    measured.push_back({work, truth.query + work.nodes * truth.node + work.leaves * truth.leaf});
  }
  const StepCost found = fit_steps(measured);
  EXPECT_NEAR(found.query, truth.query, 1e-6);
  EXPECT_NEAR(found.node, truth.node, 1e-6);
  EXPECT_NEAR(found.leaf, truth.leaf, 1e-6);
}

// The best line through these times goes down with the nodes; the best without negative steps does
// not.
TEST(FitSteps, NoStepIsNegative) {
  const std::vector<Measured> measured = {{{1, 1}, 100}, {{10, 1}, 90}, {{20, 1}, 80}};
  const StepCost found = fit_steps(measured);
  EXPECT_GE(found.query, 0);
  EXPECT_GE(found.node, 0);
  EXPECT_GE(found.leaf, 0);
  EXPECT_NEAR(found.query + found.leaf + 10 * found.node, 90, 5);
}

TEST(FitLeaf, FindsTheLeafAndKeepsTheRest) {
  const StepCost truth{80, 15, 40};
  std::vector<Measured> measured;
  for (const Work work : {Work{3, 1}, Work{10, 2}, Work{40, 31}}) {
    measured.push_back({work, truth.query + work.nodes * truth.node + work.leaves * truth.leaf});
  }
  const StepCost found = fit_leaf(measured, {80, 15, 7});
  EXPECT_EQ(found.query, truth.query);
  EXPECT_EQ(found.node, truth.node);
  EXPECT_NEAR(found.leaf, truth.leaf, 1e-9);
  EXPECT_EQ(fit_leaf(measured, {1e6, 15, 7}).leaf, 0);
}

// Stores differ by what a leaf takes, so a mesh of few leaves is no faster in a slower store.
TEST(Cost, StoresOfACodecDifferInLeaves) {
  for (const CodecCost& cost : compiled_costs()) {
    for (const CodecCost& other : compiled_costs()) {
      if (other.codec != cost.codec || other.precision != cost.precision) continue;
      for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
        EXPECT_EQ(other.of_kind[kind].query, cost.of_kind[kind].query);
        EXPECT_EQ(other.of_kind[kind].node, cost.of_kind[kind].node);
      }
    }
  }
}

}  // namespace
}  // namespace boxtree::cooker
