// SPDX-License-Identifier: MIT
// The closest points of a scene to many points at a time, in world coordinates.
#pragma once

#include <limits>
#include <span>

#include <boxtree/closest_batch.h>
#include <boxtree/scene.h>

namespace boxtree {

/// The nearest point of any surface to each of `points`, to the bit what closest_point() of the
/// scene answers it, in as much time. `results` has as many elements; an error of a point is its
/// own result. Returns kInvalidQuery if their numbers differ, else kOk. Never allocates.
BOXTREE_API Status closest_points(const Scene& scene, std::span<const Eigen::Vector3d> points,
                                  std::span<ScenePointResult> results,
                                  double max_distance = std::numeric_limits<double>::infinity(),
                                  LayerMask layers = kAllLayers, const QueryLimits& limits = {});

}  // namespace boxtree
