// SPDX-License-Identifier: MIT
#include "cooker/choose/search.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "runtime/tree/bound_tree.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"

namespace boxtree::cooker {
namespace {

using test::require;

SearchOptions options_for(Goal goal) {
  SearchOptions options;
  options.may_use_grid = true;
  options.may_use_arrays = true;
  options.wishes.goal = goal;
  return options;
}

Candidate winner(const SourceMesh& mesh, const SearchOptions& options) {
  TriedTree tried = require(try_encodings(mesh, options));
  const std::size_t chosen = require(choose(std::span(&tried.contest, 1), options.wishes)).front();
  return tried.contest.candidates[chosen];
}

// Large enough for codecs to be left out.
SourceMesh large_mesh() {
  return test::torus(100, 60);
}

TEST(Search, WhatIsLeftOutWouldNotHaveWon) {
  const SourceMesh mesh = large_mesh();
  ASSERT_GE(mesh.faces.size(), kTryAllFaces);
  for (const Goal goal : {Goal::kMemory, Goal::kSpeed, Goal::kBalance}) {
    SearchOptions options = options_for(goal);
    const TriedTree quick = require(try_encodings(mesh, options));
    EXPECT_FALSE(quick.contest.not_tried.empty());
    const Candidate chosen = winner(mesh, options);
    options.try_all = true;
    const TriedTree all = require(try_encodings(mesh, options));
    EXPECT_GT(all.contest.candidates.size(), quick.contest.candidates.size());
    const Candidate best = winner(mesh, options);
    EXPECT_EQ(chosen.codec, best.codec) << goal_name(goal);
    EXPECT_EQ(chosen.geometry, best.geometry) << goal_name(goal);
  }
}

TEST(Search, SmallMeshesAreTriedWithEveryCodec) {
  const TriedTree tried = require(try_encodings(test::torus(12, 8), options_for(Goal::kBalance)));
  // Each in two stores, packed-f64 for f64 alone, and those with full leaves in a third.
  EXPECT_EQ(tried.contest.candidates.size(), 2 * (kCodecs.size() - 1) + 2);
  for (const Candidate& candidate : tried.contest.candidates) {
    EXPECT_TRUE(candidate.gates.pass()) << codec_name(candidate.codec);
    EXPECT_GT(candidate.bytes(), 0u);
  }
}

// Two triangles far apart take fewer bytes and less time as nodes of the paper, but a program with
// boxtree::runtime alone could not read them.
TEST(Search, WhatTheRuntimeAloneReadsIsChosen) {
  for (const Goal goal : {Goal::kMemory, Goal::kSpeed, Goal::kBalance}) {
    for (const unsigned triangles : {1u, 2u, 3u, 10u, 40u}) {
      for (const bool try_all : {false, true}) {
        SearchOptions options = options_for(goal);
        options.try_all = try_all;
        EXPECT_TRUE(is_wide(winner(test::soup(triangles, 1), options).codec))
            << goal_name(goal) << ", " << triangles;
      }
    }
    SearchOptions options = options_for(goal);
    options.codec = CodecId::kPlainF16;
    EXPECT_EQ(winner(test::soup(2, 1), options).codec, CodecId::kPlainF16);
  }
}

TEST(Search, ABudgetBringsBackWhatItNeeds) {
  // The fastest is too large, so that a grid must be tried although it is slower.
  SearchOptions options = options_for(Goal::kSpeed);
  options.wishes.max_bytes_per_triangle = 10;
  EXPECT_EQ(winner(large_mesh(), options).geometry, GeometryId::kGrid);
  options.wishes.max_bytes_per_triangle.reset();
  EXPECT_EQ(winner(large_mesh(), options).geometry, GeometryId::kArrays);
  // The smallest is too slow.
  options = options_for(Goal::kMemory);
  EXPECT_EQ(winner(large_mesh(), options).geometry, GeometryId::kGrid);
  options.wishes.max_slowdown = 1.01;
  EXPECT_EQ(winner(large_mesh(), options).codec, CodecId::kWide8);
  EXPECT_EQ(winner(large_mesh(), options).geometry, GeometryId::kArrays);
}

TEST(Search, AToleranceThatNoGridKeepsLeavesExactGeometry) {
  SearchOptions options = options_for(Goal::kMemory);
  options.grid.tolerance = 1e-300;
  const TriedTree tried = require(try_encodings(large_mesh(), options));
  EXPECT_TRUE(std::any_of(tried.contest.not_tried.begin(), tried.contest.not_tried.end(),
                          [](const NotTried& n) { return n.geometry == GeometryId::kGrid; }));
  EXPECT_EQ(winner(large_mesh(), options).geometry, GeometryId::kExact);
}

TEST(Search, TheBaselineIsWide8WithArraysWhateverIsRequested) {
  const SourceMesh mesh = test::torus(30, 20);
  SearchOptions options = options_for(Goal::kBalance);
  const TriedTree all = require(try_encodings(mesh, options));
  const auto arrays = std::find_if(
      all.contest.candidates.begin(), all.contest.candidates.end(), [](const Candidate& each) {
        return each.codec == CodecId::kWide8 && each.geometry == GeometryId::kArrays;
      });
  ASSERT_NE(arrays, all.contest.candidates.end());
  EXPECT_EQ(all.contest.baseline, arrays->cost);
  EXPECT_EQ(
      slowdowns(all.contest)[static_cast<std::size_t>(arrays - all.contest.candidates.begin())], 1);
  options.wishes.goal = Goal::kMemory;
  EXPECT_EQ(require(try_encodings(mesh, options)).contest.baseline, arrays->cost);
  options.may_use_grid = options.may_use_arrays = false;
  for (const CodecId codec : {CodecId::kWide8, CodecId::kWide4, CodecId::kPackedF16}) {
    options.codec = codec;
    EXPECT_EQ(require(try_encodings(mesh, options)).contest.baseline, arrays->cost)
        << codec_name(codec);
  }
  options.geometry = GeometryId::kExternal;
  EXPECT_EQ(require(try_encodings(mesh, options)).contest.baseline, arrays->cost);
  options.geometry = GeometryId::kGrid;
  EXPECT_EQ(require(try_encodings(mesh, options)).contest.baseline, arrays->cost);
}

// Whichever positions the trees of a file share, a candidate with these is chosen: the others take
// no memory while more are tried.
TEST(Search, BytesOfCandidatesThatLoseAreFreed) {
  for (const SourceMesh& mesh : {large_mesh(), test::torus(12, 8)}) {
    for (const Goal goal : {Goal::kMemory, Goal::kSpeed, Goal::kBalance}) {
      const SearchOptions options = options_for(goal);
      TriedTree tried = require(try_encodings(mesh, options));
      const std::vector<bool> may_win = may_still_win(tried.contest, options.wishes);
      std::size_t kept = 0;
      for (std::size_t i = 0; i < may_win.size(); ++i) {
        kept += may_win[i] ? 1u : 0u;
        const TriedTree::Nodes& of = tried.nodes[i];
        EXPECT_EQ(of.nodes.bytes.empty(), !may_win[i]);
        EXPECT_TRUE(!may_win[i] || !tried.families[of.family].geometry.vertices.empty());
      }
      const std::size_t exact_and_grid = goal == Goal::kSpeed && mesh.faces.size() > 1000 ? 1 : 2;
      EXPECT_LE(kept, exact_and_grid) << goal_name(goal);
      const auto has_bytes = [](const EncodedTree& tree) {
        return !tree.geometry.vertices.empty();
      };
      EXPECT_EQ(std::count_if(tried.families.begin(), tried.families.end(), has_bytes), kept);
      const std::size_t chosen =
          require(choose(std::span(&tried.contest, 1), options.wishes)).front();
      EXPECT_TRUE(may_win[chosen]);
      EXPECT_TRUE(bind_encoded(tried.take(chosen)).ok());
    }
  }
}

TEST(Search, TakesOutOneTreeWhole) {
  const SourceMesh mesh = test::torus(12, 8);
  SearchOptions options = options_for(Goal::kBalance);
  options.keep_all = true;
  TriedTree tried = require(try_encodings(mesh, options));
  for (std::size_t i = 0; i < tried.contest.candidates.size(); ++i) {
    TriedTree copy = require(try_encodings(mesh, options));
    const EncodedTree tree = copy.take(i);
    const Candidate& candidate = tried.contest.candidates[i];
    EXPECT_EQ(tree.nodes.codec, candidate.codec);
    EXPECT_EQ(tree.geometry.geometry, candidate.geometry);
    EXPECT_EQ(tree.nodes.bytes.size(), candidate.tree_bytes);
    EXPECT_TRUE(bind_encoded(tree).ok());
  }
}

}  // namespace
}  // namespace boxtree::cooker
