// SPDX-License-Identifier: MIT
// Pairs of a body and the instances of a scene that may touch: what every query of contacts of
// trees in a scene walks.
#pragma once

#include <cstdint>

#include <boxtree/scene.h>

#include "runtime/scene/scene_body.h"
#include "runtime/scene/scene_walk.h"

namespace boxtree {

/// Compares two trees.
using BodyPairVisitor = FunctionRef<Result<Visit>(const BodyPair& pair, QueryWork& work)>;

/// Every moving instance with any other one, as contacts().
Result<Visit> visit_moving_pairs(const BoundScene& scene, BodyPairVisitor visitor,
                                 const QueryLimits& limits);
/// One instance with all others, as contacts_of().
Result<Visit> visit_pairs_of(const BoundScene& scene, std::uint32_t instance,
                             BodyPairVisitor visitor, const QueryLimits& limits);
/// A tree that is no part of the scene with all instances, as overlap_pairs().
Result<Visit> visit_pairs_with(const BoundScene& scene, const BoundTree& tree, const Pose& pose,
                               BodyPairVisitor visitor, LayerMask layers,
                               const QueryLimits& limits);

}  // namespace boxtree
