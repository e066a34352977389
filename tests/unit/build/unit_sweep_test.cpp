// SPDX-License-Identifier: MIT
// Divisions against sorting each part anew and looking at every face.
#include "cooker/build/unit_sweep.h"

#include <algorithm>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "cooker/build/full_nodes.h"

namespace boxtree::cooker {
namespace {

// Boxes on a coarse lattice, so that centres and costs tie; `flat` ones have no extent along z.
std::vector<FaceBox> random_boxes(unsigned seed, std::size_t count, bool flat) {
  std::mt19937 random(seed);
  std::vector<FaceBox> faces(count);
  for (std::size_t i = 0; i < count; ++i) {
    faces[i].face = static_cast<std::uint32_t>((i * 7919) % count);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto low = static_cast<float>(random() % 20);
      faces[i].box.low[k] = flat && k == 2 ? 0 : low;
      faces[i].box.high[k] = flat && k == 2 ? 0 : low + static_cast<float>(random() % 4);
    }
  }
  return faces;
}

void sort_along(std::vector<FaceBox>& faces, std::size_t axis) {
  std::sort(faces.begin(), faces.end(), [axis](const FaceBox& a, const FaceBox& b) {
    const double ca = centre(a, axis), cb = centre(b, axis);
    return ca != cb ? ca < cb : a.face < b.face;
  });
}

Split naive_split(std::vector<FaceBox> faces, std::size_t roots) {
  const std::size_t leaves = leaves_of(faces.size());
  SplitCost best;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    sort_along(faces, axis);
    for (std::size_t i = kLeafFaces; i < faces.size(); i += kLeafFaces) {
      if (roots_on_left(i / kLeafFaces, leaves, roots) == 0) continue;
      Box<float> left = empty_box<float>(), right = empty_box<float>();
      for (std::size_t j = 0; j < faces.size(); ++j) expand(j < i ? left : right, faces[j].box);
      const SplitCost here{half_area(left) * static_cast<double>(leaves_of(i)) +
                               half_area(right) * static_cast<double>(leaves_of(faces.size() - i)),
                           imbalance(i, faces.size() - i), axis, i};
      if (here.improves_on(best)) best = here;
    }
  }
  return {best.position, static_cast<std::uint32_t>(best.axis)};
}

std::vector<std::uint32_t> numbers_of(std::span<const FaceBox> faces) {
  std::vector<std::uint32_t> numbers;
  for (const FaceBox& face : faces) numbers.push_back(face.face);
  std::sort(numbers.begin(), numbers.end());
  return numbers;
}

void expect_like_naive(UnitSweep& sweep, std::size_t first, std::vector<FaceBox> faces,
                       std::size_t roots) {
  const std::size_t last = first + faces.size();
  Box<float> bounds = empty_box<float>();
  for (const FaceBox& face : faces) expand(bounds, face.box);
  ASSERT_EQ(sweep.bounds(first, last), bounds);
  std::vector<FaceBox> copied(faces.size());
  sweep.copy_to(first, copied);
  ASSERT_TRUE(std::is_sorted(copied.begin(), copied.end(),
                             [](const FaceBox& a, const FaceBox& b) { return a.face < b.face; }));
  ASSERT_EQ(numbers_of(copied), numbers_of(faces));
  if (faces.size() <= kLeafFaces) return;
  roots = children_of(roots);
  const Split split = sweep.best_split(first, last, roots), expected = naive_split(faces, roots);
  ASSERT_EQ(split.left_count, expected.left_count);
  ASSERT_EQ(split.axis, expected.axis);
  sweep.divide(first, last, split);
  sort_along(faces, split.axis);
  const auto middle = faces.begin() + static_cast<std::ptrdiff_t>(split.left_count);
  const std::size_t left_roots =
      roots_on_left(split.left_count / kLeafFaces, leaves_of(faces.size()), roots);
  expect_like_naive(sweep, first, {faces.begin(), middle}, left_roots);
  expect_like_naive(sweep, first + split.left_count, {middle, faces.end()}, roots - left_roots);
}

TEST(UnitSweep, DividesLikeANaiveSweepDownToTheLeaves) {
  for (const std::size_t count : {9u, 64u, 65u, 100u, 511u, 512u, 1500u}) {
    for (unsigned seed = 0; seed < 4; ++seed) {
      SCOPED_TRACE(count);
      const std::vector<FaceBox> faces = random_boxes(seed, count, seed % 2 == 1);
      UnitSweep sweep(faces);
      expect_like_naive(sweep, 0, faces, 1);
    }
  }
}

// Large sets are divided by bins: the left side is whole leaves of the faces with the lowest
// centres, as many as fill nodes.
TEST(SplitSahFullLeaves, LeftSideIsTheLowestFullNodes) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    std::vector<FaceBox> faces = random_boxes(seed, 5000 + 37 * seed, seed % 2 == 1);
    std::vector<FaceBox> sorted = faces;
    const std::size_t roots = 2 + seed % 7;
    const std::optional<Split> split = split_sah_full_leaves(faces, roots);
    ASSERT_TRUE(split);
    EXPECT_EQ(split->left_count % kLeafFaces, 0u);
    EXPECT_NE(roots_on_left(split->left_count / kLeafFaces, leaves_of(faces.size()), roots), 0u);
    EXPECT_GT(split->left_count, 0u);
    EXPECT_LT(split->left_count, faces.size());
    sort_along(sorted, split->axis);
    EXPECT_EQ(numbers_of(std::span(faces).first(split->left_count)),
              numbers_of(std::span(sorted).first(split->left_count)));
    EXPECT_EQ(numbers_of(faces), numbers_of(sorted));
  }
}

TEST(FullNodes, NearestSideIsOpenAndNoneIsNearer) {
  for (std::size_t roots = 2; roots <= kWideChildren; ++roots) {
    for (std::size_t leaves = 2; leaves < 60; ++leaves) {
      for (std::size_t wanted = 1; wanted < leaves; ++wanted) {
        const std::size_t side = nearest_full_side(wanted, leaves, roots);
        ASSERT_GT(side, 0u);
        ASSERT_LT(side, leaves);
        ASSERT_NE(roots_on_left(side, leaves, roots), 0u);
        for (std::size_t nearer = 1; nearer < leaves; ++nearer) {
          if (imbalance(nearer, wanted) >= imbalance(side, wanted)) continue;
          ASSERT_EQ(roots_on_left(nearer, leaves, roots), 0u);
        }
      }
    }
  }
}

}  // namespace
}  // namespace boxtree::cooker
