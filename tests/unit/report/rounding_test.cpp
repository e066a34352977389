// SPDX-License-Identifier: MIT
// What rounding f16 cuts to nearest loses, and that rounding outward loses nothing.
#include "cooker/report/rounding.h"

#include <gtest/gtest.h>

#include "cooker/cook.h"
#include "tests/support/meshes.h"

namespace boxtree::cooker {
namespace {

TEST(Rounding, StairsAreMissedByNearestAlone) {
  const Result<std::vector<StairFigures>> rows = stair_contact();
  ASSERT_TRUE(rows) << rows.error().message();
  ASSERT_EQ(rows->size(), 4u);
  for (const StairFigures& row : *rows) {
    EXPECT_EQ(row.missed_f32, 0u) << row.depth;
    EXPECT_EQ(row.missed_outward, 0u) << row.depth;
    EXPECT_GT(row.missed_nearest, 0u) << row.depth;
  }
}

TEST(Rounding, OutwardFindsAllThatF32Finds) {
  const SourceMesh mesh = test::torus(24, 16);
  CookOptions options;
  options.builder = Builder::kPaper;
  const Result<RoundingFigures> figures =
      aligned_contact(mesh, *cook_as(mesh, CodecId::kPlainF32, options),
                      *cook_as(mesh, CodecId::kPlainF16, options));
  ASSERT_TRUE(figures) << figures.error().message();
  EXPECT_EQ(figures->queries, 24u * 6 * 3);
  EXPECT_GT(figures->pairs_f32, 0u);
  EXPECT_EQ(figures->pairs_outward, figures->pairs_f32);
  EXPECT_LE(figures->pairs_nearest, figures->pairs_f32);
  EXPECT_TRUE(figures->gates_outward.pass());
  EXPECT_FALSE(figures->gates_nearest.pass());
}

}  // namespace
}  // namespace boxtree::cooker
