// SPDX-License-Identifier: MIT
// Casts, contacts and overlaps of any shape: what the public functions of each shape call.
#pragma once

#include <boxtree/cast.h>
#include <boxtree/configuration.h>
#if BOXTREE_HAS_COLLIDE_QUERIES
#include <boxtree/collide.h>
#endif

#include "runtime/query/cast_query.h"
#include "runtime/query/shape_in_tree.h"

namespace boxtree {

/// Callers hold a DefaultFloatState, from before the shape was brought into tree space.
[[nodiscard]] CastResult one_touch_in(const BoundTree& tree, const ShapeInTree& shape,
                                      const Motion& motion, CastQuery::Wanted wanted,
                                      const FaceOptions& options);
[[nodiscard]] Result<Visit> all_touches_in(const BoundTree& tree, const ShapeInTree& shape,
                                           const Motion& motion, CastVisitor visitor,
                                           const FaceOptions& options);

#if BOXTREE_HAS_COLLIDE_QUERIES
[[nodiscard]] Result<Visit> visit_contacts_in(const BoundTree& tree, const ShapeInTree& shape,
                                              ContactVisitor visitor, const QueryLimits& limits);
[[nodiscard]] Result<Visit> visit_touched_faces_in(const BoundTree& tree, const ShapeInTree& shape,
                                                   FaceVisitor visitor, const QueryLimits& limits);
#endif

}  // namespace boxtree
