// SPDX-License-Identifier: MIT
// Simultaneous descent of two trees (Zachmann, "The BoxTree", 1995; paper section 1.1), over any
// pair of codecs.
#include <variant>

#include <boxtree/runtime/primitive/predicates.h>
#include <boxtree/runtime/query/pair.h>
#include <boxtree/runtime/query/relative_pose.h>
#include <boxtree/runtime/query/traversal.h>

namespace boxtree {
namespace {

// The children of one side of a pair: those of a node, or a leaf standing for itself.
template <Codec C>
struct Side {
  typename C::Children children;
  std::array<Box<double>, C::Children::kWidth> image;  // in the other tree's space

  void set_leaf(const Box<typename C::Scalar>& box, NodeRef ref) noexcept {
    children.count = 1;
    children.leaf_mask = 1;
    children.ref[0] = ref;
    for (std::size_t k = 0; k < 3; ++k) {
      children.low[k][0] = box.low[k];
      children.high[k][0] = box.high[k];
    }
  }
};

// Any codec, found out at every node: for trees in different codecs, so that the number of
// instantiations grows with the codecs and not with their square.
struct ErasedCodec {
  using Scalar = double;
  using Children = ChildSet<2, double>;

  const Tree* tree;

  static Result<ErasedCodec> bind(const TreeRecord&, Bytes) { return Errc::kInternal; }
  [[nodiscard]] NodeRef root(const TreeRecord&) const noexcept { return tree->root_ref(); }

  // Boxes of f32 codecs come and go through double unchanged.
  [[nodiscard]] bool expand(NodeRef ref, const Box<double>& box, Children& out) const noexcept {
    NodeChildren children;
    if (tree->expand({box, ref, false}, children) != Errc::kOk) return false;
    out.count = 0;
    out.leaf_mask = 0;
    for (std::uint32_t i = 0; i < children.count; ++i) {
      add_binary_child(children.child[i].box, children.child[i].ref, children.child[i].is_leaf,
                       out);
    }
    return true;
  }
};

// As many pairs as an honest walk can meet: each node or leaf of one tree with each of the other,
// once. A walk of corrupt bytes that would meet more ends with kNodeCorrupt.
std::uint64_t most_pairs(const TreeRecord& first, const TreeRecord& second) noexcept {
  const auto size = [](const TreeRecord& r) { return std::uint64_t{r.node_count} + r.face_count; };
  const std::uint64_t a = size(first);
  const std::uint64_t b = size(second);
  return a != 0 && b > ~std::uint64_t{0} / a ? ~std::uint64_t{0} : a * b;
}

template <Codec A, Codec B>
class PairWalk {
 public:
  PairWalk(const Tree& first, const A& first_codec, const Tree& second, const B& second_codec,
           const RelativePose& pose, PairVisitor visitor) noexcept
      : first_(first),
        second_(second),
        first_codec_(first_codec),
        second_codec_(second_codec),
        pose_(pose),
        visitor_(visitor),
        unmet_(most_pairs(first.record(), second.record())) {}

  [[nodiscard]] Result<Visit> run() {
    if (first_.empty() || second_.empty()) return Visit::kComplete;
    const Entry root{root_box<typename A::Scalar>(first_),
                     root_box<typename B::Scalar>(second_),
                     first_.root_ref(),
                     second_.root_ref(),
                     first_.record().root == RootKind::kLeaf,
                     second_.record().root == RootKind::kLeaf};
    const bool apart = !boxes_overlap(root.first_box, pose_.hull_in_first(root.second_box)) ||
                       !boxes_overlap(pose_.hull_in_second(root.first_box), root.second_box);
    if (!apart && (root.first_leaf && root.second_leaf)) {
      test_leaves(root.first, root.second);
    } else if (!apart) {
      stack_[size_++] = root;
    }
    while (size_ > 0 && error_ == Errc::kOk && !stopped_) descend(stack_[--size_]);
    if (error_ != Errc::kOk) return error_;
    return stopped_ ? Visit::kStopped : Visit::kComplete;
  }

 private:
  struct Entry {
    Box<typename A::Scalar> first_box;
    Box<typename B::Scalar> second_box;
    NodeRef first;
    NodeRef second;
    bool first_leaf;
    bool second_leaf;
  };

  // Both sides go down at once; a path ends after as many steps as the deeper tree has levels, and
  // each step leaves all but one of its child pairs pending.
  static constexpr std::size_t kPairs = A::Children::kWidth * B::Children::kWidth;
  static constexpr std::size_t kPairStack = kMaxDepth * (kPairs - 1) + 1;

  void descend(const Entry entry) {
    if (unmet_-- == 0 ||
        !expand(first_codec_, entry.first_leaf, entry.first_box, entry.first, first_side_) ||
        !expand(second_codec_, entry.second_leaf, entry.second_box, entry.second, second_side_)) {
      error_ = Errc::kNodeCorrupt;
      return;
    }
    const auto& a = first_side_.children;
    const auto& b = second_side_.children;
    for (std::uint32_t i = 0; i < a.count; ++i) {
      first_side_.image[i] = pose_.hull_in_second(a.box(i));
    }
    for (std::uint32_t j = 0; j < b.count; ++j) {
      second_side_.image[j] = pose_.hull_in_first(b.box(j));
    }
    for (std::uint32_t i = 0; i < a.count; ++i) {
      for (std::uint32_t j = 0; j < b.count; ++j) {
        if (!boxes_overlap(a.box(i), second_side_.image[j]) ||
            !boxes_overlap(first_side_.image[i], b.box(j))) {
          continue;
        }
        if (a.is_leaf(i) && b.is_leaf(j)) {
          test_leaves(a.ref[i], b.ref[j]);
          if (error_ != Errc::kOk || stopped_) return;
          continue;
        }
        if (size_ == stack_.size()) {
          error_ = Errc::kDepthExceeded;
          return;
        }
        stack_[size_++] = {a.box(i), b.box(j), a.ref[i], b.ref[j], a.is_leaf(i), b.is_leaf(j)};
      }
    }
  }

  template <Codec C>
  [[nodiscard]] static bool expand(const C& codec, bool leaf, const Box<typename C::Scalar>& box,
                                   NodeRef ref, Side<C>& side) noexcept {
    if (!leaf) return codec.expand(ref, box, side.children);
    side.set_leaf(box, ref);
    return true;
  }

  void test_leaves(NodeRef first, NodeRef second) {
    error_ = first_.leaves().read(first.first, first.second, first_batch_);
    if (error_ != Errc::kOk) return;
    error_ = second_.leaves().read(second.first, second.second, second_batch_);
    if (error_ != Errc::kOk) return;
    std::array<Triangle, kMaxLeafTriangles> moved;
    for (std::uint32_t j = 0; j < second_batch_.count; ++j) {
      const Triangle triangle = second_batch_.triangle(j);
      for (std::size_t c = 0; c < 3; ++c) {
        moved[j].corner[c] = pose_.to_first().apply(triangle.corner[c]);
        if (is_within_reach(moved[j].corner[c])) continue;
        error_ = Errc::kVertexNotFinite;  // outside the root box that the pose was checked with
        return;
      }
    }
    for (std::uint32_t i = 0; i < first_batch_.count; ++i) {
      const Triangle triangle = first_batch_.triangle(i);
      for (std::uint32_t j = 0; j < second_batch_.count; ++j) {
        if (was_reported(i, j) || !triangles_intersect(triangle, moved[j])) continue;
        reported_ = {first_batch_.face[i], second_batch_.face[j]};
        stopped_ =
            !visitor_({face_ref(first_, reported_.first), face_ref(second_, reported_.second)});
        if (stopped_) return;
      }
    }
    reported_ = kNone;
  }

  // Quads bring up to four triangle pairs of the same two faces, one after the other only when both
  // leaves hold one face; leaves of binary codecs do.
  [[nodiscard]] bool was_reported(std::uint32_t i, std::uint32_t j) const noexcept {
    return reported_.first == first_batch_.face[i] && reported_.second == second_batch_.face[j];
  }

  static constexpr NodeRef kNone{0xffffffffu, 0xffffffffu};

  const Tree& first_;
  const Tree& second_;
  const A first_codec_;
  const B second_codec_;
  const RelativePose& pose_;
  PairVisitor visitor_;
  std::uint64_t unmet_;
  Errc error_ = Errc::kOk;
  bool stopped_ = false;
  NodeRef reported_ = kNone;  // the two faces reported last
  Side<A> first_side_;
  Side<B> second_side_;
  TriangleBatch first_batch_;
  TriangleBatch second_batch_;
  std::array<Entry, kPairStack> stack_;
  std::size_t size_ = 0;
};

}  // namespace

Result<Visit> overlap_pairs(const Tree& first, const Pose& first_pose, const Tree& second,
                            const Pose& second_pose, PairVisitor visitor) {
  const std::optional<RelativePose> pose =
      RelativePose::make(first, first_pose, second, second_pose);
  if (!pose) return Errc::kInvalidPose;
  if (first.codec() != second.codec()) {
    return PairWalk(first, ErasedCodec{&first}, second, ErasedCodec{&second}, *pose, visitor).run();
  }
  return with_codec(first, [&]<class C>(const C& codec) {
    return PairWalk(first, codec, second, std::get<C>(second.codec_view()), *pose, visitor).run();
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
