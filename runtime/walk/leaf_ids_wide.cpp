// SPDX-License-Identifier: MIT
#include "runtime/walk/leaf_ids.h"
#include "runtime/walk/targets.h"

#ifndef HWY_TARGET_INCLUDE  // compiled alone
#define HWY_TARGET_INCLUDE "runtime/walk/leaf_ids_wide.cpp"
#endif
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include "runtime/walk/word_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if BOXTREE_HAS_EIGHT_LANES
// The most bits of a field that one word holds, wherever in its first byte the field begins.
constexpr std::uint32_t kMostBits = 32 - 7;

HWY_INLINE WordVector low_bits(WordVector words, std::uint32_t width) {
  return hn::AndNot(hn::ShiftLeftSame(set(~0u), static_cast<int>(width)), words);
}

void read_ids(const FaceIdView& ids, std::uint32_t leaf, std::span<std::uint32_t, kLeafFaces> out) {
  constexpr std::uint32_t kHalf = kLeafFaces / 2;
  constexpr std::uint32_t kLoadBits = 128;
  const std::uint32_t first = leaf * kLeafFaces;
  const FaceIdView::Block block = ids.block_of(first);
  const FaceIdBlock& fields = block.fields;
  const std::uint32_t width = fields.width();
  // From last_bit on kBitPadding bytes can be read, and a load has more. The table in front of all
  // fields has more bits than are subtracted here.
  static_assert(kLoadBits - 8 * kBitPadding <= 8 * offsetof(FaceIdGroup, block));
  if (width > kMostBits || fields.start_bits > kMostBits ||
      !block.is_inside(ids.last_bit() - (kLoadBits - 8 * kBitPadding))) {
    return ids.read_leaf(leaf, out);
  }

  // Four fields from each of two loads.
  const std::uint32_t place = first % kIdBlockFaces;
  const std::uint64_t low_at = block.middle + place * width;
  const std::uint64_t high_at = low_at + kHalf * width;
  const auto load = [&](std::uint64_t bit) {
    return hn::LoadU(hn::Full128<std::uint8_t>(),
                     reinterpret_cast<const std::uint8_t*>(ids.bytes()) + bit / 8);
  };
  const auto loaded = hn::Combine(Bytes(), load(high_at), load(low_at));
  HWY_ALIGN static constexpr std::uint32_t kOfHalf[kLeafFaces] = {0, 1, 2, 3, 0, 1, 2, 3};
  const auto two = hn::ConcatLowerLower(Words(), set(static_cast<std::uint32_t>(high_at % 8)),
                                        set(static_cast<std::uint32_t>(low_at % 8)));
  const auto bit = hn::Add(hn::Mul(hn::Load(Words(), kOfHalf), set(width)), two);
  // Its first byte and the three after it.
  const auto bytes = hn::Add(hn::Mul(hn::ShiftRight<3>(bit), set(0x01010101u)), set(0x03020100u));
  const auto word = hn::BitCast(Words(), hn::TableLookupBytes(loaded, hn::BitCast(Bytes(), bytes)));
  const auto field = low_bits(hn::Shr(word, hn::And(bit, constant<7>())), width);

  // Starts of intervals lie before the middle, that of interval 0 last.
  const auto interval = hn::ShiftRightSame(field, static_cast<int>(fields.offset_bits));
  const auto before = hn::Mul(hn::Add(interval, constant<1>()), set(fields.start_bits));
  const auto at = hn::Sub(set(static_cast<std::uint32_t>(block.middle % 8)), before);
  const auto byte = hn::ShiftRight<3>(hn::BitCast(Integers(), at));
  const auto start_word = hn::GatherOffset(
      Words(), reinterpret_cast<const std::uint32_t*>(ids.bytes() + block.middle / 8), byte);
  const auto start = low_bits(hn::Shr(start_word, hn::And(at, constant<7>())), fields.start_bits);

  const auto places = hn::Iota(Words(), place);
  const auto by_place = hn::Sub(places, low_bits(places, fields.grain));
  const auto offset = low_bits(field, fields.offset_bits);
  hn::StoreU(hn::Add(hn::Add(start, offset), hn::Add(by_place, set(block.base))), Words(),
             out.data());
}
#else
void read_ids(const FaceIdView& ids, std::uint32_t leaf, std::span<std::uint32_t, kLeafFaces> out) {
  ids.read_leaf(leaf, out);
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "runtime/walk/dispatch.h"

namespace boxtree {
namespace {

BOXTREE_EXPORT(read_ids);

}  // namespace

void read_leaf_ids_wide(const FaceIdView& ids, std::uint32_t leaf,
                        std::span<std::uint32_t, kLeafFaces> out) noexcept {
  BOXTREE_DISPATCH(read_ids)(ids, leaf, out);
}

}  // namespace boxtree
#endif
