// SPDX-License-Identifier: MIT
// What touches many boxes or spheres at a time.
#pragma once

#include <cstddef>
#include <span>

#include <boxtree/overlap.h>

namespace boxtree {

/// How the visit of one shape of a batch ended, or its error.
using VisitResult = QueryResult<Visit>;

/// Receives the number of a shape in its batch and a face that touches it; returns whether to go on
/// with this shape. Faces of other shapes may come in between.
using BatchFaceVisitor = FunctionRef<bool(std::size_t, const FaceRef&)>;

#if BOXTREE_HAS_BOX_QUERIES
/// Visits every face that touches one of the closed boxes `boxes`, for each box those that
/// overlap_box() visits, in the same order: in less time, the more so the nearer consecutive boxes
/// are to each other, as those of a crowd or of the parts of a robot are. `results` has as many
/// elements; an error of a box is its own result. Returns kInvalidQuery if their numbers differ,
/// else kOk. Uses the calling thread alone and less than 96 KB of its stack. Never allocates.
BOXTREE_API Status overlap_boxes(const Tree& tree, std::span<const Eigen::AlignedBox3d> boxes,
                                 std::span<VisitResult> results, BatchFaceVisitor visitor,
                                 const QueryLimits& limits = {});
#endif

#if BOXTREE_HAS_SPHERE_QUERIES
/// The same of spheres and overlap_sphere().
BOXTREE_API Status overlap_spheres(const Tree& tree, std::span<const Sphere> spheres,
                                   std::span<VisitResult> results, BatchFaceVisitor visitor,
                                   const QueryLimits& limits = {});
#endif

}  // namespace boxtree
