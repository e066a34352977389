// SPDX-License-Identifier: MIT
// Reading nodes of the wide codecs with vectors: compiled once for each instruction set, so there
// is no guard against a second inclusion but Highway's own.
#if defined(BOXTREE_RUNTIME_WALK_NODE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_WALK_NODE_INL_H
#undef BOXTREE_RUNTIME_WALK_NODE_INL_H
#else
#define BOXTREE_RUNTIME_WALK_NODE_INL_H
#endif

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <hwy/highway.h>
#include <type_traits>

#include "format/codec_wide.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// Eight lanes where the machine has them, otherwise as many as it has: loops over `kParts`.
using Floats = hn::CappedTag<float, kWideChildren>;
using FloatVector = hn::Vec<Floats>;
inline constexpr std::size_t kLanes = hn::MaxLanes(Floats());
inline constexpr std::size_t kParts = kWideChildren / kLanes;

/// Bit i: lane i, of at most eight.
template <class D>
HWY_INLINE std::uint32_t bits_of(D d, hn::Mask<D> mask) {
  alignas(8) std::uint8_t bits[8] = {};
  hn::StoreMaskBits(d, mask, bits);
  return bits[0];
}
/// Bit i: lane i of the part.
HWY_INLINE std::uint32_t bits_of(hn::Mask<Floats> mask) {
  return bits_of(Floats(), mask);
}

/// A node in place, in memory of any alignment: fields are read one by one.
template <class Node>
class NodeView {
 public:
  NodeView(const WideCodec<Node>& codec, std::uint32_t number)
      : bytes_(codec.nodes + std::size_t{number} * sizeof(Node)) {}

  /// The links of a node, to be kept while a walk is below it.
  struct LinkBytes {
    std::byte bytes[sizeof(Node) - 2 * sizeof(Node::low)];
  };
  [[nodiscard]] HWY_INLINE LinkBytes link_bytes() const {
    LinkBytes links;
    std::memcpy(links.bytes, bytes_ + kLinks, sizeof links);
    return links;
  }
  [[nodiscard]] HWY_INLINE static WideLinks links(const LinkBytes& links) {
    return links_at(links.bytes);
  }
  [[nodiscard]] HWY_INLINE WideLinks links() const { return links_at(bytes_ + kLinks); }

  /// Where the codes of low (side 0) or high (side 1) planes of an axis are, for steps().
  [[nodiscard]] static constexpr std::size_t codes(std::size_t side, std::size_t axis) {
    static_assert(offsetof(Node, low) == 0 && offsetof(Node, high) == sizeof(Node::low));
    return side * sizeof(Node::low) + axis * (sizeof(Node::low) / 3);
  }
  /// Planes in steps: of children `part` * kLanes and on.
  [[nodiscard]] HWY_INLINE FloatVector steps(std::size_t codes, std::size_t part) const {
    const hn::Rebind<std::int32_t, Floats> integers;
    if constexpr (kIsWide8) {
      const hn::Rebind<std::uint8_t, Floats> small;
      const auto* const first =
          reinterpret_cast<const std::uint8_t*>(bytes_ + codes) + part * kLanes;
      return hn::ConvertTo(Floats(), hn::PromoteTo(integers, hn::LoadU(small, first)));
    } else {
      const hn::Rebind<std::uint32_t, Floats> words;
      const auto shift =
          hn::ShiftLeft<2>(hn::Iota(words, static_cast<std::uint32_t>(part * kLanes)));
      const auto all = hn::Set(words, load<std::uint32_t>(bytes_ + codes));
      const auto code = hn::And(hn::Shr(all, shift), hn::Set(words, 15u));
      const FloatVector number = hn::ConvertTo(Floats(), hn::BitCast(integers, code));
      const auto first_steps = hn::Set(Floats(), static_cast<float>(Node::kFirstSteps));
      return hn::Mul(number, hn::Add(number, first_steps));
    }
  }
  [[nodiscard]] HWY_INLINE FloatVector steps(std::size_t side, std::size_t axis,
                                             std::size_t part) const {
    return steps(codes(side, axis), part);
  }

 private:
  static constexpr bool kIsWide8 = std::is_same_v<Node, Wide8Node>;
  static_assert(kIsWide8 || std::is_same_v<Node, Wide4Node>);

  static constexpr std::size_t kLinks = 2 * sizeof(Node::low);

  [[nodiscard]] HWY_INLINE static WideLinks links_at(const std::byte* links) {
    if constexpr (kIsWide8) {
      return {load<std::uint32_t>(links + (offsetof(Node, first_node) - kLinks)),
              load<std::uint32_t>(links + (offsetof(Node, first_leaf) - kLinks)),
              load<std::uint8_t>(links + (offsetof(Node, inner_mask) - kLinks)),
              load<std::uint8_t>(links + (offsetof(Node, child_count) - kLinks))};
    } else {
      static_assert(offsetof(Node, links) == kLinks);
      return links_of_word(load<std::uint64_t>(links));
    }
  }

  const std::byte* bytes_;
};

/// How many of the bits below bit i are set.
HWY_INLINE std::uint32_t rank(std::uint32_t mask, std::uint32_t i) {
  return static_cast<std::uint32_t>(std::popcount(mask & ((1u << i) - 1)));
}
/// Number of the node that is child i. Precondition: that child is a node.
HWY_INLINE std::uint32_t node_number(const WideLinks& links, std::uint32_t i) {
  return links.first_node + rank(links.inner_mask, i);
}
/// Number of the leaf that is child i. Precondition: that child is a leaf.
HWY_INLINE std::uint32_t leaf_number(const WideLinks& links, std::uint32_t i) {
  return links.first_leaf + rank(~links.inner_mask, i);
}
/// No leaf has this number.
inline constexpr std::uint32_t kNoLeaf = 0xffffffffu;
/// First face of the leaf that is child i.
HWY_INLINE std::uint32_t first_face(const WideLinks& links, std::uint32_t i) {
  return leaf_number(links, i) * kLeafFaces;
}

/// The checks of WideCodec::expand, once for all children of a kind, whose numbers are consecutive.
/// Counts have fewer than 32 bits, so that no sum overflows.
template <class Node>
HWY_INLINE NodeState check_links(const WideCodec<Node>& codec, std::uint32_t number,
                                 const WideLinks& links) {
  const std::uint64_t inner = static_cast<std::uint64_t>(std::popcount(links.inner_mask));
  const std::uint64_t leaves = links.child_count - inner;
  const bool has_children =
      links.child_count - 1 < kWideChildren && (links.inner_mask >> (links.child_count & 15)) == 0;
  const bool nodes_fit =
      (inner == 0) | ((links.first_node > number) & (links.first_node + inner <= codec.node_count));
  const bool leaves_fit =
      (leaves == 0) | ((links.first_leaf + leaves - 1) * kLeafFaces < codec.face_count);
  return valid_if(has_children & nodes_fit & leaves_fit);
}

/// Calls visit(child) for each set bit, from the lowest on, while it returns true; whether all did.
template <class Visitor>
HWY_INLINE bool for_each_bit(std::uint32_t bits, Visitor&& visit) {
  for (; bits != 0; bits &= bits - 1) {
    if (!visit(static_cast<std::uint32_t>(std::countr_zero(bits)))) return false;
  }
  return true;
}

/// Takes the bit of the smallest key out of `bits`, which is not 0.
HWY_INLINE std::uint32_t take_smallest(std::uint32_t& bits, const float* key) {
  auto smallest = static_cast<std::uint32_t>(std::countr_zero(bits));
  for (std::uint32_t rest = bits & (bits - 1); rest != 0; rest &= rest - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(rest));
    smallest = key[i] < key[smallest] ? i : smallest;
  }
  bits &= ~(1u << smallest);
  return smallest;
}

}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
