// SPDX-License-Identifier: MIT
// Two trees of the wide codecs: one box against eight.
#include <boxtree/runtime/wide/pair_filter.h>
#include <boxtree/runtime/wide/pair_walks.h>
#include <boxtree/runtime/wide/targets.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "boxtree/runtime/wide/pair.cpp"
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include <boxtree/runtime/wide/decode-inl.h>
#include <boxtree/runtime/wide/leaf_pair-inl.h>

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

// A node or leaf of one tree with its decoded box.
struct PairPart {
  Box<float> box;
  std::uint32_t number;  // of the node, or of the leaf's first face
  bool is_leaf;
};

struct PairEntry {
  PairPart first;
  PairPart second;
};

struct Centered {
  std::array<float, 3> center;
  std::array<float, 3> half;
};

HWY_INLINE Centered centered(const Box<float>& box) {
  Centered result;
  for (std::size_t k = 0; k < 3; ++k) {
    result.center[k] = (box.low[k] + box.high[k]) * 0.5f;
    result.half[k] = (box.high[k] - box.low[k]) * 0.5f;
  }
  return result;
}

// The image of a box, widened by the error of the map.
HWY_INLINE Centered image_of(const Centered& box, const FloatMap& map) {
  Centered image;
  for (std::size_t k = 0; k < 3; ++k) {
    image.center[k] = map.translation[k];
    image.half[k] = map.error[k];
    for (std::size_t j = 0; j < 3; ++j) {
      image.center[k] += map.linear[k][j] * box.center[j];
      image.half[k] += map.absolute[k][j] * box.half[j];
    }
  }
  return image;
}

template <class Node>
class WidePairWalk {
 public:
  WidePairWalk(const Tree& first, const WideCodec<Node>& first_codec, const Tree& second,
               const WideCodec<Node>& second_codec, const RelativePose& pose, PairVisitor visitor)
      : first_codec_(first_codec),
        second_codec_(second_codec),
        filter_(first, second, pose),
        leaves_(first, second, pose, filter_, visitor),
        unmet_(most_pairs(first.record(), second.record())) {}

  Result<Visit> run(const Box<float>& first_root, const Box<float>& second_root) {
    stack_[size_++] = {{first_root, 0, false}, {second_root, 0, false}};
    while (size_ > 0) {
      const PairEntry entry = stack_[--size_];
      if (unmet_-- == 0) return Errc::kNodeCorrupt;
      const Centered first = centered(entry.first.box), second = centered(entry.second.box);
      const Centered second_image = image_of(second, filter_.to_first);
      // The larger box is taken apart, a leaf never. A pair is met once: only one of the pairs
      // (parent of a, b) and (a, parent of b) arises, by what their common parent pair chose.
      const bool take_first =
          !entry.first.is_leaf && (entry.second.is_leaf || extent(first) > extent(second_image));
      const bool go_on = take_first
                             ? take_apart<true>(entry, second_image, second)
                             : take_apart<false>(entry, image_of(first, filter_.to_second), first);
      if (!go_on) break;
    }
    if (error_ != Errc::kOk) return error_;
    if (leaves_.error() != Errc::kOk) return leaves_.error();
    return leaves_.stopped() ? Visit::kStopped : Visit::kComplete;
  }

 private:
  static float extent(const Centered& box) { return box.half[0] + box.half[1] + box.half[2]; }

  // Compares the children of one side with the other side: `image` is the other's box in this
  // side's space, `other` in its own.
  template <bool kFirst>
  HWY_INLINE bool take_apart(const PairEntry& entry, const Centered& image, const Centered& other) {
    const WideCodec<Node>& codec = kFirst ? first_codec_ : second_codec_;
    const PairPart& parent = kFirst ? entry.first : entry.second;
    const Node* node = reinterpret_cast<const Node*>(codec.nodes) + parent.number;
    const WideLinks links = links_of(*node);
    if (!is_sound(codec, parent.number, links)) {
      error_ = Errc::kNodeCorrupt;
      return false;
    }
    const FloatMap& map = kFirst ? filter_.to_second : filter_.to_first;
    ChildBoxes children;
    std::uint32_t near = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
      near |= overlap(decode(*node, parent.box, part, children), map, image, other)
              << (part * kLanes);
    }
    return for_each_bit(near & ((1u << links.child_count) - 1), [&](std::uint32_t i) {
      const bool is_leaf = ((links.inner_mask >> i) & 1u) == 0;
      const PairPart child{children.box(i), is_leaf ? first_face(links, i) : node_number(links, i),
                           is_leaf};
      return kFirst ? meet({child, entry.second}) : meet({entry.first, child});
    });
  }

  // Bit i: box i overlaps the image of the other box, and its own image overlaps the other box.
  static HWY_INLINE std::uint32_t overlap(const VectorBox& box, const FloatMap& map,
                                          const Centered& image, const Centered& other) {
    const Floats d;
    const FloatVector half_one = hn::Set(d, 0.5f);
    FloatVector center[3], half[3];
    for (std::size_t k = 0; k < 3; ++k) {
      center[k] = hn::Mul(hn::Add(box.low[k], box.high[k]), half_one);
      half[k] = hn::Mul(hn::Sub(box.high[k], box.low[k]), half_one);
    }
    auto apart = hn::Gt(hn::Abs(hn::Sub(center[0], hn::Set(d, image.center[0]))),
                        hn::Add(half[0], hn::Set(d, image.half[0])));
    for (std::size_t k = 0; k < 3; ++k) {
      apart = hn::Or(apart, hn::Gt(hn::Abs(hn::Sub(center[k], hn::Set(d, image.center[k]))),
                                   hn::Add(half[k], hn::Set(d, image.half[k]))));
      FloatVector image_center = hn::Set(d, map.translation[k] - other.center[k]);
      FloatVector image_half = hn::Set(d, map.error[k] + other.half[k]);
      for (std::size_t j = 0; j < 3; ++j) {
        image_center = hn::MulAdd(hn::Set(d, map.linear[k][j]), center[j], image_center);
        image_half = hn::MulAdd(hn::Set(d, map.absolute[k][j]), half[j], image_half);
      }
      apart = hn::Or(apart, hn::Gt(hn::Abs(image_center), image_half));
    }
    return bits_of(hn::Not(apart));
  }

  // A pair whose boxes may overlap: its triangles now, or its children later.
  HWY_INLINE bool meet(const PairEntry& entry) {
    if (entry.first.is_leaf && entry.second.is_leaf) {
      const auto leaf = [](const PairPart& part, const WideCodec<Node>& codec) {
        return NodeRef{part.number, std::min(kLeafFaces, codec.face_count - part.number)};
      };
      return leaves_.visit(leaf(entry.first, first_codec_), entry.first.box,
                           leaf(entry.second, second_codec_));
    }
    if (size_ == stack_.size()) {
      error_ = Errc::kDepthExceeded;
      return false;
    }
    stack_[size_++] = entry;
    return true;
  }

  const WideCodec<Node>& first_codec_;
  const WideCodec<Node>& second_codec_;
  const PairFilter filter_;
  LeafPairs leaves_;
  std::uint64_t unmet_;
  Errc error_ = Errc::kOk;
  std::size_t size_ = 0;
  std::array<PairEntry, 2 * kWideStack<Node>> stack_;
};

template <class Node>
Result<Visit> walk(const Tree& first, const WideCodec<Node>& first_codec, const Tree& second,
                   const WideCodec<Node>& second_codec, const RelativePose& pose,
                   PairVisitor visitor) {
  return WidePairWalk<Node>(first, first_codec, second, second_codec, pose, visitor)
      .run(root_box<float>(first), root_box<float>(second));
}
Result<Visit> pair_wide8(const Tree& first, const WideCodec<Wide8Node>& first_codec,
                         const Tree& second, const WideCodec<Wide8Node>& second_codec,
                         const RelativePose& pose, PairVisitor visitor) {
  return walk(first, first_codec, second, second_codec, pose, visitor);
}
Result<Visit> pair_wide4(const Tree& first, const WideCodec<Wide4Node>& first_codec,
                         const Tree& second, const WideCodec<Wide4Node>& second_codec,
                         const RelativePose& pose, PairVisitor visitor) {
  return walk(first, first_codec, second, second_codec, pose, visitor);
}

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxtree {
namespace {

HWY_EXPORT(pair_wide8);
HWY_EXPORT(pair_wide4);

bool have_nodes(const Tree& first, const Tree& second) {
  return first.record().root == RootKind::kSubtree && second.record().root == RootKind::kSubtree;
}

}  // namespace

Result<Visit> walk_pairs(const Tree& first, const WideCodec<Wide8Node>& first_codec,
                         const Tree& second, const WideCodec<Wide8Node>& second_codec,
                         const RelativePose& pose, PairVisitor visitor) {
  if (!have_nodes(first, second)) {
    return PairWalk(first, first_codec, second, second_codec, pose, visitor).run();
  }
  return HWY_DYNAMIC_DISPATCH(pair_wide8)(first, first_codec, second, second_codec, pose, visitor);
}
Result<Visit> walk_pairs(const Tree& first, const WideCodec<Wide4Node>& first_codec,
                         const Tree& second, const WideCodec<Wide4Node>& second_codec,
                         const RelativePose& pose, PairVisitor visitor) {
  if (!have_nodes(first, second)) {
    return PairWalk(first, first_codec, second, second_codec, pose, visitor).run();
  }
  return HWY_DYNAMIC_DISPATCH(pair_wide4)(first, first_codec, second, second_codec, pose, visitor);
}

}  // namespace boxtree
#endif
