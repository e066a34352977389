// SPDX-License-Identifier: MIT
// Many rays at a time through a scene, in world coordinates.
#pragma once

#include <span>

#include <boxtree/ray_batch.h>
#include <boxtree/scene.h>

namespace boxtree {

/// The closest hit of each of `rays`, to the bit what closest_hit() of the scene answers it, in as
/// much time. `results` has as many elements; an error of a ray is its own result. Returns
/// kInvalidQuery if their numbers differ, else kOk. Never allocates.
BOXTREE_API Status closest_hits(const Scene& scene, std::span<const Ray> rays,
                                std::span<SceneRayResult> results, LayerMask layers = kAllLayers,
                                const QueryLimits& limits = {});

/// The same for any_hit().
BOXTREE_API Status any_hits(const Scene& scene, std::span<const Ray> rays,
                            std::span<SceneRayResult> results, LayerMask layers = kAllLayers,
                            const QueryLimits& limits = {});

}  // namespace boxtree
