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

TEST(Choose, RefusesWithTheNearestThatIsPossible) {
  Contest tree = contest();
  const auto bytes = choose(std::span(&tree, 1), {Goal::kSpeed, 6.5, {}});
  EXPECT_EQ(bytes.code(), Errc::kBudgetUnreachable);
  EXPECT_EQ(bytes.error().detail,
            "wanted at most 6.5 B/tri; wide4 with geometry exact takes 7.00 B/tri, slowdown 2.00; "
            "wide8 with geometry exact takes 13.20 B/tri, slowdown 1.00 (slowdown: time over that "
            "of wide8 with arrays, mean over the kinds of queries); fewer bytes take a tolerance "
            "(cook --tolerance LENGTH, tolerance of a profile), by which vertices may move");
  const auto slow = choose(std::span(&tree, 1), {Goal::kSpeed, {}, 0.5});
  EXPECT_TRUE(slow.error().detail.ends_with("mean over the kinds of queries)"));
  const auto both = choose(std::span(&tree, 1), {Goal::kSpeed, 7, 1.2});
  EXPECT_EQ(both.code(), Errc::kBudgetUnreachable);
  EXPECT_NE(both.error().detail.find("at most 7 B/tri and a slowdown of at most 1.2;"),
            std::string::npos);
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
