// SPDX-License-Identifier: MIT
// The closest points to many points at a time.
#pragma once

#include <limits>
#include <span>

#include <boxtree/closest.h>

namespace boxtree {

/// The nearest point of the surface to each of `points`, to the bit what closest_point() answers
/// it: in less time, the more so the nearer consecutive points are to each other, as those of a
/// crowd, of a robot's spheres or of a lattice are. `results` has as many elements; an error of a
/// point is its own result. Returns kInvalidQuery if their numbers differ, else kOk. Uses the
/// calling thread alone and less than 96 KB of its stack. Never allocates.
BOXTREE_API Status closest_points(const Tree& tree, std::span<const Eigen::Vector3d> points,
                                  std::span<PointResult> results,
                                  double max_distance = std::numeric_limits<double>::infinity(),
                                  const QueryLimits& limits = {});

}  // namespace boxtree
