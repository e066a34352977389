// SPDX-License-Identifier: MIT
// The walks of one codec of the paper: the generic walks, compiled for it.
#pragma once

#include <boxtree/configuration.h>

#if BOXTREE_HAS_PAIR_QUERIES
#include "runtime/query/pair_walk.h"
#endif
#if BOXTREE_HAS_POINT_QUERIES
#include "runtime/query/point_query.h"
#endif
#if BOXTREE_HAS_RAY_QUERIES
#include "runtime/query/ray_query.h"
#endif
#if BOXTREE_HAS_BOX_QUERIES || BOXTREE_HAS_SPHERE_QUERIES
#include "runtime/query/shape_query.h"
#endif
#include "runtime/walk/codec_walks.h"
#include "runtime/walk/traversal.h"

namespace boxtree {

template <Codec C, class Query>
Errc walk_nearest_as(const BoundTree& tree, Query& query) {
  return traverse_nearest(tree, tree.nodes().as<C>(), query);
}
template <Codec C, class Query>
Errc walk_overlap_as(const BoundTree& tree, Query& query) {
  return traverse_overlap(tree, tree.nodes().as<C>(), query);
}
#if BOXTREE_HAS_PAIR_QUERIES
template <Codec C>
Result<Visit> walk_pairs_as(const BoundTree& first, const BoundTree& second,
                            const RelativePose& pose, PairVisitor visitor, PairBound& bound) {
  return PairWalk(first, first.nodes().as<C>(), second, second.nodes().as<C>(), pose, visitor,
                  bound)
      .run();
}
#endif

/// The walks of codec C.
template <Codec C>
inline constexpr CodecWalks kWalksAs = {
#if BOXTREE_HAS_RAY_QUERIES
    .ray = walk_nearest_as<C, RayQuery>,
#endif
#if BOXTREE_HAS_POINT_QUERIES
    .point = walk_nearest_as<C, PointQuery>,
#endif
#if BOXTREE_HAS_BOX_QUERIES
    .box = walk_overlap_as<C, FaceWalk<BoxQuery>>,
#endif
#if BOXTREE_HAS_SPHERE_QUERIES
    .sphere = walk_overlap_as<C, FaceWalk<SphereQuery>>,
#endif
#if BOXTREE_HAS_PAIR_QUERIES
    .pairs = walk_pairs_as<C>,
#endif
};

// One source file per family of codecs, so that they compile in parallel.
extern const CodecFunctions kPlainF32Functions;
extern const CodecFunctions kPlainF16Functions;
extern const CodecFunctions kPackedF32Functions;
extern const CodecFunctions kPackedF16Functions;
extern const CodecFunctions kPackedF64Functions;
extern const CodecFunctions kDedupFunctions;

}  // namespace boxtree
