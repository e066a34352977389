// SPDX-License-Identifier: MIT
// Cells against what their definition says of each face, in whole numbers.
#include "cooker/tile/tile_cells.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace boxtree::cooker {
namespace {

using Triangle = std::array<WorldCorner, 3>;

float largest_of(const std::vector<Triangle>& faces) {
  float largest = 0;
  for (const Triangle& face : faces) {
    for (const WorldCorner& corner : face) {
      for (const float x : corner) largest = std::max(largest, std::abs(x));
    }
  }
  return largest;
}

TileTree tree_of(const std::vector<Triangle>& faces, std::uint64_t most) {
  TileTree tree(tile_exponent(largest_of(faces)), most);
  for (int round = 0; tree.is_open(); ++round) {
    EXPECT_LT(round, kTileLevels);
    tree.begin_round();
    for (const Triangle& face : faces) tree.count(tile_path(face, tree.exponent()), 1);
    tree.end_round();
  }
  return tree;
}

// Whole numbers, so that everything about them is exact.
std::vector<Triangle> random_faces(std::size_t count, int range, unsigned seed) {
  std::mt19937 random(seed);
  const auto whole = [&](int low, int high) {
    return static_cast<float>(low + static_cast<int>(random() % static_cast<unsigned>(high - low)));
  };
  std::vector<Triangle> faces(count);
  for (Triangle& face : faces) {
    const WorldCorner at = {whole(-range, range), whole(-range, range), whole(-range, range)};
    for (WorldCorner& corner : face) {
      for (std::size_t k = 0; k < 3; ++k) corner[k] = at[k] + whole(-3, 4);
    }
  }
  return faces;
}

// Whether twice the center of the face's box is in twice the cell.
bool is_in(const Triangle& face, const TileCell& cell) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax({face[0][k], face[1][k], face[2][k]});
    const double edge = std::ldexp(2.0, cell.exponent);
    const double twice = double{low} + double{high};
    if (twice < cell.index[k] * edge || twice >= (cell.index[k] + 1) * edge) return false;
  }
  return true;
}

TEST(TileCells, HoldTheCentersOfTheirFaces) {
  for (const std::size_t most : {1u, 7u, 100u, 100000u}) {
    const std::vector<Triangle> faces = random_faces(3000, 500, 1);
    const TileTree tree = tree_of(faces, most);
    std::vector<std::size_t> counts(tree.tiles().size());
    for (const Triangle& face : faces) {
      const auto tile = tree.tile_of(tile_path(face, tree.exponent()));
      ASSERT_TRUE(tile.has_value());
      EXPECT_TRUE(is_in(face, tree.tiles()[*tile].cell)) << tree.tiles()[*tile].cell.name();
      ++counts[*tile];
    }
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const TileTree::Tile& tile = tree.tiles()[i];
      EXPECT_EQ(counts[i], tile.counts.faces);
      EXPECT_EQ(counts[i], tile.counts.triangles);
      EXPECT_GT(counts[i], 0u);
      const int level = tree.exponent() - tile.cell.exponent;
      EXPECT_TRUE(counts[i] <= most || level == kTileLevels) << tile.cell.name();
      // Split no further than needed: the cell around it has too many.
      if (level == 0) continue;
      TileCell around{tile.cell.exponent + 1, tile.cell.index};
      for (std::int32_t& index : around.index) index >>= 1;
      const auto in_around = std::count_if(
          faces.begin(), faces.end(), [&](const Triangle& face) { return is_in(face, around); });
      EXPECT_GT(static_cast<std::size_t>(in_around), most) << tile.cell.name();
    }
  }
}

TEST(TileCells, BeginWithTheirBorder) {
  const auto cell_of = [](const WorldCorner& at) {
    std::vector<Triangle> faces = {{at, at, at}, {{{7, 7, 7}, {7, 7, 7}, {7, 7, 7}}}};
    const TileTree tree = tree_of(faces, 1);
    return tree.tiles()[*tree.tile_of(tile_path(faces[0], tree.exponent()))].cell;
  };
  EXPECT_EQ(cell_of({0, 0, 0}), (TileCell{2, {0, 0, 0}}));
  EXPECT_EQ(cell_of({3.5f, 4, 0}), (TileCell{2, {0, 1, 0}}));
  EXPECT_EQ(cell_of({-0.0f, 0, 0}), (TileCell{2, {0, 0, 0}}));
  EXPECT_EQ(cell_of({std::nextafter(0.0f, -1.0f), 0, 0}), (TileCell{3, {-1, 0, 0}}));
  EXPECT_EQ(cell_of({-4, 0, 0}).name(), "e3_-1_0_0");
}

TEST(TileCells, DependOnTheirContentAlone) {
  const std::vector<Triangle> faces = random_faces(2000, 500, 2);
  const TileTree tree = tree_of(faces, 50);
  std::vector<Triangle> edited = faces;
  const TileTree::Tile& tile = tree.tiles()[tree.tiles().size() / 2];
  for (Triangle& face : edited) {
    if (is_in(face, tile.cell)) std::swap(face[0], face[1]);
  }
  std::reverse(edited.begin(), edited.end());
  const TileTree after = tree_of(edited, 50);
  ASSERT_EQ(after.tiles().size(), tree.tiles().size());
  for (std::size_t i = 0; i < after.tiles().size(); ++i) {
    EXPECT_EQ(after.tiles()[i].cell, tree.tiles()[i].cell);
    EXPECT_EQ(after.tiles()[i].counts.faces, tree.tiles()[i].counts.faces);
  }
  // A face far away makes the world larger, and no other tile another one.
  edited.push_back({{{9000, 0, 0}, {9000, 1, 0}, {9000, 0, 1}}});
  const TileTree larger = tree_of(edited, 50);
  EXPECT_EQ(larger.tiles().size(), tree.tiles().size() + 1);
  for (const TileTree::Tile& each : tree.tiles()) {
    EXPECT_TRUE(std::any_of(larger.tiles().begin(), larger.tiles().end(),
                            [&](const TileTree::Tile& other) { return other.cell == each.cell; }))
        << each.cell.name();
  }
}

TEST(TileCells, OfOnePlaceAreNotSplitForEver) {
  const WorldCorner at = {0.3f, -0.7f, 0.9f};
  const TileTree tree = tree_of(std::vector<Triangle>(20, {at, at, at}), 3);
  ASSERT_EQ(tree.tiles().size(), 1u);
  EXPECT_EQ(tree.tiles()[0].counts.faces, 20u);
}

TEST(TileCells, AreThereForAnyMagnitude) {
  const float largest = std::numeric_limits<float>::max();
  const float least = std::numeric_limits<float>::denorm_min();
  for (const float x : {largest, 1.0f, least, 0.0f}) {
    const std::vector<Triangle> faces = {{{{x, x, x}, {x, 0, x}, {0, x, x}}},
                                         {{{-x, -x, -x}, {-x, 0, -x}, {0, 0, -x}}}};
    const TileTree tree = tree_of(faces, 1);
    std::uint64_t sum = 0;
    for (const TileTree::Tile& tile : tree.tiles()) sum += tile.counts.faces;
    EXPECT_EQ(sum, 2u);
  }
}

}  // namespace
}  // namespace boxtree::cooker
