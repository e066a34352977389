// SPDX-License-Identifier: MIT
// Walks compiled for one codec. The wide codecs have walks by vectors instead. Any other codec may
// have these; without them it is walked by its functions, one indirect call per node.
#pragma once

#include <cstddef>
#include <type_traits>

#include <boxtree/query.h>

#include "runtime/tree/bound_tree.h"

namespace boxtree {

class PairBound;
class RelativePose;
struct FacePair;
struct BoxQuery;
struct PointQuery;
struct RayQuery;
struct SphereQuery;
template <class Shape>
struct FaceWalk;

/// Null for queries that were left out. Precondition of each: the tree, or both, are of the codec.
/// A query that has such walks needs a line here and one below.
struct CodecWalks {
  Errc (*ray)(const BoundTree& tree, RayQuery& query);
  Errc (*point)(const BoundTree& tree, PointQuery& query);
  Errc (*box)(const BoundTree& tree, FaceWalk<BoxQuery>& query);
  Errc (*sphere)(const BoundTree& tree, FaceWalk<SphereQuery>& query);
  Result<Visit> (*pairs)(const BoundTree& first, const BoundTree& second, const RelativePose& pose,
                         FunctionRef<bool(const FacePair&)> visitor, PairBound& bound);
};

/// The walk that answers a type of query, for queries that have such walks.
template <class Query>
inline constexpr std::nullptr_t kWalkOf = nullptr;
template <>
inline constexpr auto kWalkOf<RayQuery> = &CodecWalks::ray;
template <>
inline constexpr auto kWalkOf<PointQuery> = &CodecWalks::point;
template <>
inline constexpr auto kWalkOf<FaceWalk<BoxQuery>> = &CodecWalks::box;
template <>
inline constexpr auto kWalkOf<FaceWalk<SphereQuery>> = &CodecWalks::sphere;
template <class Query>
inline constexpr bool kHasCodecWalks =
    !std::is_same_v<decltype(kWalkOf<Query>), const std::nullptr_t>;

}  // namespace boxtree
