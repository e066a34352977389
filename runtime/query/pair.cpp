// SPDX-License-Identifier: MIT
// Pair queries: walks for two trees of one codec, and one for pairs of different codecs.
#include "runtime/primitive/float_state.h"
#include "runtime/query/pair_query.h"
#include "runtime/query/pair_walk.h"
#include "runtime/walk/walk_tree.h"

namespace boxtree {
namespace {

// Trees of different codecs, or of none. A separate function, because its stack of boxes in double
// is the largest of all walks.
[[gnu::noinline]] Result<Visit> walk_erased(const BoundTree& first, const BoundTree& second,
                                            const RelativePose& pose, PairVisitor visitor,
                                            PairBound& bound) {
  return PairWalk(first, ErasedCodec{&first}, second, ErasedCodec{&second}, pose, visitor, bound)
      .run();
}

Result<Visit> walk_wide_nodes(const BoundTree& first, const BoundTree& second,
                              const RelativePose& pose, PairVisitor visitor, PairBound& bound) {
  if constexpr (kWalksTreesByVectors) {
    return walk_wide_pairs(first, second, pose, visitor, bound);
  } else {
    return with_wide_codec<Result<Visit>>(first, [&]<class C>(const C& codec) {
      return PairWalk(first, codec, second, second.nodes().as<C>(), pose, visitor, bound).run();
    });
  }
}

}  // namespace

Result<Visit> visit_pairs(const BoundTree& first, const Pose& first_pose, const BoundTree& second,
                          const Pose& second_pose, PairVisitor visitor, QueryWork& work) {
  const std::optional<RelativePose> pose =
      RelativePose::make(first, first_pose, second, second_pose);
  if (!pose) return Errc::kInvalidPose;
  PairBound bound(first, second, &work);
  // Compares bound codecs, not records: a tree without nodes has no codec.
  const CodecFunctions& codec = first.codec_functions();
  if (codec.id == second.codec_functions().id) {
    if (has_wide_nodes(first)) return walk_wide_nodes(first, second, *pose, visitor, bound);
    if (codec.walks != nullptr) return codec.walks->pairs(first, second, *pose, visitor, bound);
  }
  return walk_erased(first, second, *pose, visitor, bound);
}

Result<Visit> overlap_pairs(const Tree& first, const Pose& first_pose, const Tree& second,
                            const Pose& second_pose, PairVisitor visitor,
                            const QueryLimits& limits) {
  const DefaultFloatState state;
  QueryWork work(limits);
  return visit_pairs(BoundTree::of(first), first_pose, BoundTree::of(second), second_pose, visitor,
                     work);
}

QueryResult<FacePair> first_contact(const Tree& first, const Pose& first_pose, const Tree& second,
                                    const Pose& second_pose, const QueryLimits& limits) {
  QueryResult<FacePair> contact;
  const auto keep = [&](const FacePair& pair) {
    contact = pair;
    return false;
  };
  const Result<Visit> visit = overlap_pairs(first, first_pose, second, second_pose, keep, limits);
  return visit ? contact : visit.code();
}

}  // namespace boxtree
