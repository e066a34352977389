// SPDX-License-Identifier: MIT
// World boxes against placed trees of the wide codecs.
#include <algorithm>
#include <cmath>

#include "runtime/primitive/rounding.h"
#include "runtime/scene/placed_box.h"
#include "runtime/tree/float_range.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/targets.h"
#include "runtime/walk/walk_tree.h"

#ifndef HWY_TARGET_INCLUDE  // compiled alone
#define HWY_TARGET_INCLUDE "runtime/scene/placed_box_wide.cpp"
#endif
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include "runtime/walk/box_bounds-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if !BOXTREE_HAS_SPECIAL_WALKS
Errc walk_placed_box(const BoundTree& tree, FaceWalk<PlacedBoxQuery>& faces) {
  return traverse_overlap(tree, ErasedCodec{&tree}, faces);
}
#else
// The boxes and corners of a placed tree as hulls in the world, relative to the middle of the
// query's box, widened by what float loses: rounding of the rows of the map, of its products and
// sums, and of triangles; less than 16 roundings of the largest sum. World coordinates themselves
// are rounded to double before they are relative to the box: less than 8 roundings.
class PlacedBoxFilter {
 public:
  PlacedBoxFilter(const BoundTree& tree, const PlacedBoxQuery& query) {
    const Eigen::Vector3d max_abs = tree.max_abs();
    for (std::size_t k = 0; k < 3; ++k) {
      const auto row = static_cast<Eigen::Index>(k);
      const double middle = query.box.low[k] / 2 + query.box.high[k] / 2;
      const double offset = query.to_world.translation[row] - middle;
      double terms = std::abs(offset);
      for (std::size_t j = 0; j < 3; ++j) {
        const double factor = query.to_world.linear(row, static_cast<Eigen::Index>(j));
        linear_[k][j] = static_cast<float>(factor);
        terms += std::abs(factor) * max_abs[static_cast<Eigen::Index>(j)];
      }
      const double placed = std::abs(query.to_world.translation[row]) + terms;
      const double error = 16 * kRoundoffF32 * terms + 8 * kRoundoffF64 * placed + kFloatUnderflow;
      offset_[k] = static_cast<float>(offset);
      bounds_.set(k, query.box.low[k] - middle, query.box.high[k] - middle, error);
    }
  }

  HWY_INLINE Classification classify(const VectorBox& box) const {
    return bounds_.classify(hull(box));
  }
  HWY_INLINE Classification classify(const VectorTriangle& triangle) const {
    return classify_corners(
        bounds_, {image(triangle.corner[0]), image(triangle.corner[1]), image(triangle.corner[2])});
  }

 private:
  HWY_INLINE VectorPoint image(const VectorPoint& point) const {
    VectorPoint image;
    for (std::size_t k = 0; k < 3; ++k) {
      image.axis[k] = hn::Set(Floats(), offset_[k]);
      for (std::size_t j = 0; j < 3; ++j) {
        image.axis[k] = hn::MulAdd(hn::Set(Floats(), linear_[k][j]), point.axis[j], image.axis[k]);
      }
    }
    return image;
  }

  HWY_INLINE VectorBox hull(const VectorBox& box) const {
    VectorBox image;
    for (std::size_t k = 0; k < 3; ++k) {
      image.low[k] = image.high[k] = hn::Set(Floats(), offset_[k]);
      for (std::size_t j = 0; j < 3; ++j) {
        const FloatVector factor = hn::Set(Floats(), linear_[k][j]);
        const bool turns = linear_[k][j] < 0;
        image.low[k] = hn::MulAdd(factor, turns ? box.high[j] : box.low[j], image.low[k]);
        image.high[k] = hn::MulAdd(factor, turns ? box.low[j] : box.high[j], image.high[k]);
      }
    }
    return image;
  }

  std::array<std::array<float, 3>, 3> linear_;
  std::array<float, 3> offset_;
  BoxBounds bounds_;
};

Errc walk_placed_box(const BoundTree& tree, FaceWalk<PlacedBoxQuery>& faces) {
  return with_wide_codec<Errc>(
      tree, [&](const auto& codec) { return walk<PlacedBoxFilter>(tree, codec, faces); });
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "runtime/walk/dispatch.h"

namespace boxtree {
namespace {

BOXTREE_EXPORT(walk_placed_box);

// Whether no product or sum of the filter overflows: coordinates are at most kFloatMaxAbs.
bool is_in_range(const BoundTree& tree, const PlacedBoxQuery& query) {
  constexpr double kLargest = 0x1p80;
  double largest = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    largest = std::max({largest, std::abs(query.box.low[k]), std::abs(query.box.high[k]),
                        std::abs(query.to_world.translation[static_cast<Eigen::Index>(k)])});
  }
  const double factor = query.to_world.linear.cwiseAbs().maxCoeff();
  return tree.has_float_nodes() && largest <= kLargest && factor <= kLargest;
}

}  // namespace

Errc walk_wide(const BoundTree& tree, FaceWalk<PlacedBoxQuery>& walk) {
  if (is_in_range(tree, walk.shape)) {
    return BOXTREE_DISPATCH(walk_placed_box)(tree, walk);
  }
  return traverse_overlap(tree, ErasedCodec{&tree}, walk);
}

}  // namespace boxtree
#endif
