// SPDX-License-Identifier: MIT
// What the two builders share: a split rule is a function from a set of faces to two smaller sets.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>

#include <boxtree/cooker/build/build_tree.h>
#include <boxtree/format/codec_wide.h>

namespace boxtree::cooker {

/// Half the surface of a box, in double so that thin boxes do not round to nothing.
[[nodiscard]] inline double half_area(const Box<float>& box) {
  const double x = double{box.high[0]} - box.low[0];
  const double y = double{box.high[1]} - box.low[1];
  const double z = double{box.high[2]} - box.low[2];
  return x * y + y * z + z * x;
}

/// Twice the centre of a box; the factor drops out of every comparison.
[[nodiscard]] inline double centre(const FaceBox& face, std::size_t axis) {
  return double{face.box.low[axis]} + face.box.high[axis];
}

[[nodiscard]] inline std::size_t imbalance(std::size_t left, std::size_t right) {
  return left > right ? left - right : right - left;
}

/// A division under consideration. Smaller cost wins, then the more even division, then the lower
/// axis: no cost can be NaN, and flat sets, whose costs are all zero, still split in the middle.
struct SplitCost {
  double cost = std::numeric_limits<double>::infinity();
  std::size_t imbalance = 0;
  std::size_t axis = 0;
  std::size_t position = 0;  // first bin, or first face of the sorted order, that goes right

  [[nodiscard]] bool improves_on(const SplitCost& best) const {
    return cost < best.cost || (cost == best.cost && imbalance < best.imbalance);
  }
};

/// Faces of a wide node above leaves. Sets of more than that are divided at multiples of it, so
/// that nodes above leaves, which are seven of eight, come out full.
inline constexpr std::size_t kNodeFaces = std::size_t{kLeafFaces} * kWideChildren;

/// Where a set was divided: faces [0, left_count) go left. Both sides are not empty.
struct Split {
  std::size_t left_count;
  std::uint32_t axis;
};

/// Reorders `faces` and divides them. The two resulting sets must depend on the set of faces alone,
/// not on their order, so that the tree does not depend on how an earlier partition shuffled them.
/// Nothing when the rule sees no difference between the faces.
using SplitRule = std::optional<Split> (*)(std::span<FaceBox> faces, const Box<float>& bounds);

[[nodiscard]] std::optional<Split> split_sah(std::span<FaceBox> faces, const Box<float>& bounds);
[[nodiscard]] std::optional<Split> split_paper(std::span<FaceBox> faces, const Box<float>& bounds);

/// Divides so that the left side fills whole nodes of kNodeFaces; the right side keeps the rest.
/// For large sets: UnitSweep divides those that it takes. Precondition: more faces than kNodeFaces.
[[nodiscard]] std::optional<Split> split_sah_full_leaves(std::span<FaceBox> faces,
                                                         const Box<float>& bounds);

/// Where to halve so many faces with these bounds: along the widest axis, into a left side of a
/// multiple of `unit` faces. Precondition: more faces than `unit`.
[[nodiscard]] Split median_of(std::size_t faces, const Box<float>& bounds, std::size_t unit);

/// Halves the set there by box centre, ties by face number: always succeeds, and bounds the depth.
[[nodiscard]] Split split_median(std::span<FaceBox> faces, const Box<float>& bounds,
                                 std::size_t unit = 1);

}  // namespace boxtree::cooker
