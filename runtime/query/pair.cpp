// SPDX-License-Identifier: MIT
// Pair queries: one instance of the walk for each codec, and one for pairs of different codecs.
#include <variant>

#include "runtime/query/float_state.h"
#include "runtime/query/pair_query.h"
#include "runtime/query/pair_walk.h"
#include "runtime/query/pair_walks.h"
#include "runtime/walk/erased_codec.h"

namespace boxtree {

Result<Visit> visit_pairs(const Tree& first, const Pose& first_pose, const Tree& second,
                          const Pose& second_pose, PairVisitor visitor, QueryWork& work) {
  const std::optional<RelativePose> pose =
      RelativePose::make(first, first_pose, second, second_pose);
  if (!pose) return Errc::kInvalidPose;
  PairBound bound(first, second, &work);
  // Not by their records: a tree without nodes has none of any codec.
  if (first.codec_view().index() != second.codec_view().index()) {
    return PairWalk(first, ErasedCodec{&first}, second, ErasedCodec{&second}, *pose, visitor, bound)
        .run();
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
  return visit_pairs(first, first_pose, second, second_pose, visitor, work);
}

Result<std::optional<FacePair>> first_contact(const Tree& first, const Pose& first_pose,
                                              const Tree& second, const Pose& second_pose,
                                              const QueryLimits& limits) {
  std::optional<FacePair> contact;
  const auto keep = [&](const FacePair& pair) {
    contact = pair;
    return false;
  };
  const Result<Visit> visit = overlap_pairs(first, first_pose, second, second_pose, keep, limits);
  if (!visit) return visit.error();
  return contact;
}

}  // namespace boxtree
