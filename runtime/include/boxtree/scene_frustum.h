// SPDX-License-Identifier: MIT
// What a frustum, as the view of a camera, holds of a scene: instances, or their faces.
#pragma once

#include <cstdint>

#include <boxtree/overlap.h>
#include <boxtree/scene.h>

namespace boxtree {

static_assert(BOXTREE_HAS_FRUSTUM_QUERIES,
              "BOXTREE_QUERIES left frustum queries out of this build of boxtree");

/// Visits every face that touches the frustum, whose planes are those of the world, each once, in
/// no promised order: as overlap_frustum() of a tree, for the triangles that arise when each corner
/// is brought into the world in double precision. Layers count that answer boxes. Errors: those of
/// overlap_frustum() on a tree; kPartLeftOut. Never allocates.
BOXTREE_API Result<Visit> overlap_frustum(const Scene& scene, const Frustum& frustum,
                                          SceneFaceVisitor visitor, LayerMask layers = kAllLayers,
                                          const QueryLimits& limits = {});

/// Receives the number of one instance after the other; returns whether to go on.
using SceneInstanceVisitor = FunctionRef<bool(std::uint32_t)>;

/// Visits every instance that may touch the frustum, each once, in no promised order, for culling:
/// those of which no plane has all of the bounds outside, as the pose turns them. None is missed;
/// one may be visited that is beside an edge or a corner of the frustum. Reads no node of its tree.
/// Layers, errors and limits as above. Never allocates.
BOXTREE_API Result<Visit> instances_in_frustum(const Scene& scene, const Frustum& frustum,
                                               SceneInstanceVisitor visitor,
                                               LayerMask layers = kAllLayers,
                                               const QueryLimits& limits = {});

}  // namespace boxtree
