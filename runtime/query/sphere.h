// SPDX-License-Identifier: MIT
// Sphere query: the faces that come within a radius of a point.
#pragma once

#include <boxtree/configuration.h>
#include <boxtree/runtime/query/types.h>
#include <boxtree/runtime/query/work.h>

namespace boxtree {

static_assert(kHasSphereQueries,
              "BOXTREE_QUERIES left sphere queries out of this build of boxtree");

/// Visits every face whose distance from `center` is at most `radius` (object space), each once, in
/// no promised order. Errors: kInvalidQuery (NaN, infinite, negative radius) and the codes of
/// corrupt bytes and limits as for closest_hit. Never allocates.
Result<Visit> overlap_sphere(const Tree& tree, const Eigen::Vector3d& center, double radius,
                             FaceVisitor visitor, const QueryLimits& limits = {});

}  // namespace boxtree
