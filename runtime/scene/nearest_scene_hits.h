// SPDX-License-Identifier: MIT
// The order of the hits of a scene.
#pragma once

#include <boxtree/scene.h>

#include "runtime/query/nearest_hits.h"

namespace boxtree {

/// Whether nearest_hits() has `a` before `b`.
[[nodiscard]] bool comes_first(const Scene& scene, const SceneRayHit& a,
                               const SceneRayHit& b) noexcept;

}  // namespace boxtree
