// SPDX-License-Identifier: MIT
// The walks of the wide codecs without vectors: those of every codec. Built in place of the others
// with BOXTREE_SIMD=OFF; the reference that they are held to.
#include <boxtree/runtime/wide/pair_walks.h>
#include <boxtree/runtime/wide/walks.h>

namespace boxtree {

using Wide8 = WideCodec<Wide8Node>;
using Wide4 = WideCodec<Wide4Node>;

Errc walk_nearest(const Tree& tree, const Wide8& codec, RayQuery& query) {
  return traverse_nearest(tree, codec, query);
}
Errc walk_nearest(const Tree& tree, const Wide4& codec, RayQuery& query) {
  return traverse_nearest(tree, codec, query);
}
Errc walk_nearest(const Tree& tree, const Wide8& codec, PointQuery& query) {
  return traverse_nearest(tree, codec, query);
}
Errc walk_nearest(const Tree& tree, const Wide4& codec, PointQuery& query) {
  return traverse_nearest(tree, codec, query);
}
Errc walk_overlap(const Tree& tree, const Wide8& codec, FaceWalk<BoxQuery>& walk) {
  return traverse_overlap(tree, codec, walk);
}
Errc walk_overlap(const Tree& tree, const Wide4& codec, FaceWalk<BoxQuery>& walk) {
  return traverse_overlap(tree, codec, walk);
}
Errc walk_overlap(const Tree& tree, const Wide8& codec, FaceWalk<SphereQuery>& walk) {
  return traverse_overlap(tree, codec, walk);
}
Errc walk_overlap(const Tree& tree, const Wide4& codec, FaceWalk<SphereQuery>& walk) {
  return traverse_overlap(tree, codec, walk);
}
Result<Visit> walk_pairs(const Tree& first, const Wide8& first_codec, const Tree& second,
                         const Wide8& second_codec, const RelativePose& pose, PairVisitor visitor) {
  return PairWalk(first, first_codec, second, second_codec, pose, visitor).run();
}
Result<Visit> walk_pairs(const Tree& first, const Wide4& first_codec, const Tree& second,
                         const Wide4& second_codec, const RelativePose& pose, PairVisitor visitor) {
  return PairWalk(first, first_codec, second, second_codec, pose, visitor).run();
}

}  // namespace boxtree
