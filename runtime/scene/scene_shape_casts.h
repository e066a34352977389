// SPDX-License-Identifier: MIT
// Casts, contacts and overlaps of any shape in a scene: what the public functions of each shape
// call.
#pragma once

#include <boxtree/configuration.h>
#include <boxtree/scene_cast.h>
#if BOXTREE_HAS_COLLIDE_QUERIES
#include <boxtree/scene_collide.h>
#endif

#include "runtime/query/cast_query.h"
#include "runtime/query/shape_in_tree.h"
#include "runtime/scene/bound_scene.h"

namespace boxtree {

/// Shapes are in units of the scene. Callers hold a DefaultFloatState, from before the shape was
/// brought there.
[[nodiscard]] SceneCastResult one_touch_in(const BoundScene& scene, const ShapeInTree& shape,
                                           const Motion& motion, CastQuery::Wanted wanted,
                                           const SceneFaceOptions& options);
[[nodiscard]] Result<Visit> all_touches_in(const BoundScene& scene, const ShapeInTree& shape,
                                           const Motion& motion, SceneCastVisitor visitor,
                                           const SceneFaceOptions& options);

#if BOXTREE_HAS_COLLIDE_QUERIES
[[nodiscard]] Result<Visit> visit_contacts_in(const BoundScene& scene, const ShapeInTree& shape,
                                              SceneContactVisitor visitor, LayerMask layers,
                                              const QueryLimits& limits);
[[nodiscard]] Result<Visit> visit_touched_faces_in(const BoundScene& scene,
                                                   const ShapeInTree& shape,
                                                   SceneFaceVisitor visitor, LayerMask layers,
                                                   const QueryLimits& limits);
#endif

}  // namespace boxtree
