// SPDX-License-Identifier: MIT
// What the two builders share: a split rule is a function from a set of faces to two smaller sets.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include <boxtree/cooker/build/build_tree.h>

namespace boxtree::cooker {

/// Half the surface of a box, in double so that thin boxes do not round to nothing.
[[nodiscard]] inline double half_area(const Box<float>& box) {
  const double x = double{box.high[0]} - box.low[0];
  const double y = double{box.high[1]} - box.low[1];
  const double z = double{box.high[2]} - box.low[2];
  return x * y + y * z + z * x;
}

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

/// Divides so that the left side fills whole leaves of kLeafFaces, and whole nodes of leaves as far
/// as there are any; the right side keeps the rest. Precondition: more than one leaf of faces.
[[nodiscard]] std::optional<Split> split_sah_full_leaves(std::span<FaceBox> faces,
                                                         const Box<float>& bounds);

/// Halves the set by box centre along the widest axis, ties by face number, into a left side of a
/// multiple of `unit` faces: always succeeds, and bounds the depth. Precondition: more faces than
/// `unit`.
[[nodiscard]] Split split_median(std::span<FaceBox> faces, const Box<float>& bounds,
                                 std::size_t unit = 1);

}  // namespace boxtree::cooker
