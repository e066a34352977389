// SPDX-License-Identifier: MIT
// Box query: the faces that share a point with an axis-aligned box.
#pragma once

#include <boxtree/configuration.h>
#include <boxtree/runtime/query/types.h>
#include <boxtree/runtime/query/work.h>

namespace boxtree {

static_assert(kHasBoxQueries, "BOXTREE_QUERIES left box queries out of this build of boxtree");

/// Visits every face that touches the closed box `box` (object space), each once, in no promised
/// order. Touching counts. Errors: kInvalidQuery (NaN, infinite or empty box) and the codes of
/// corrupt bytes and limits as for closest_hit. Never allocates.
Result<Visit> overlap_box(const Tree& tree, const Eigen::AlignedBox3d& box, FaceVisitor visitor,
                          const QueryLimits& limits = {});

}  // namespace boxtree
