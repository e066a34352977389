// SPDX-License-Identifier: MIT
// The effect of a pose on a shape: its map of points, whether faces are reversed, and its matrices
// in glTF.
#pragma once

#include <vector>

#include <boxtree/query.h>

#include "runtime/query/relative_pose.h"

namespace boxtree::cooker {

/// Its apply() maps a point to the world: ((t + m0 x) + m1 y) + m2 z in double on each axis.
[[nodiscard]] inline AffineMap map_of(const Pose& pose) {
  return {pose.linear(), pose.translation()};
}

[[nodiscard]] inline bool is_identity(const Pose& pose) {
  return pose.matrix() == Pose::Identity().matrix();
}

/// Whether `pose` mirrors, so that a face keeps its front only if its corners are reversed. Exact.
[[nodiscard]] bool mirrors(const Pose& pose);

/// Matrices of nested nodes, outermost first, whose product is `pose`. glTF 2.0 requires each to
/// consist of a translation, a rotation and a scale; viewers that decompose a matrix lose any
/// shear. A pose that shears becomes two matrices, equal to it up to rounding. Any other pose is
/// one matrix, unchanged.
[[nodiscard]] std::vector<Pose> node_matrices(const Pose& pose);

}  // namespace boxtree::cooker
