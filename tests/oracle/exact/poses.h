// SPDX-License-Identifier: MIT
// Poses of the exact oracle, and the exact composition of those that have one.
#pragma once

#include <optional>

#include <boxtree/boxtree.h>

#include "tests/oracle/exact/draw.h"
#include "tests/oracle/exact/geometry.h"
#include "tests/oracle/exact/subject.h"

namespace boxtree::oracle {

/// A linear map about the size of 1: axes exchanged, turned, sheared, mirrored, or with an axis of
/// 1e-20.
[[nodiscard]] Eigen::Matrix3d draw_linear(Draw& draw);
/// Axes exchanged and mirrored, times a power of two: products with it are exact.
[[nodiscard]] Eigen::Matrix3d draw_exact_linear(Draw& draw, int low, int high);

struct PlacedPair {
  Pose first = Pose::Identity();
  Pose second = Pose::Identity();
  bool may_be_exact = false;  // see exact_images()
};
/// Two poses that bring some point of the second mesh near, onto or far from one of the first.
/// `first`, `second`: decoded triangles.
[[nodiscard]] PlacedPair draw_poses(Draw& draw, const Group& first, const Group& second);

/// A point of a triangle, in object space and as rounding has it.
[[nodiscard]] Point draw_point_on(Draw& draw, const Face& triangle);

/// Where the second tree's triangles lie in the first one's space, by rational composition of
/// frames and poses; nothing where a coordinate is no double. Precondition: `poses.may_be_exact`.
[[nodiscard]] std::optional<std::vector<Face>> exact_images(const Group& first, const Group& second,
                                                            const PlacedPair& poses);

/// Where they lie by the map that the runtime composes, applied here; nothing where it refuses.
struct Images {
  std::vector<Decoded> triangles;
};
[[nodiscard]] std::optional<Images> images(const Tree& first, const Group& second,
                                           const PlacedPair& poses, const Tree& second_tree);

}  // namespace boxtree::oracle
