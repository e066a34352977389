// SPDX-License-Identifier: MIT
// The children of a node that a walk from near to far has still to visit, in vectors.
#if defined(BOXTREE_RUNTIME_WALK_PENDING_CHILDREN_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_WALK_PENDING_CHILDREN_INL_H
#undef BOXTREE_RUNTIME_WALK_PENDING_CHILDREN_INL_H
#else
#define BOXTREE_RUNTIME_WALK_PENDING_CHILDREN_INL_H
#endif

#include <bit>
#include <cstdint>
#include <limits>

#include "runtime/walk/node-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if HWY_TARGET != HWY_SCALAR

/// A word for each of eight children: the bits of its key, a float that is not negative, with the
/// child's number in the lowest bits. Words compare as keys do. They are not sorted: the nearest is
/// the minimum of all lanes, which takes no branch that depends on their order.
class PendingChildren {
 public:
  using Words = hn::Rebind<std::int32_t, Floats>;
  /// Of a node, while a walk is elsewhere.
  struct Stored {
    HWY_ALIGN std::int32_t word[kWideChildren];
  };

  /// Of children `part` * kLanes and on, those that `are_pending`.
  HWY_INLINE void set(std::size_t part, FloatVector key, hn::Mask<Floats> are_pending) {
    const Words d;
    const auto number = hn::Iota(d, static_cast<std::int32_t>(part * kLanes));
    const auto bits = hn::And(hn::LoadU(d, kKeyBits), hn::BitCast(d, key));
    word_[part] =
        hn::IfThenElse(hn::RebindMask(d, are_pending), hn::Or(bits, number), hn::Set(d, kNone));
  }

  /// The word of the nearest one; is_beyond() every bound if there is none.
  [[nodiscard]] HWY_INLINE std::int32_t nearest() const {
    if constexpr (kParts == 1) {
      const hn::Half<Words> half;
      return least(half, hn::Min(hn::LowerHalf(half, word_[0]), hn::UpperHalf(half, word_[0])));
    } else {
      auto nearest = word_[0];
      for (std::size_t part = 1; part < kParts; ++part) nearest = hn::Min(nearest, word_[part]);
      return least(Words(), nearest);
    }
  }
  /// Keys are compared without their lowest bits, which at most makes them smaller.
  [[nodiscard]] static bool is_beyond(float bound, std::int32_t word) {
    return (word & ~kNumberBits) > std::bit_cast<std::int32_t>(bound);
  }
  [[nodiscard]] static std::uint32_t number_of(std::int32_t word) {
    return static_cast<std::uint32_t>(word & kNumberBits);
  }

  HWY_INLINE void store_without(std::int32_t word, Stored& out) const {
    const Words d;
    for (std::size_t part = 0; part < kParts; ++part) {
      const auto is_it = hn::Eq(word_[part], hn::Set(d, word));
      hn::Store(hn::IfThenElse(is_it, hn::Set(d, kNone), word_[part]), d, out.word + part * kLanes);
    }
  }
  HWY_INLINE void load(const Stored& stored) {
    for (std::size_t part = 0; part < kParts; ++part) {
      word_[part] = hn::Load(Words(), stored.word + part * kLanes);
    }
  }

 private:
  static constexpr std::int32_t kNumberBits = kWideChildren - 1;
  // In memory, since compilers put constants together by several instructions.
  static constexpr std::int32_t kKeyBits[] = {~kNumberBits, ~kNumberBits, ~kNumberBits,
                                              ~kNumberBits, ~kNumberBits, ~kNumberBits,
                                              ~kNumberBits, ~kNumberBits};
  // Without its lowest bits it is above the bits of infinity.
  static constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::max();

  template <class D>
  [[nodiscard]] HWY_INLINE static std::int32_t least(D d, hn::Vec<D> words) {
    return hn::GetLane(hn::MinOfLanes(d, words));
  }

  hn::Vec<Words> word_[kParts];
};

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
