// SPDX-License-Identifier: MIT
// Pair queries: one instance of the walk for each codec, and one for pairs of different codecs.
#include <variant>

#include <boxtree/runtime/query/erased_codec.h>
#include <boxtree/runtime/query/float_state.h>
#include <boxtree/runtime/query/pair.h>
#include <boxtree/runtime/query/pair_walk.h>
#include <boxtree/runtime/wide/pair_walks.h>

namespace boxtree {

Result<Visit> overlap_pairs(const Tree& first, const Pose& first_pose, const Tree& second,
                            const Pose& second_pose, PairVisitor visitor) {
  const DefaultFloatState state;
  const std::optional<RelativePose> pose =
      RelativePose::make(first, first_pose, second, second_pose);
  if (!pose) return Errc::kInvalidPose;
  // Not by their records: a tree without nodes has none of any codec.
  if (first.codec_view().index() != second.codec_view().index()) {
    return PairWalk(first, ErasedCodec{&first}, second, ErasedCodec{&second}, *pose, visitor).run();
  }
  return with_codec(first, [&]<class C>(const C& codec) {
    return walk_pairs(first, codec, second, std::get<C>(second.codec_view()), *pose, visitor);
  });
}

Result<std::optional<FacePair>> first_contact(const Tree& first, const Pose& first_pose,
                                              const Tree& second, const Pose& second_pose) {
  std::optional<FacePair> contact;
  const Result<Visit> visit =
      overlap_pairs(first, first_pose, second, second_pose, [&](const FacePair& pair) {
        contact = pair;
        return false;
      });
  if (!visit) return visit.error();
  return contact;
}

}  // namespace boxtree
