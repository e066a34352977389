// SPDX-License-Identifier: MIT
// How two trees of one codec are walked together: see walks.h.
#pragma once

#include <boxtree/format/codec_wide.h>
#include <boxtree/runtime/query/pair_walk.h>

namespace boxtree {

/// Visits the pairs of faces that touch. Errors: those of corrupt nodes and leaves.
template <Codec C>
Result<Visit> walk_pairs(const Tree& first, const C& first_codec, const Tree& second,
                         const C& second_codec, const RelativePose& pose, PairVisitor visitor) {
  return PairWalk(first, first_codec, second, second_codec, pose, visitor).run();
}
Result<Visit> walk_pairs(const Tree& first, const WideCodec<Wide8Node>& first_codec,
                         const Tree& second, const WideCodec<Wide8Node>& second_codec,
                         const RelativePose& pose, PairVisitor visitor);
Result<Visit> walk_pairs(const Tree& first, const WideCodec<Wide4Node>& first_codec,
                         const Tree& second, const WideCodec<Wide4Node>& second_codec,
                         const RelativePose& pose, PairVisitor visitor);

}  // namespace boxtree
