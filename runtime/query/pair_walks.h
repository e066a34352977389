// SPDX-License-Identifier: MIT
// How two trees of one codec are walked together: see walk_tree.h.
#pragma once

#include "format/codec_wide.h"
#include "runtime/query/pair_walk.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {

/// The walk by vectors. Precondition: both trees have the same wide codec.
Result<Visit> walk_wide_pairs(const BoundTree& first, const BoundTree& second,
                              const RelativePose& pose, PairVisitor visitor, PairBound& bound);

/// Visits the pairs of faces that touch. Errors: those of corrupt nodes and leaves, kWorkLimit.
template <Codec C>
Result<Visit> walk_pairs(const BoundTree& first, const C& first_codec, const BoundTree& second,
                         const C& second_codec, const RelativePose& pose, PairVisitor visitor,
                         PairBound& bound) {
  if constexpr (kIsWalkedByVectors<C>) {
    return walk_wide_pairs(first, second, pose, visitor, bound);
  } else {
    return PairWalk(first, first_codec, second, second_codec, pose, visitor, bound).run();
  }
}

}  // namespace boxtree
