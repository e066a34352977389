// SPDX-License-Identifier: MIT
#include "runtime/query/known_extents.h"

#include <cstddef>
#include <cstdint>
#include <memory>

#include <gtest/gtest.h>

namespace boxtree {
namespace {

// Another subtree's extent in their place would skip what is near.
TEST(KnownExtents, AreThoseThatWereKeptOrUnknown) {
  const auto known = std::make_unique<KnownExtents>();
  const auto extent_of = [](std::uint32_t i, bool is_leaf, int turn) {
    const double at = i + (is_leaf ? 0.5 : 0.25) + turn * 1e6;
    return Box<double>{{at, -at, 2 * at}, {at + 1, 0, 3 * at}};
  };
  // Leaves of one face and full ones, nodes of wide and of binary codecs.
  for (const NodeRef step : {NodeRef{1, 0}, NodeRef{8, 0}, NodeRef{64, 0}, NodeRef{1, 3}}) {
    for (int turn = 0; turn < 3; ++turn) {
      constexpr std::uint32_t kMany = 3000;
      for (std::uint32_t i = 0; i < kMany; ++i) {
        for (const bool is_leaf : {false, true}) {
          known->keep({i * step.first, i * step.second}, is_leaf, extent_of(i, is_leaf, turn));
        }
      }
      std::size_t found = 0;
      for (std::uint32_t i = 0; i < kMany; ++i) {
        for (const bool is_leaf : {false, true}) {
          const Box<double>* const extent = known->find({i * step.first, i * step.second}, is_leaf);
          if (!extent) continue;
          ++found;
          EXPECT_EQ(*extent, extent_of(i, is_leaf, turn));
        }
      }
      EXPECT_GT(found, 200u);
      known->forget();
      for (std::uint32_t i = 0; i < kMany; ++i) {
        for (const bool is_leaf : {false, true}) {
          EXPECT_EQ(known->find({i * step.first, i * step.second}, is_leaf), nullptr);
        }
      }
    }
  }
}

}  // namespace
}  // namespace boxtree
