// SPDX-License-Identifier: MIT
// A sweep over leaves, and stable division of the orders along the two other axes.
#include "cooker/build/unit_sweep.h"

#include <algorithm>
#include <cassert>

#include "cooker/build/build_tree.h"
#include "cooker/build/full_nodes.h"

namespace boxtree::cooker {
namespace {

struct Key {
  double centre;
  std::uint32_t face;
  std::uint16_t place;

  [[nodiscard]] bool operator<(const Key& other) const {
    return centre != other.centre ? centre < other.centre : face < other.face;
  }
};

}  // namespace

UnitSweep::UnitSweep(std::span<const FaceBox> faces) : faces_(faces.begin(), faces.end()) {
  assert(faces.size() <= kMaxFaces);
  std::vector<Key> keys(faces.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (std::size_t i = 0; i < faces.size(); ++i) {
      keys[i] = {centre(faces[i], axis), faces[i].face, static_cast<std::uint16_t>(i)};
    }
    std::sort(keys.begin(), keys.end());
    sorted_[axis].resize(keys.size());
    std::transform(keys.begin(), keys.end(), sorted_[axis].begin(),
                   [](const Key& key) { return key.place; });
  }
}

Box<float> UnitSweep::bounds(std::size_t first, std::size_t last) const {
  Box<float> box = empty_box<float>();
  for (std::size_t i = first; i < last; ++i) expand(box, faces_[sorted_[0][i]].box);
  return box;
}

Split UnitSweep::best_split(std::size_t first, std::size_t last, std::size_t roots) const {
  const std::size_t count = last - first;
  const std::size_t leaves = leaves_of(count);
  SplitCost best;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::array<Box<float>, kMaxFaces / kLeafFaces> box;  // of each leaf
    for (std::size_t leaf = 0; leaf < leaves; ++leaf) {
      box[leaf] = empty_box<float>();
      const std::size_t end = std::min(last, first + (leaf + 1) * kLeafFaces);
      for (std::size_t i = first + leaf * kLeafFaces; i < end; ++i) {
        expand(box[leaf], faces_[sorted_[axis][i]].box);
      }
    }
    // A query that enters a side visits its leaves.
    std::array<double, kMaxFaces / kLeafFaces> right_cost;  // of leaves from this one on
    Box<float> right = empty_box<float>();
    for (std::size_t leaf = leaves; leaf-- > 1;) {
      expand(right, box[leaf]);
      right_cost[leaf] = half_area(right) * static_cast<double>(leaves - leaf);
    }
    Box<float> left = empty_box<float>();
    for (std::size_t leaf = 1; leaf < leaves; ++leaf) {
      expand(left, box[leaf - 1]);
      if (roots_on_left(leaf, leaves, roots) == 0) continue;
      const std::size_t faces = leaf * kLeafFaces;
      const SplitCost here{half_area(left) * static_cast<double>(leaf) + right_cost[leaf],
                           imbalance(faces, count - faces), axis, faces};
      if (here.improves_on(best)) best = here;
    }
  }
  return {best.position, static_cast<std::uint32_t>(best.axis)};
}

void UnitSweep::divide(std::size_t first, std::size_t last, const Split& split) {
  std::array<bool, kMaxFaces> goes_left;
  for (std::size_t i = first; i < last; ++i) {
    goes_left[sorted_[split.axis][i]] = i < first + split.left_count;
  }
  std::array<std::uint16_t, kMaxFaces> right;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (axis == split.axis) continue;
    std::size_t lefts = first, rights = 0;
    // Both are written and one is kept: a branch here would be unpredictable.
    for (std::size_t i = first; i < last; ++i) {
      const std::uint16_t place = sorted_[axis][i];
      sorted_[axis][lefts] = place;
      right[rights] = place;
      lefts += goes_left[place] ? 1u : 0u;
      rights += goes_left[place] ? 0u : 1u;
    }
    std::copy_n(right.begin(), rights, sorted_[axis].begin() + static_cast<std::ptrdiff_t>(lefts));
  }
}

void UnitSweep::copy_to(std::size_t first, std::span<FaceBox> to) const {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = faces_[sorted_[0][first + i]];
  std::sort(to.begin(), to.end(),
            [](const FaceBox& a, const FaceBox& b) { return a.face < b.face; });
}

}  // namespace boxtree::cooker
