// SPDX-License-Identifier: MIT
// Whole numbers of 32 bits in eight lanes that can be permuted, for decoders of leaves.
#if defined(BOXTREE_RUNTIME_WALK_WORD_LANES_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_WALK_WORD_LANES_INL_H
#undef BOXTREE_RUNTIME_WALK_WORD_LANES_INL_H
#else
#define BOXTREE_RUNTIME_WALK_WORD_LANES_INL_H
#endif

#include "format/cluster_leaf.h"
#include "runtime/walk/lane_constants.h"
#include "runtime/walk/node-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {

// Whether a vector holds a lane for each face of a leaf, and can be permuted at will.
#undef BOXTREE_HAS_EIGHT_LANES
#if HWY_MAX_BYTES >= 32 && HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR
#define BOXTREE_HAS_EIGHT_LANES 1
#else
#define BOXTREE_HAS_EIGHT_LANES 0
#endif

#if BOXTREE_HAS_EIGHT_LANES

using Words = hn::Rebind<std::uint32_t, Floats>;
using Integers = hn::Rebind<std::int32_t, Floats>;
using Halves = hn::Repartition<std::uint16_t, Floats>;
using Bytes = hn::Repartition<std::uint8_t, Floats>;
using Pairs = hn::Repartition<std::uint64_t, Floats>;
using WordVector = hn::Vec<Words>;
using WordMask = hn::Mask<Words>;

HWY_INLINE WordVector iota() {
  return hn::Iota(Words(), 0u);
}
HWY_INLINE WordVector set(const std::uint32_t& value) {
  return hn::Set(Words(), value);
}
HWY_INLINE WordMask is_less(WordVector a, WordVector b) {
  return hn::RebindMask(Words(), hn::Lt(hn::BitCast(Integers(), a), hn::BitCast(Integers(), b)));
}
// Numbers from memory, see lane_constants.h; up to LaneConstants::kMost.
HWY_INLINE WordVector small(std::uint32_t number) {
  return set(kLaneConstants.number[number]);
}
template <std::uint32_t kNumber>
HWY_INLINE WordVector constant() {
  return hn::Load(Words(), lane_constant<kNumber>().data());
}
HWY_INLINE WordMask lanes_with(WordVector word, const std::uint32_t (&bits)[kWideChildren]) {
  return hn::TestBit(word, hn::Load(Words(), bits));
}
HWY_INLINE std::uint32_t bits_of_words(WordMask mask) {
  return bits_of(hn::RebindMask(Floats(), mask));
}
// The low bits of an index are the lane. Not IndicesFromVec: it aborts in debug builds where an
// index is larger, as in lanes of which nothing is used.
template <class Vector>
HWY_INLINE Vector permute(Vector vector, WordVector lanes) {
  return hn::TableLookupLanes(vector, {lanes.raw});
}
// Lane i: how many of the 8 `bits` up to i are set.
HWY_INLINE WordVector ranks(std::uint32_t bits) {
  const hn::Rebind<std::uint8_t, Words> small;
  return hn::PromoteTo(
      Words(), hn::LoadU(small, reinterpret_cast<const std::uint8_t*>(&kRanksOfBits[bits])));
}
// Products below 2^16, in half the time of those of words.
HWY_INLINE WordVector multiply(WordVector a, WordVector b) {
  return hn::BitCast(Words(), hn::Mul(hn::BitCast(Halves(), a), hn::BitCast(Halves(), b)));
}

// Lane i: the highest of `bits` up to i that is set. Precondition: bit 0 is; less than 2^8.
HWY_INLINE WordVector last_set(std::uint32_t bits) {
  HWY_ALIGN static constexpr std::uint32_t kUpTo[kWideChildren] = {1, 3, 7, 15, 31, 63, 127, 255};
  const auto so_far = hn::BitCast(Integers(), hn::And(small(bits), hn::Load(Words(), kUpTo)));
  // The exponent of a float.
  const auto exponent = hn::ShiftRight<23>(hn::BitCast(Words(), hn::ConvertTo(Floats(), so_far)));
  return hn::Sub(exponent, constant<127>());
}

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
