// SPDX-License-Identifier: MIT
// What a pose does to a shape: where points go, whether faces turn, and how glTF may be told.
#pragma once

#include <vector>

#include <boxtree/query.h>

#include "runtime/query/relative_pose.h"

namespace boxtree::cooker {

/// apply() of it is a point in the world: ((t + m0 x) + m1 y) + m2 z in double on each axis.
[[nodiscard]] inline AffineMap map_of(const Pose& pose) {
  return {pose.linear(), pose.translation()};
}

[[nodiscard]] inline bool is_identity(const Pose& pose) {
  return pose.matrix() == Pose::Identity().matrix();
}

/// Whether `pose` turns shapes inside out, so that a face keeps its front only if its corners are
/// named the other way round. Exact.
[[nodiscard]] bool mirrors(const Pose& pose);

/// Matrices of nested nodes, the outermost first, whose product is `pose`. glTF 2.0 demands that
/// each be made of a translation, a rotation and a scale, and viewers that decompose a matrix lose
/// what is not: a pose that shears becomes two, equal to it but for rounding. Any other pose is one
/// matrix, as it is.
[[nodiscard]] std::vector<Pose> node_matrices(const Pose& pose);

}  // namespace boxtree::cooker
