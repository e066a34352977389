// SPDX-License-Identifier: MIT
// Tree against tree: the pairs of faces that share a point, each tree with a pose of its own.
#pragma once

#include <boxtree/configuration.h>
#include <boxtree/export.h>
#include <boxtree/query.h>

namespace boxtree {

static_assert(BOXTREE_HAS_PAIR_QUERIES,
              "BOXTREE_QUERIES left pair queries out of this build of boxtree");

/// Visits every pair of faces that share a point, each once, in no promised order. Poses take
/// object space to world and may be any invertible affine map: rotation, scale, mirror, shear.
/// The surfaces are compared, not the solids: a tree wholly inside the other gives no pair.
///
/// Answers are exact for the coordinates that arise when the second tree's triangles are brought
/// into the first one's space in double precision (translations subtracted first).
/// Errors: kInvalidPose (not finite, not invertible) and the codes of corrupt bytes as for
/// closest_hit(); kWorkLimit. Never allocates; takes up to 320 KB of stack.
BOXTREE_API Result<Visit> overlap_pairs(const Tree& first, const Pose& first_pose,
                                        const Tree& second, const Pose& second_pose,
                                        PairVisitor visitor, const QueryLimits& limits = {});

/// Some pair of faces that share a point, or nothing: cheaper than overlap_pairs() when only the
/// fact matters. Exactness, errors, stack and threads as there.
BOXTREE_API QueryResult<FacePair> first_contact(const Tree& first, const Pose& first_pose,
                                                const Tree& second, const Pose& second_pose,
                                                const QueryLimits& limits = {});

}  // namespace boxtree
