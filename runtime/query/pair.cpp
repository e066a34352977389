// SPDX-License-Identifier: MIT
// Pair queries: one instance of the walk for each codec, and one for pairs of different codecs.
#include <variant>

#include <boxtree/runtime/query/float_state.h>
#include <boxtree/runtime/query/pair.h>
#include <boxtree/runtime/query/pair_walk.h>
#include <boxtree/runtime/wide/pair_walks.h>

namespace boxtree {
namespace {

// Any codec, found out at every node: for trees in different codecs, so that the number of
// instantiations grows with the codecs and not with their square.
struct ErasedCodec {
  using Scalar = double;
  using Children = ChildSet<kWideChildren, double>;
  static constexpr std::uint32_t kDepthLimit = kMaxDepth;

  const Tree* tree;

  static Result<ErasedCodec> bind(const TreeRecord&, Bytes) { return Errc::kInternal; }
  [[nodiscard]] NodeRef root(const TreeRecord&) const noexcept { return tree->root_ref(); }

  // Boxes of f32 codecs come and go through double unchanged.
  [[nodiscard]] bool expand(NodeRef ref, const Box<double>& box, Children& out) const noexcept {
    NodeChildren children;
    if (tree->expand({box, ref, false}, children) != Errc::kOk) return false;
    out.clear();
    for (std::uint32_t i = 0; i < children.count; ++i) {
      const Node& child = children.child[i];
      out.add(child.box, child.ref, child.is_leaf);
    }
    return true;
  }
};

}  // namespace

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
