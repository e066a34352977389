// SPDX-License-Identifier: MIT
// Pair queries over the wide codecs: one box against eight.
#include "runtime/query/pair_filter.h"
#include "runtime/query/pair_walk.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/targets.h"
#include "runtime/walk/walk_tree.h"

#ifndef HWY_TARGET_INCLUDE  // compiled alone
#define HWY_TARGET_INCLUDE "runtime/query/pair_wide.cpp"
#endif
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include "runtime/query/leaf_pair-inl.h"
#include "runtime/walk/decode-inl.h"
#include "runtime/walk/traversal_stack-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
Result<Visit> walk_pair(const BoundTree& first, const BoundTree& second, const RelativePose& pose,
                        const PairFilter& /*filter*/, PairVisitor visitor, PairBound& bound) {
  return PairWalk(first, ErasedCodec{&first}, second, ErasedCodec{&second}, pose, visitor, bound)
      .run();
}
#else
// Vectors of three axes; what the fourth lane holds means nothing. Written and read as a whole, so
// that no read waits for several writes.
using Axes = hn::CappedTag<float, 4>;
inline constexpr std::size_t kAxisLanes = hn::MaxLanes(Axes());

struct Centered {
  alignas(16) float center[4];
  alignas(16) float half[4];

  [[nodiscard]] float extent() const { return half[0] + half[1] + half[2]; }
};

// A node or leaf of one tree.
struct PairPart {
  alignas(16) float low[4];
  alignas(16) float high[4];
  Centered centered;     // the same box
  std::uint32_t number;  // of the node, or of the leaf's first face
  bool is_leaf;

  [[nodiscard]] Box<float> box() const {
    return {{low[0], low[1], low[2]}, {high[0], high[1], high[2]}};
  }
};

// Element `i` of the arrays of each axis.
HWY_INLINE void gather(const float (&axes)[3][kWideChildren], std::uint32_t i, float* out) {
  const Axes d;
  const auto xy = hn::OddEven(hn::Set(d, axes[1][i]), hn::Set(d, axes[0][i]));
  hn::Store(hn::ConcatUpperLower(d, hn::Set(d, axes[2][i]), xy), d, out);
}

HWY_INLINE void set_box(const ChildBoxes& boxes, std::uint32_t i, PairPart& part) {
  gather(boxes.low, i, part.low);
  gather(boxes.high, i, part.high);
  const Axes d;
  for (std::size_t k = 0; k < 4; k += kAxisLanes) {
    const auto low = hn::Load(d, part.low + k), high = hn::Load(d, part.high + k);
    const auto one_half = hn::Set(d, 0.5f);
    hn::Store(hn::Mul(hn::Add(low, high), one_half), d, part.centered.center + k);
    hn::Store(hn::Mul(hn::Sub(high, low), one_half), d, part.centered.half + k);
  }
}

// The image of a box, widened by the error of the map.
HWY_INLINE void set_image(const Centered& box, const FloatMap& map, Centered& image) {
  const Axes d;
  for (std::size_t k = 0; k < 4; k += kAxisLanes) {
    auto center = hn::LoadU(d, map.translation.data() + k);
    auto half = hn::LoadU(d, map.error.data() + k);
    for (std::size_t j = 0; j < 3; ++j) {
      center =
          hn::MulAdd(hn::LoadU(d, map.linear[j].data() + k), hn::Set(d, box.center[j]), center);
      half = hn::MulAdd(hn::LoadU(d, map.absolute[j].data() + k), hn::Set(d, box.half[j]), half);
    }
    hn::Store(center, d, image.center + k);
    hn::Store(half, d, image.half + k);
  }
}

// The children of a node of one tree, and the part of the other tree that they are compared with.
struct PairChildren {
  ChildBoxes boxes;
  WideLinks links;
  std::uint32_t side;  // 0: children of the first tree
  const PairPart* other;
  const Centered* other_image;  // in the children's space
  // The current child, and its image in the other part's space; deeper levels refer to them.
  PairPart child;
  Centered child_image;
};

template <class Node>
class WidePairWalk {
 public:
  WidePairWalk(const BoundTree& first, const WideCodec<Node>& first_codec, const BoundTree& second,
               const WideCodec<Node>& second_codec, const RelativePose& pose,
               const PairFilter& filter, PairVisitor visitor, PairBound& bound)
      : codec_{&first_codec, &second_codec},
        filter_(filter),
        map_{&filter_.to_second, &filter_.to_first},
        leaves_(first, second, pose, filter_, visitor),
        bound_(bound) {}

  // The pairs of a path are in open_, each with its siblings. The roots come first, the first one
  // as if it were a child.
  Result<Visit> run(const Box<float>& first_root, const Box<float>& second_root) {
    ChildBoxes second_boxes;
    PairChildren& roots = open_[0];
    for (std::size_t k = 0; k < 3; ++k) {
      roots.boxes.low[k][0] = first_root.low[k];
      roots.boxes.high[k][0] = first_root.high[k];
      second_boxes.low[k][0] = second_root.low[k];
      second_boxes.high[k][0] = second_root.high[k];
    }
    set_box(second_boxes, 0, second_root_);
    second_root_.number = 0;
    second_root_.is_leaf = false;
    set_image(second_root_.centered, filter_.to_first, second_root_image_);
    roots.links = {0, 0, 1, 1};
    roots.side = 0;
    roots.other = &second_root_;
    roots.other_image = &second_root_image_;
    Position at{0, 0};
    while (intersect(at) && stack_.pop(std::numeric_limits<float>::infinity(), at)) {
    }
    if (error_ != Errc::kOk) return error_;
    if (leaves_.error() != Errc::kOk) return leaves_.error();
    return leaves_.stopped() ? Visit::kStopped : Visit::kComplete;
  }

 private:
  static constexpr std::size_t kDepths = 2 * WideCodec<Node>::kDepthLimit + 1;
  using Position = typename TraversalStack<kDepths>::Child;

  // Expands a pair whose boxes may overlap, not both of them leaves. False to end the walk.
  HWY_INLINE bool intersect(const Position& at) {
    PairChildren& from = open_[at.depth];
    PairPart& child = from.child;
    set_box(from.boxes, at.number, child);
    child.is_leaf = ((from.links.inner_mask >> at.number) & 1u) == 0;
    child.number =
        child.is_leaf ? first_face(from.links, at.number) : node_number(from.links, at.number);
    if (at.depth + 1 == kDepths) return fail(Errc::kDepthExceeded);
    set_image(child.centered, *map_[from.side], from.child_image);
    return from.side == 0 ? choose<0>(from, at.depth + 1) : choose<1>(from, at.depth + 1);
  }

  // The larger box is expanded, a leaf never. A pair is visited once: only one of the pairs (parent
  // of a, b) and (a, parent of b) arises, the one that their common parent pair chose. Branches,
  // not selections, although they are hard to predict: with selections the node would be known, and
  // read, only after all of the above, which costs more.
  template <std::uint32_t kSide>
  HWY_INLINE bool choose(const PairChildren& from, std::size_t depth) {
    const PairPart& first = kSide == 0 ? from.child : *from.other;
    const PairPart& second = kSide == 0 ? *from.other : from.child;
    const Centered& first_image = kSide == 0 ? from.child_image : *from.other_image;
    const Centered& second_image = kSide == 0 ? *from.other_image : from.child_image;
    PairChildren& to = open_[depth];
    if (!first.is_leaf && (second.is_leaf || first.centered.extent() > second_image.extent())) {
      to.side = 0;
      to.other = &second;
      to.other_image = &second_image;
      return expand(first, to, depth);
    }
    to.side = 1;
    to.other = &first;
    to.other_image = &first_image;
    return expand(second, to, depth);
  }

  // Called from four places of choose() and compiled once.
  HWY_NOINLINE bool expand(const PairPart& parent, PairChildren& to, std::size_t depth) {
    const WideCodec<Node>& codec = *codec_[to.side];
    const NodeView<Node> node(codec, parent.number);
    to.links = node.links();
    const Errc error = bound_.count(check_links(codec, parent.number, to.links));
    if (error != Errc::kOk) return fail(error);
    std::uint32_t near = 0;
    HWY_ALIGN float key[kWideChildren];
    for (std::size_t part = 0; part < kParts; ++part) {
      near |= overlap(decode(node, parent, part, to.boxes), *map_[to.side], *to.other_image,
                      to.other->centered, key + part * kLanes)
              << (part * kLanes);
    }
    near &= (1u << to.links.child_count) - 1;
    if (!to.other->is_leaf) {
      stack_.push(near, key, depth);
      return true;
    }
    // Pairs of leaves are compared at once.
    stack_.push(near & to.links.inner_mask, key, depth);
    return for_each_bit(near & ~to.links.inner_mask, [&](std::uint32_t i) {
      const NodeRef child = leaf_of(first_face(to.links, i), codec);
      const NodeRef other = leaf_of(to.other->number, *codec_[1 - to.side]);
      const Errc compared =
          to.side == 0 ? bound_.compare(child, other) : bound_.compare(other, child);
      if (compared != Errc::kOk) return fail(compared);
      return to.side == 0 ? leaves_.visit(child, to.boxes.box(i), other)
                          : leaves_.visit(other, to.other->box(), child);
    });
  }

  // Bit i: box i overlaps the image of the other box, and its own image overlaps the other box.
  // Keys are smaller the deeper the two overlap, because a contact is found early there.
  static HWY_INLINE std::uint32_t overlap(const VectorBox& box, const FloatMap& map,
                                          const Centered& image, const Centered& other,
                                          float* key) {
    const Floats d;
    const FloatVector half_one = hn::Set(d, 0.5f);
    FloatVector center[3], half[3];
    FloatVector outside = hn::Set(d, -std::numeric_limits<float>::infinity());
    for (std::size_t k = 0; k < 3; ++k) {
      center[k] = hn::Mul(hn::Add(box.low[k], box.high[k]), half_one);
      half[k] = hn::Mul(hn::Sub(box.high[k], box.low[k]), half_one);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const FloatVector between = hn::Sub(center[k], hn::Set(d, image.center[k]));
      outside =
          hn::Max(outside, hn::Sub(hn::Abs(between), hn::Add(half[k], hn::Set(d, image.half[k]))));
      FloatVector image_center = hn::Set(d, map.translation[k] - other.center[k]);
      FloatVector image_half = hn::Set(d, map.error[k] + other.half[k]);
      for (std::size_t j = 0; j < 3; ++j) {
        image_center = hn::MulAdd(hn::Set(d, map.linear[j][k]), center[j], image_center);
        image_half = hn::MulAdd(hn::Set(d, map.absolute[j][k]), half[j], image_half);
      }
      outside = hn::Max(outside, hn::Sub(hn::Abs(image_center), image_half));
    }
    hn::Store(hn::Max(hn::Zero(d), hn::Add(outside, hn::Set(d, 2 * other.extent()))), d, key);
    return bits_of(hn::Le(outside, hn::Zero(d)));
  }

  static NodeRef leaf_of(std::uint32_t first, const WideCodec<Node>& codec) {
    return {first, std::min(kLeafFaces, codec.face_count - first)};
  }

  bool fail(Errc error) {
    error_ = error;
    return false;
  }

  const WideCodec<Node>* codec_[2];
  const PairFilter& filter_;
  const FloatMap* map_[2];  // from each tree's space to the other's
  LeafPairs leaves_;
  PairBound& bound_;
  Errc error_ = Errc::kOk;
  TraversalStack<kDepths> stack_;
  PairPart second_root_;  // what the first one in open_ is compared with
  Centered second_root_image_;
  PairChildren open_[kDepths];
};

template <class Node>
Result<Visit> walk_pair_nodes(const BoundTree& first, const WideCodec<Node>& first_codec,
                              const BoundTree& second, const WideCodec<Node>& second_codec,
                              const RelativePose& pose, const PairFilter& filter,
                              PairVisitor visitor, PairBound& bound) {
  return WidePairWalk<Node>(first, first_codec, second, second_codec, pose, filter, visitor, bound)
      .run(root_box<float>(first), root_box<float>(second));
}
Result<Visit> walk_pair(const BoundTree& first, const BoundTree& second, const RelativePose& pose,
                        const PairFilter& filter, PairVisitor visitor, PairBound& bound) {
  return with_wide_codec<Result<Visit>>(first, [&]<class C>(const C& codec) {
    return walk_pair_nodes(first, codec, second, second.nodes().as<C>(), pose, filter, visitor,
                           bound);
  });
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "runtime/walk/dispatch.h"

namespace boxtree {
namespace {

BOXTREE_EXPORT(walk_pair);

}  // namespace

Result<Visit> walk_wide_pairs(const BoundTree& first, const BoundTree& second,
                              const RelativePose& pose, PairVisitor visitor, PairBound& bound) {
  if (first.has_float_nodes() && second.has_float_nodes()) {
    const PairFilter filter(first, second, pose);
    if (filter.is_in_range()) {
      return BOXTREE_DISPATCH(walk_pair)(first, second, pose, filter, visitor, bound);
    }
  }
  return PairWalk(first, ErasedCodec{&first}, second, ErasedCodec{&second}, pose, visitor, bound)
      .run();
}

}  // namespace boxtree
#endif
