// SPDX-License-Identifier: MIT
#include "cooker/choose/choose.h"

#include <gtest/gtest.h>

#include "tests/support/require.h"

namespace boxtree::cooker {
namespace {

using test::require;

// Of a tree of 100 triangles; every kind of query costs the same.
Candidate candidate(CodecId codec, GeometryId geometry, std::uint64_t bytes, double cost) {
  Candidate out;
  out.codec = codec;
  out.geometry = geometry;
  out.tree_bytes = bytes / 2;
  out.geometry_bytes = bytes - bytes / 2;
  out.cost.fill(cost);
  out.gates.certificate = true;
  return out;
}

// Fast and large, slow and small, and one between that wins by the product: 1320, 1400, 1200. The
// baseline is as fast as the first.
Contest contest() {
  Contest tree{100, {}, {}};
  tree.baseline.fill(10);
  tree.candidates = {candidate(CodecId::kWide8, GeometryId::kExact, 1320, 10),
                     candidate(CodecId::kWide4, GeometryId::kExact, 700, 20),
                     candidate(CodecId::kWide8, GeometryId::kExact, 800, 15)};
  return tree;
}

std::size_t choice(Contest tree, const Wishes& wishes) {
  return require(choose(std::span(&tree, 1), wishes)).front();
}

TEST(Choose, TakesTheSmallestTheFastestOrTheSmallestProduct) {
  EXPECT_EQ(choice(contest(), {Goal::kMemory, {}, {}}), 1u);
  EXPECT_EQ(choice(contest(), {Goal::kSpeed, {}, {}}), 0u);
  EXPECT_EQ(choice(contest(), {Goal::kBalance, {}, {}}), 2u);
}

TEST(Choose, SlowdownIsTheMeanOverKinds) {
  Contest tree = contest();
  tree.candidates[1].cost = {10, 20, 30, 40};
  EXPECT_EQ(slowdowns(tree), (std::vector<double>{1, 2.5, 1.5}));
  tree.queries = kBoxQueries | kPairQueries;
  EXPECT_EQ(slowdowns(tree), (std::vector<double>{1, 3, 1.5}));
}

TEST(Choose, SlowdownIsRelativeToTheBaseline) {
  Contest tree = contest();
  tree.baseline = {20, 20, 20, 40};  // slower than all that was tried
  EXPECT_EQ(slowdowns(tree), (std::vector<double>{0.4375, 0.875, 0.65625}));
  EXPECT_EQ(choice(tree, {Goal::kMemory, {}, 0.875}), 1u);
  EXPECT_EQ(choice(tree, {Goal::kMemory, {}, 0.87}), 2u);
}

TEST(Choose, WhatFailsItsGatesIsNotTaken) {
  Contest tree = contest();
  tree.candidates[0].gates.missed = 3;
  EXPECT_EQ(require(choose(std::span(&tree, 1), {Goal::kSpeed, {}, {}})).front(), 2u);
  EXPECT_EQ(tree.candidates[0].rejected, "fails its gates: 3 faces missed, 0 boxes escaped");
  EXPECT_EQ(tree.candidates[2].rejected, "");
  for (Candidate& each : tree.candidates) each.gates.escapes = 1;
  EXPECT_EQ(choose(std::span(&tree, 1), {}).code(), Errc::kInternal);
}

TEST(Choose, CodecsOfThePaperAreThereToCompareWith) {
  Contest tree = contest();
  tree.candidates.push_back(candidate(CodecId::kPackedF16, GeometryId::kExact, 500, 5));
  EXPECT_EQ(require(choose(std::span(&tree, 1), {Goal::kMemory, {}, {}})).front(), 1u);
  EXPECT_EQ(tree.candidates[3].rejected, "a codec of boxtree::paper: --codec chooses it");
  EXPECT_EQ(slowdowns(tree), (std::vector<double>{1, 2, 1.5, 0.5}));
  EXPECT_EQ(choice(tree, {Goal::kSpeed, 8, 1.5}), 2u);
  EXPECT_EQ(choose(std::span(&tree, 1), {Goal::kMemory, 5, {}}).code(), Errc::kBudgetUnreachable);
  // Where nothing else was tried, as when one was requested.
  Contest alone{100, {tree.candidates[3]}, {}};
  EXPECT_EQ(choice(alone, {Goal::kMemory, 5, {}}), 0u);
}

TEST(Choose, KeepsToBudgets) {
  EXPECT_EQ(choice(contest(), {Goal::kSpeed, 8, {}}), 2u);
  EXPECT_EQ(choice(contest(), {Goal::kSpeed, 7, {}}), 1u);
  EXPECT_EQ(choice(contest(), {Goal::kMemory, {}, 1.5}), 2u);
  EXPECT_EQ(choice(contest(), {Goal::kMemory, {}, 1}), 0u);
  EXPECT_EQ(choice(contest(), {Goal::kBalance, 8, 1.5}), 2u);
}

constexpr const char* kMeaning =
    " (slowdown: time over that of wide8 with arrays, mean over the kinds of queries)";

std::string refusal(std::vector<Contest> trees, const Wishes& wishes) {
  const auto refused = choose(trees, wishes);
  EXPECT_EQ(refused.code(), Errc::kBudgetUnreachable);
  return refused.ok() ? "" : refused.error().detail;
}

TEST(Choose, RefusesWithTheNearestThatIsPossible) {
  EXPECT_EQ(refusal({contest()}, {Goal::kSpeed, 6.5, {}}),
            std::string("wanted at most 6.5 B/tri; wide4 with geometry exact takes 7 B/tri, "
                        "slowdown 2") +
                kMeaning +
                "; fewer bytes take a tolerance, or a larger one, by which vertices may move (cook "
                "--tolerance LENGTH in place of --exact, --grid-bits and --grid-step; tolerance of "
                "a profile)");
  EXPECT_EQ(refusal({contest()}, {Goal::kSpeed, {}, 0.5}),
            std::string("wanted a slowdown of at most 0.5; wide8 with geometry exact takes 13.2 "
                        "B/tri, slowdown 1") +
                kMeaning);
  // Of two budgets, one is to be changed and the other kept.
  EXPECT_TRUE(refusal({contest()}, {Goal::kSpeed, 7, 1.2})
                  .starts_with("wanted at most 7 B/tri and a slowdown of at most 1.2; wide8 with "
                               "geometry exact takes 13.2 B/tri, slowdown 1; wide4 with geometry "
                               "exact takes 7 B/tri, slowdown 2 (slowdown"));
  EXPECT_TRUE(refusal({contest()}, {Goal::kSpeed, 7.5, 0.5})
                  .starts_with("wanted at most 7.5 B/tri and a slowdown of at most 0.5; wide4 with "
                               "geometry exact takes 7 B/tri, slowdown 2 (slowdown"));
  EXPECT_TRUE(
      refusal({contest()}, {Goal::kSpeed, 1, 0.5})
          .starts_with("wanted at most 1 B/tri and a slowdown of at most 0.5; wide4 with "
                       "geometry exact takes 7 B/tri, slowdown 2; wide8 with geometry exact "
                       "takes 13.2 B/tri, slowdown 1 (slowdown"));
}

// Found by a newcomer: the nearest were rounded, often down, and those of one tree of several.
TEST(Choose, TheNearestThatIsPossibleIs) {
  Contest one = contest(), other = contest();
  one.mesh = "one";
  one.triangles = 130;  // 7 / 1.3 = 5.3846...
  other.mesh = "other";
  other.triangles = 97;  // 700 / 97 = 7.2164...
  other.candidates[0].cost.fill(10.0 * 4 / 3);
  EXPECT_TRUE(refusal({one}, {Goal::kSpeed, 1, {}})
                  .starts_with("wanted at most 1 B/tri; wide4 with geometry exact takes 5.385 "
                               "B/tri, slowdown 2 (slowdown"));
  EXPECT_TRUE(refusal({one, other}, {Goal::kSpeed, 1, {}})
                  .starts_with("wanted at most 1 B/tri; other: wide4 with geometry exact takes "
                               "7.217 B/tri, slowdown 2 "
                               "(slowdown"));
  EXPECT_TRUE(refusal({one, other}, {Goal::kSpeed, {}, 0.5})
                  .starts_with("wanted a slowdown of at most 0.5; other: wide8 with geometry exact "
                               "takes 13.61 B/tri, "
                               "slowdown 1.334 (slowdown"));
  std::vector<Contest> trees = {one, other};
  EXPECT_TRUE(choose(trees, {Goal::kSpeed, 7.217, {}}).ok());
  EXPECT_FALSE(choose(trees, {Goal::kSpeed, 7.216, {}}).ok());
  EXPECT_TRUE(choose(trees, {Goal::kSpeed, {}, 1.334}).ok());
  EXPECT_FALSE(choose(trees, {Goal::kSpeed, {}, 1.333}).ok());
  // With one store for both: on the grid, other takes fewer bytes, one takes none there.
  Contest on_grid = other;
  on_grid.candidates.push_back(candidate(CodecId::kWide8, GeometryId::kGrid, 300, 10));
  EXPECT_TRUE(
      refusal({one, on_grid}, {Goal::kSpeed, 1, {}})
          .starts_with(
              "wanted at most 1 B/tri; other: wide4 with geometry exact takes 7.217 B/tri"));
  const std::vector<Contest> apart = {one, on_grid};
  const std::vector<Wishes> wishes(2, Wishes{Goal::kSpeed, 1, {}});
  EXPECT_TRUE(budgets_unreachable(apart, wishes, {true, false})
                  .detail.starts_with(
                      "wanted at most 1 B/tri; one: wide4 with geometry exact takes 5.385 B/tri"));
}

TEST(Choose, AToleranceIsNoRemedyWhereNoPositionsAreStored) {
  Contest tree{100, {candidate(CodecId::kWide8, GeometryId::kExternal, 700, 10)}, {}};
  tree.baseline.fill(10);
  EXPECT_EQ(refusal({tree}, {Goal::kMemory, 1, {}}),
            std::string("wanted at most 1 B/tri; wide8 with geometry external takes 7 B/tri, "
                        "slowdown 1") +
                kMeaning);
}

// What touches still does: one geometry store for all trees of a file.
TEST(Choose, TreesOfAFileShareAGeometryStore) {
  Contest one{100, {}, {}}, other{100, {}, {}};
  one.candidates = {candidate(CodecId::kWide8, GeometryId::kExact, 900, 10),
                    candidate(CodecId::kWide8, GeometryId::kGrid, 1000, 10)};
  other.candidates = {candidate(CodecId::kWide8, GeometryId::kExact, 1500, 10),
                      candidate(CodecId::kWide8, GeometryId::kGrid, 700, 10)};
  std::vector<Contest> trees = {one, other};
  EXPECT_EQ(require(choose(trees, {Goal::kMemory, {}, {}})), (std::vector<std::size_t>{1, 1}));
  EXPECT_EQ(trees[0].candidates[0].rejected,
            "no worse alone, but the trees of the file share geometry grid");
  EXPECT_EQ(trees[1].candidates[0].rejected, "more bytes");
  trees[0].triangles = trees[1].triangles = 100;
  trees[1].candidates[1].gates.missed = 1;
  EXPECT_EQ(require(choose(trees, {Goal::kMemory, {}, {}})), (std::vector<std::size_t>{0, 0}));
  trees[0].candidates[0].gates.missed = 1;
  EXPECT_EQ(choose(trees, {Goal::kMemory, {}, {}}).code(), Errc::kBudgetUnreachable);
}

TEST(Choose, AnEmptyTreeCanBeChosenFor) {
  Contest tree{0, {candidate(CodecId::kWide8, GeometryId::kExact, 0, 0)}, {}};
  EXPECT_EQ(choice(tree, {}), 0u);
}

}  // namespace
}  // namespace boxtree::cooker
