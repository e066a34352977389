// SPDX-License-Identifier: MIT
// Pair queries: one instance of the walk for each codec, and one for pairs of different codecs.
#include <variant>

#include "runtime/primitive/float_state.h"
#include "runtime/query/pair_query.h"
#include "runtime/query/pair_walk.h"
#include "runtime/query/pair_walks.h"
#include "runtime/walk/erased_codec.h"

namespace boxtree {
namespace {

// Trees of different codecs. A function of its own, because its stack of boxes in double is the
// largest of all walks.
[[gnu::noinline]] Result<Visit> walk_erased(const BoundTree& first, const BoundTree& second,
                                            const RelativePose& pose, PairVisitor visitor,
                                            PairBound& bound) {
  return PairWalk(first, ErasedCodec{&first}, second, ErasedCodec{&second}, pose, visitor, bound)
      .run();
}

}  // namespace

Result<Visit> visit_pairs(const BoundTree& first, const Pose& first_pose, const BoundTree& second,
                          const Pose& second_pose, PairVisitor visitor, QueryWork& work) {
  const std::optional<RelativePose> pose =
      RelativePose::make(first, first_pose, second, second_pose);
  if (!pose) return Errc::kInvalidPose;
  PairBound bound(first, second, &work);
  // Not by their records: a tree without nodes has none of any codec.
  if (first.codec_view().index() != second.codec_view().index()) {
    return walk_erased(first, second, *pose, visitor, bound);
  }
  return with_codec(first, [&]<class C>(const C& codec) {
    return walk_pairs(first, codec, second, std::get<C>(second.codec_view()), *pose, visitor,
                      bound);
  });
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
