// SPDX-License-Identifier: MIT
// The faces of a leaf of a cluster, joined from the steps of its strip (format/cluster.h,
// StripStep).
#if defined(BOXTREE_RUNTIME_WALK_STRIP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_WALK_STRIP_INL_H
#undef BOXTREE_RUNTIME_WALK_STRIP_INL_H
#else
#define BOXTREE_RUNTIME_WALK_STRIP_INL_H
#endif

#include "runtime/tree/leaf_fields.h"
#include "runtime/walk/word_lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if BOXTREE_HAS_EIGHT_LANES

/// References of the first two corners of eight faces.
struct StripCorners {
  WordVector first, second;
  WordVector corrupt;  // 0 if nothing is
};

/// Joins the faces of a leaf. `fields`: LeafFields::fields in each lane. Also writes what
/// LeafTriangles::read_corners needs.
HWY_INLINE StripCorners join_strip(WordVector fields, LeafTriangles& out) {
  // The step to each face; the first is apart.
  HWY_ALIGN static constexpr std::uint32_t kShift[kWideChildren] = {0, 0, 3, 6, 9, 12, 15, 18};
  HWY_ALIGN static constexpr std::uint32_t kMask[kWideChildren] = {0, 7, 7, 7, 7, 7, 7, 7};
  HWY_ALIGN static constexpr std::uint32_t kFirst[kWideChildren] = {StripStep::kApart};
  const auto step =
      hn::Or(hn::And(hn::Shr(fields, hn::Load(Words(), kShift)), hn::Load(Words(), kMask)),
             hn::Load(Words(), kFirst));
  const auto is_apart = is_less(constant<StripStep::kApart - 1>(), step);
  const auto is_second = hn::AndNot(is_apart, is_less(constant<StripStep::code(1, 0) - 1>(), step));
  StripCorners corners;
  corners.corrupt = hn::VecFromMask(Words(), is_less(constant<StripStep::kApart>(), step));
  const std::uint32_t aparts = bits_of_words(is_apart);
  const std::uint32_t seconds = bits_of_words(is_second);
  // One corner of a face that is not apart is the third of the face before. The other is one of
  // that face: the same that it shares with the face before it, unless the side changes, and
  // then the third corner of that one. References from 8 on are of faces that are apart.
  HWY_ALIGN static constexpr std::uint32_t kBefore[kWideChildren] = {0, 0, 1, 2, 3, 4, 5, 6};
  const auto before = hn::Load(Words(), kBefore);
  const auto rank = ranks(aparts);
  const auto pair = hn::Add(hn::Add(rank, rank), constant<kLeafFaces - 2>());
  const auto last = hn::IfThenElse(is_apart, pair, before);
  const auto changed =
      hn::IfThenElse(is_apart, hn::Add(pair, constant<1>()), permute(last, before));
  const auto kept = permute(changed, last_set(aparts | ((seconds ^ seconds << 1) & 0xffu)));
  corners.first = hn::IfThenElse(is_second, kept, last);
  corners.second = hn::IfThenElse(is_second, last, kept);
  hn::Store(step, Words(), out.step);
  hn::Store(corners.first, Words(), out.corner[0]);
  hn::Store(corners.second, Words(), out.corner[1]);
  return corners;
}

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
