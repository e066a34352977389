// SPDX-License-Identifier: MIT
// The stack of a walk from near to far: pending children, one word each.
#if defined(BOXTREE_RUNTIME_WALK_TRAVERSAL_STACK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_WALK_TRAVERSAL_STACK_INL_H
#undef BOXTREE_RUNTIME_WALK_TRAVERSAL_STACK_INL_H
#else
#define BOXTREE_RUNTIME_WALK_TRAVERSAL_STACK_INL_H
#endif

#include <bit>
#include <cstdint>

#include "runtime/walk/node-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {

/// Children of the nodes on one path, all of one depth together. A word is the bits of the child's
/// key, a float that is not negative, with the child's number in the lowest bits. Words compare as
/// keys do. Room for the children of `kDepths` nodes.
template <std::size_t kDepths>
class TraversalStack {
 public:
  struct Child {
    std::size_t depth;
    std::uint32_t number;  // 0 to 7, in its node
  };

  /// Pushes those of eight children whose bits are set in `children`, the nearest on top.
  /// Precondition: no children of `depth` or deeper are left.
  HWY_INLINE void push(std::uint32_t children, const float* key, std::size_t depth) {
    const Floats d;
    const hn::Rebind<std::int32_t, Floats> words;
    HWY_ALIGN std::int32_t word[kWideChildren];
    hn::Vec<decltype(words)> part[kParts];
    for (std::size_t p = 0; p < kParts; ++p) {
      const auto bits = hn::BitCast(words, hn::Load(d, key + p * kLanes));
      const auto child = hn::Iota(words, static_cast<std::int32_t>(p * kLanes));
      part[p] = hn::Or(hn::AndNot(hn::Set(words, kChildBits), bits), child);
      hn::Store(part[p], words, word + p * kLanes);
    }
    const auto count = static_cast<std::size_t>(std::popcount(children));
    // Each finds its place by itself, by counting the nearer ones. No two words are equal, and no
    // branch depends on their order.
    for (std::uint32_t rest = children; rest != 0; rest &= rest - 1) {
      const std::int32_t at = word[std::countr_zero(rest)];
      std::uint32_t nearer = 0;
      for (std::size_t p = 0; p < kParts; ++p) {
        const auto less = hn::RebindMask(Floats(), hn::Lt(part[p], hn::Set(words, at)));
        nearer |= bits_of(less) << (p * kLanes);
      }
      const auto above = static_cast<std::size_t>(std::popcount(nearer & children));
      word_[size_ + count - 1 - above] = at;
      depth_[size_ + count - 1 - above] = static_cast<std::uint8_t>(depth);
    }
    size_ += count;
  }

  /// The same for one child, whose place is on top.
  HWY_INLINE void push_one(std::uint32_t child, float key, std::size_t depth) {
    word_[size_] =
        (std::bit_cast<std::int32_t>(key) & ~kChildBits) | static_cast<std::int32_t>(child);
    depth_[size_++] = static_cast<std::uint8_t>(depth);
  }

  /// Takes the next child whose key is not above `bound`; keys are compared without their lowest
  /// bits, which at most makes them smaller. False when there is none.
  HWY_INLINE bool pop(float bound, Child& child) {
    while (size_ != 0) {
      const bool is_near = top(bound, child);
      --size_;
      if (is_near) return true;
    }
    return false;
  }

  /// The child that pop() would take first, if its key is not above `bound`.
  HWY_INLINE bool top(float bound, Child& child) const {
    if (size_ == 0) return false;
    const std::int32_t word = word_[size_ - 1];
    child = {depth_[size_ - 1], static_cast<std::uint32_t>(word & kChildBits)};
    return std::bit_cast<float>(word & ~kChildBits) <= bound;
  }

 private:
  static constexpr std::int32_t kChildBits = kWideChildren - 1;
  static constexpr std::size_t kMost = kDepths * kWideChildren;
  static_assert(kDepths <= 256);

  std::size_t size_ = 0;
  std::int32_t word_[kMost];
  std::uint8_t depth_[kMost];  // the depth of each
};

}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
