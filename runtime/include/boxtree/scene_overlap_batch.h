// SPDX-License-Identifier: MIT
// What of a scene touches many boxes or spheres at a time, in world coordinates.
#pragma once

#include <cstddef>
#include <span>

#include <boxtree/overlap_batch.h>
#include <boxtree/scene.h>

namespace boxtree {

/// Receives the number of a shape in its batch and a face that touches it; returns whether to go on
/// with this shape.
using SceneBatchFaceVisitor = FunctionRef<bool(std::size_t, const SceneFace&)>;

/// Visits for each of `boxes` the faces that overlap_box() of the scene visits, in as much time.
/// `results` has as many elements; an error of a box is its own result. Returns kInvalidQuery if
/// their numbers differ, else kOk. Never allocates.
BOXTREE_API Status overlap_boxes(const Scene& scene, std::span<const Eigen::AlignedBox3d> boxes,
                                 std::span<VisitResult> results, SceneBatchFaceVisitor visitor,
                                 LayerMask layers = kAllLayers, const QueryLimits& limits = {});

/// The same of spheres and overlap_sphere().
BOXTREE_API Status overlap_spheres(const Scene& scene, std::span<const Sphere> spheres,
                                   std::span<VisitResult> results, SceneBatchFaceVisitor visitor,
                                   LayerMask layers = kAllLayers, const QueryLimits& limits = {});

}  // namespace boxtree
