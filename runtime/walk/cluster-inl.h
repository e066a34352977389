// SPDX-License-Identifier: MIT
// Decodes full leaves of triangles with 32-bit numbers from clusters, by vectors of eight lanes
// that can be permuted and gathered: the same numbers as decode_cluster_leaf (format/cluster.cpp),
// which decodes any leaf, and all of them where vectors are shorter.
#if defined(BOXTREE_RUNTIME_WALK_CLUSTER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_WALK_CLUSTER_INL_H
#undef BOXTREE_RUNTIME_WALK_CLUSTER_INL_H
#else
#define BOXTREE_RUNTIME_WALK_CLUSTER_INL_H
#endif

#include <algorithm>
#include <cstddef>

#include "format/cluster_leaf.h"
#include "runtime/walk/lane_constants.h"
#include "runtime/walk/node-inl.h"

// Whether a vector holds a lane for each face of a leaf, and can be permuted at will.
#undef BOXTREE_HAS_EIGHT_LANES
#if HWY_MAX_BYTES >= 32 && HWY_ARCH_X86 && HWY_TARGET != HWY_SCALAR
#define BOXTREE_HAS_EIGHT_LANES 1
#else
#define BOXTREE_HAS_EIGHT_LANES 0
#endif

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if BOXTREE_HAS_EIGHT_LANES

/// Reads leaves of one tree, one at a time.
class ClusterReader {
 public:
  explicit ClusterReader(const ClusterView& view) : view_(view) {}

  /// Decodes a leaf of 8 triangles: coordinates as floats times `scale`, [corner][axis][triangle].
  /// Corners are those of the source but for a turn, which position() undoes. False when its bytes
  /// are corrupt, or when decode_cluster_leaf has to read it.
  template <std::size_t kStride>
  HWY_INLINE bool read(std::uint32_t leaf, float scale, float (&out)[3][3][kStride]) {
    if (!enter(leaf / kClusterLeaves)) return false;
    // In an order in which the longest chain begins first: two gathers, the second of which waits
    // for the first.
    Faces faces;
    if (!find_faces(leaf % kClusterLeaves, faces)) return false;
    const Slots slots = find_slots(faces);
    Places places;
    if (!find_places(faces, places)) return false;
    const Named thirds =
        read_places(places, lanes_with(faces.word, kThirdBits), ranks(faces.new_thirds), 0);
    const auto new_thirds = static_cast<std::uint32_t>(std::popcount(faces.new_thirds));
    const std::uint32_t new_aparts = faces.new_aparts & 0xffu;
    const Named aparts = read_places(places, lanes_with(small(new_aparts), kLaneBits),
                                     hn::Add(ranks(new_aparts), small(new_thirds)), kLeafFaces);
    const FloatVector scales = hn::Set(Floats(), scale);
    FloatVector third[3], apart[3];
    auto corrupt = read_vertices(slots, thirds, 0, scales, third);
    const auto of_aparts = read_vertices(slots, aparts, kLeafFaces, scales, apart);
    corrupt =
        hn::Or(corrupt, hn::IfThenElseZero(is_less(iota(), small(2 * faces.aparts)), of_aparts));
    const Corners corners = join_faces(faces);
    corrupt = hn::Or(corrupt, hn::Or(corners.corrupt, slots.corrupt));
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) hn::Store(third[k], Floats(), out[2][k]);
    if (HWY_LIKELY(faces.aparts <= kWideChildren / 2)) {
      const TwoVectorLanes first(corners.first), second(corners.second);
      HWY_UNROLL(3)
      for (std::size_t k = 0; k < 3; ++k) {
        hn::Store(first.look_up(third[k], apart[k]), Floats(), out[0][k]);
        hn::Store(second.look_up(third[k], apart[k]), Floats(), out[1][k]);
      }
    } else {
      // Copies, so that the usual case may keep them in registers.
      const Faces faces_copy = faces;
      const Slots slots_copy = slots;
      const Places places_copy = places;
      const FloatVector third_copy[3] = {third[0], third[1], third[2]};
      const FloatVector apart_copy[3] = {apart[0], apart[1], apart[2]};
      corrupt = hn::Or(corrupt, read_more(faces_copy, places_copy, slots_copy, scales, third_copy,
                                          apart_copy, out));
    }
    return hn::AllTrue(Words(), hn::Eq(corrupt, hn::Zero(Words())));
  }

  /// Corner `corner` of lane `lane`: steps of the grid, or the floats of the source.
  [[nodiscard]] HWY_INLINE std::array<double, 3> position(std::uint32_t lane,
                                                          std::size_t corner) const {
    // The corner after the turn, and its reference.
    const std::uint32_t turn = step_[lane] == StripStep::kApart ? 0 : step_[lane] % 3;
    const std::size_t turned = (corner + 3 - turn) % 3;
    const std::uint32_t r = turned == 2 ? lane : corner_[turned][lane];
    if (view_.numbers == ClusterNumbers::kGrid) {
      return {static_cast<double>(static_cast<std::int32_t>(number_[0][r])),
              static_cast<double>(static_cast<std::int32_t>(number_[1][r])),
              static_cast<double>(static_cast<std::int32_t>(number_[2][r]))};
    }
    return {double{std::bit_cast<float>(number_[0][r])},
            double{std::bit_cast<float>(number_[1][r])},
            double{std::bit_cast<float>(number_[2][r])}};
  }

 private:
  using Words = hn::Rebind<std::uint32_t, Floats>;
  using Integers = hn::Rebind<std::int32_t, Floats>;
  using Bytes = hn::Repartition<std::uint8_t, Floats>;
  using WordVector = hn::Vec<Words>;
  using WordMask = hn::Mask<Words>;
  // Third corners of all faces, a lane each; after them, the other two of those that are apart.
  static constexpr std::size_t kReferences = std::size_t{3} * kLeafFaces;
  static constexpr std::uint32_t kNone = 0xffffffffu;

  // The faces of a leaf, and where its vertices are.
  struct Faces {
    std::uint32_t self = 0;        // number of the leaf in its cluster
    std::uint32_t aparts = 0;      // faces that share nothing with the one before
    std::uint32_t new_thirds = 0;  // bit f: the leaf stores the third corner of face f
    std::uint32_t new_aparts = 0;  // bit r: the same for other references, two for each of `aparts`
    std::uint32_t others = 0;      // leaves whose vertices it names
    std::uint32_t leaf_bits = 0;   // of a number of one before it
    std::uint32_t numbers_at = 0;  // byte of their numbers
    std::uint32_t places_at = 0;   // bit of the places of references that are not new
    WordVector word;               // has the bits of new_thirds, see kThirdBits
  };

  // References of the first two corners of eight faces.
  struct Corners {
    WordVector first, second;
    WordVector corrupt;  // 0 if nothing is
  };

  // The leaf itself and the others whose vertices it names, a lane each.
  struct Slots {
    WordVector middle;             // bit; beyond the cluster in unused lanes
    WordVector stride;             // bits of a vertex
    WordVector base[3];            // of its numbers
    WordVector width[3], mask[3];  // of their offsets
    WordVector corrupt;            // 0 if nothing is
    bool is_narrow = false;        // no offset has more than 25 bits
  };

  // The places of references to vertices that are not new.
  struct Places {
    hn::Vec<Bytes> bytes;
    WordVector first;                 // bit of `bytes` where the first begins
    WordVector bits;                  // of each
    WordVector slot_bits, slot_mask;  // of its first field
  };

  // Vertices that eight references lead to: the slots of their leaves, and how many vertices before
  // the middle of the leaf they begin.
  struct Named {
    WordVector slot, back;
  };

  // Of the fields of a leaf: steps, a bit for each third corner, and how many other leaves there
  // are. The numbers of these follow.
  static constexpr std::uint32_t kStepBits = StripStep::kBits * (kLeafFaces - 1);
  static constexpr std::uint32_t kNumbersAt = kStepBits + kLeafFaces + kOtherBits;
  static_assert(kNumbersAt == 32);
  HWY_ALIGN static constexpr std::uint32_t kThirdBits[kWideChildren] = {
      1u << 21, 1u << 22, 1u << 23, 1u << 24, 1u << 25, 1u << 26, 1u << 27, 1u << 28};
  static_assert(kThirdBits[0] == 1u << kStepBits);
  HWY_ALIGN static constexpr std::uint32_t kLaneBits[kWideChildren] = {1, 2, 4, 8, 16, 32, 64, 128};

  // Finds the cluster that the last leaf was in at once: neighbours are read one after another.
  HWY_INLINE bool enter(std::uint32_t number) {
    if (HWY_LIKELY(number == cluster_number_)) return true;
    cluster_number_ = kNone;
    if (!find_cluster(view_, number, cluster_)) return false;
    const ClusterHeader& header = cluster_.header;
    // Bits fit into 32 bits; corrupt places beyond that are not in any cluster.
    constexpr std::uint64_t kMostBytes = 1u << 28;
    most_bits_ = static_cast<std::uint32_t>(std::min(cluster_.size, kMostBytes)) * 8;
    static_assert(offsetof(ClusterHeader, start_bits) < 2 * kWideChildren);
    const hn::Rebind<std::uint8_t, Words> small;
    for (std::size_t half = 0; half < 2; ++half) {
      const std::size_t at = half * kWideChildren;
      const auto* const bytes = reinterpret_cast<const std::uint8_t*>(cluster_.bytes) + at;
      const auto field = hn::PromoteTo(Words(), hn::LoadU(small, bytes));
      hn::Store(field, Words(), field_ + at);
      hn::Store(low_bits_of(field), Words(), mask_ + at);
    }
    are_narrow_ = true;
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
      are_narrow_ &= field_[kWidth + k] + mask_[kWiderBits + k] <= kGatheredBits;
    }
    own_mask_ = (1u << header.own_bits) - 1;
    cluster_number_ = number;
    return true;
  }
  // A word of 32 bits at the byte of a field has so many of its bits, or more.
  static constexpr std::uint32_t kGatheredBits = 25;
  // Indices of fields of a header.
  static constexpr std::size_t kTrailing = offsetof(ClusterHeader, trailing);
  static constexpr std::size_t kBaseBits = offsetof(ClusterHeader, base_bits);
  static constexpr std::size_t kBaseShift = offsetof(ClusterHeader, base_shift);
  static constexpr std::size_t kWidth = offsetof(ClusterHeader, width);
  static constexpr std::size_t kWiderBits = offsetof(ClusterHeader, wider_bits);
  static constexpr std::size_t kStartBits = offsetof(ClusterHeader, start_bits);

  static HWY_INLINE WordVector iota() { return hn::Iota(Words(), 0u); }
  static HWY_INLINE WordVector set(std::uint32_t value) { return hn::Set(Words(), value); }
  static HWY_INLINE WordMask is_less(WordVector a, WordVector b) {
    return hn::RebindMask(Words(), hn::Lt(hn::BitCast(Integers(), a), hn::BitCast(Integers(), b)));
  }
  // Numbers from memory, see lane_constants.h; up to LaneConstants::kMost.
  static HWY_INLINE WordVector small(std::uint32_t number) {
    return set(kLaneConstants.number[number]);
  }
  template <std::uint32_t kNumber>
  static HWY_INLINE WordVector constant() {
    constexpr auto& kAll = LaneConstants::kInLanes;
    constexpr auto kRow = std::find(kAll.begin(), kAll.end(), kNumber) - kAll.begin();
    static_assert(kRow < static_cast<std::ptrdiff_t>(kAll.size()));
    return hn::Load(Words(), kLaneConstants.lanes[kRow].data());
  }
  static HWY_INLINE WordMask lanes_with(WordVector word,
                                        const std::uint32_t (&bits)[kWideChildren]) {
    return hn::TestBit(word, hn::Load(Words(), bits));
  }
  static HWY_INLINE std::uint32_t bits_of_words(WordMask mask) {
    return bits_of(hn::RebindMask(Floats(), mask));
  }
  static HWY_INLINE WordVector permute(WordVector words, WordVector lanes) {
    return hn::TableLookupLanes(words, hn::IndicesFromVec(Words(), lanes));
  }
  // Lanes of two vectors in a row.
  struct TwoVectorLanes {
    explicit HWY_INLINE TwoVectorLanes(WordVector number)
        : lanes(number),
          is_high(hn::RebindMask(Floats(), is_less(constant<kWideChildren - 1>(), number))) {}
    [[nodiscard]] HWY_INLINE FloatVector look_up(FloatVector low, FloatVector high) const {
      // The low bits of an index are the lane.
      return hn::IfThenElse(is_high, hn::TableLookupLanes(high, {lanes.raw}),
                            hn::TableLookupLanes(low, {lanes.raw}));
    }
    WordVector lanes;
    hn::Mask<Floats> is_high;
  };
  // Lane i: how many of the 8 `bits` up to i are set.
  static HWY_INLINE WordVector ranks(std::uint32_t bits) {
    const hn::Rebind<std::uint8_t, Words> small;
    return hn::PromoteTo(
        Words(), hn::LoadU(small, reinterpret_cast<const std::uint8_t*>(&kRanksOfBits[bits])));
  }
  // Products below 2^16, in half the time of those of words: not of leaf_bytes, which alone may
  // take 16 bits.
  static HWY_INLINE WordVector multiply(WordVector a, WordVector b) {
    const hn::Repartition<std::uint16_t, Words> halves;
    return hn::BitCast(Words(), hn::Mul(hn::BitCast(halves, a), hn::BitCast(halves, b)));
  }

  // Lane i: the highest of `bits` up to i that is set. Precondition: bit 0 is; less than 2^8.
  static HWY_INLINE WordVector last_set(std::uint32_t bits) {
    HWY_ALIGN static constexpr std::uint32_t kUpTo[kWideChildren] = {1, 3, 7, 15, 31, 63, 127, 255};
    const auto so_far = hn::BitCast(Integers(), hn::And(small(bits), hn::Load(Words(), kUpTo)));
    // The exponent of a float.
    const auto exponent = hn::ShiftRight<23>(hn::BitCast(Words(), hn::ConvertTo(Floats(), so_far)));
    return hn::Sub(exponent, constant<127>());
  }

  HWY_INLINE bool find_faces(std::uint32_t self, Faces& faces) const {
    const ClusterHeader& header = cluster_.header;
    const std::byte* const bytes = cluster_.bytes;
    const auto start = static_cast<std::uint32_t>(
                           read_bits(bytes, cluster_.table + self * cluster_.entry_bits, 25)) &
                       mask_[kStartBits];
    const std::uint32_t middle = cluster_.leaves_at + self * header.leaf_bytes + start;
    if (middle * 8 > most_bits_) return false;
    const auto fields = load<std::uint32_t>(bytes + middle);
    faces.word = set(fields);
    faces.self = self;
    faces.leaf_bits = static_cast<std::uint32_t>(std::bit_width(self - (self != 0 ? 1u : 0u)));
    faces.new_thirds = (fields >> kStepBits) & 0xffu;
    faces.others = fields >> (kStepBits + kLeafFaces);
    faces.numbers_at = middle + kNumbersAt / 8;
    constexpr std::uint32_t kEachStep = 0x49249u;  // the first bit of each
    faces.aparts =
        1 + static_cast<std::uint32_t>(std::popcount((fields >> 1) & (fields >> 2) & kEachStep));
    const std::uint32_t aparts_at = faces.numbers_at * 8 + faces.others * faces.leaf_bits;
    faces.new_aparts = static_cast<std::uint32_t>(read_bits(bytes, aparts_at, 2 * kLeafFaces)) &
                       ((1u << (2 * faces.aparts)) - 1);
    faces.places_at = aparts_at + 2 * faces.aparts;
    return true;
  }

  // The corners of faces, and those of the source, which position() needs.
  HWY_INLINE Corners join_faces(const Faces& faces) {
    // The step to each face; the first is apart.
    HWY_ALIGN static constexpr std::uint32_t kShift[kWideChildren] = {0, 0, 3, 6, 9, 12, 15, 18};
    HWY_ALIGN static constexpr std::uint32_t kMask[kWideChildren] = {0, 7, 7, 7, 7, 7, 7, 7};
    HWY_ALIGN static constexpr std::uint32_t kFirst[kWideChildren] = {StripStep::kApart};
    const auto step =
        hn::Or(hn::And(hn::Shr(faces.word, hn::Load(Words(), kShift)), hn::Load(Words(), kMask)),
               hn::Load(Words(), kFirst));
    const auto is_apart = is_less(constant<StripStep::kApart - 1>(), step);
    const auto is_second =
        hn::AndNot(is_apart, is_less(constant<StripStep::code(1, 0) - 1>(), step));
    Corners corners;
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
    hn::Store(step, Words(), step_);
    hn::Store(corners.first, Words(), corner_[0]);
    hn::Store(corners.second, Words(), corner_[1]);
    return corners;
  }

  // The words of 32 bits that begin at the bytes of some bits, shifted so that the field is lowest.
  // A field of up to kGatheredBits is whole.
  HWY_INLINE WordVector fields_at(WordVector bit) const {
    return hn::Shr(words_at(hn::ShiftRight<3>(bit)), hn::And(bit, constant<7>()));
  }
  // The same for fields of up to 32 bits.
  HWY_INLINE WordVector wide_fields_at(WordVector bit) const {
    const auto byte = hn::ShiftRight<3>(bit);
    const auto shift = hn::And(bit, constant<7>());
    const auto above = words_at(hn::Add(byte, constant<4>()));
    return hn::Or(hn::Shr(words_at(byte), shift),
                  hn::Shl(hn::ShiftLeft<1>(above), hn::Sub(small(31), shift)));
  }
  HWY_INLINE WordVector words_at(WordVector byte) const {
    return hn::GatherOffset(Words(), reinterpret_cast<const std::uint32_t*>(cluster_.bytes),
                            hn::BitCast(Integers(), byte));
  }

  // False if places take more bytes than a vector has.
  HWY_INLINE bool find_places(const Faces& faces, Places& places) const {
    const auto slot_bits = static_cast<std::uint32_t>(std::bit_width(faces.others));
    const std::uint32_t bits = slot_bits + cluster_.header.own_bits;
    const std::uint32_t is_new = faces.new_aparts << kLeafFaces | faces.new_thirds;
    const std::uint32_t count =
        kLeafFaces + 2 * faces.aparts - static_cast<std::uint32_t>(std::popcount(is_new));
    if (HWY_UNLIKELY(faces.places_at % 8 + count * bits > 128)) return false;
    places.bytes = hn::LoadDup128(
        Bytes(), reinterpret_cast<const std::uint8_t*>(cluster_.bytes) + faces.places_at / 8);
    places.first = small(faces.places_at % 8);
    places.bits = small(bits);
    places.slot_bits = small(slot_bits);
    places.slot_mask = small((1u << slot_bits) - 1);
    return true;
  }

  // Eight references from `first` on. `is_own`: the leaf stores their vertices. `rank`: how many
  // references up to each are such.
  HWY_INLINE Named read_places(const Places& places, WordMask is_own, WordVector rank,
                               std::uint32_t first) const {
    // Places of references that are not new follow each other. Each has at most 8 bits.
    const auto count = hn::Sub(hn::Iota(Words(), first), rank);
    const auto place = hn::Add(multiply(count, places.bits), places.first);
    const auto two_bytes =
        hn::Add(multiply(hn::ShiftRight<3>(place), constant<0x0101>()), constant<0x0100>());
    const auto field = hn::Shr(
        hn::BitCast(Words(), hn::TableLookupBytes(places.bytes, hn::BitCast(Bytes(), two_bytes))),
        hn::And(place, constant<7>()));
    const auto number = hn::And(hn::Shr(field, places.slot_bits), set(own_mask_));
    return {hn::IfThenZeroElse(is_own, hn::And(field, places.slot_mask)),
            hn::IfThenElse(is_own, rank, hn::Add(number, constant<1>()))};
  }

  HWY_INLINE Slots find_slots(const Faces& faces) const {
    const ClusterHeader& header = cluster_.header;
    Slots slots;
    // Lane 0 is the leaf itself; lane i has the i-th number, (i - 1) leaf_bits on.
    const hn::Repartition<std::uint64_t, Words> pairs;
    const auto all = hn::Set(pairs, load<std::uint64_t>(cluster_.bytes + faces.numbers_at));
    HWY_ALIGN static constexpr std::uint32_t kEven[kWideChildren] = {0, 0, 1, 0, 3, 0, 5, 0};
    HWY_ALIGN static constexpr std::uint32_t kOdd[kWideChildren] = {0, 0, 2, 0, 4, 0, 6, 0};
    HWY_ALIGN static constexpr std::uint32_t kItself[kWideChildren] = {~0u};
    const auto width = small(faces.leaf_bits);
    const auto even = hn::Shr(all, hn::MulEven(hn::Load(Words(), kEven), width));
    const auto odd = hn::Shr(all, hn::MulEven(hn::Load(Words(), kOdd), width));
    const auto number = hn::And(
        hn::OddEven(hn::BitCast(Words(), hn::ShiftLeft<32>(odd)), hn::BitCast(Words(), even)),
        small((1u << faces.leaf_bits) - 1));
    const auto self = small(faces.self);
    const auto itself = hn::Load(Words(), kItself);
    const auto leaf = hn::Or(hn::AndNot(itself, number), hn::And(itself, self));
    const auto inside = hn::Min(leaf, self);
    const auto is_listed = is_less(iota(), small(faces.others + 1));
    const auto is_before = is_less(leaf, hn::Sub(self, itself));
    const auto entry = hn::Add(multiply(inside, set(cluster_.entry_bits)), set(cluster_.table));
    const auto start = hn::And(fields_at(entry), set(mask_[kStartBits]));
    auto fields = fields_at(hn::Add(entry, set(field_[kStartBits])));
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto base = hn::And(fields, set(mask_[kBaseBits + k]));
      fields = shift_right(fields, field_[kBaseBits + k]);
      const auto wider = hn::And(fields, set(mask_[kWiderBits + k]));
      fields = shift_right(fields, field_[kWiderBits + k]);
      slots.width[k] = hn::Add(wider, set(field_[kWidth + k]));
      slots.base[k] = hn::Add(shift_left(base, field_[kBaseShift + k]),
                              set(static_cast<std::uint32_t>(cluster_.origin[k])));
      slots.mask[k] = low_bits_of(slots.width[k]);
    }
    slots.stride = hn::Add(hn::Add(slots.width[0], slots.width[1]), slots.width[2]);
    const auto middle = hn::ShiftLeft<3>(
        hn::Add(start, hn::Add(hn::Mul(inside, set(header.leaf_bytes)), set(cluster_.leaves_at))));
    const auto is_place = hn::And(is_before, hn::Eq(middle, hn::Min(middle, set(most_bits_))));
    slots.corrupt = hn::VecFromMask(Words(), hn::AndNot(is_place, is_listed));
    slots.middle = hn::Or(middle, hn::VecFromMask(Words(), hn::Not(is_listed)));
    slots.is_narrow = HWY_LIKELY(are_narrow_);
    if (!slots.is_narrow) {
      const auto widest = hn::Max(hn::Max(slots.width[0], slots.width[1]), slots.width[2]);
      const auto is_wide = hn::AndNot(is_less(widest, set(kGatheredBits + 1)), is_listed);
      slots.is_narrow = hn::AllFalse(Words(), is_wide);
    }
    return slots;
  }

  // The low bits of words, up to 32 of them: a shift by 32 gives 0 here.
  static HWY_INLINE WordVector low_bits_of(WordVector width) {
    return hn::Not(hn::Shl(set(~0u), width));
  }
  static HWY_INLINE WordVector shift_right(WordVector words, const std::uint32_t& bits) {
    return hn::Shr(words, set(bits));
  }
  static HWY_INLINE WordVector shift_left(WordVector words, const std::uint32_t& bits) {
    return hn::Shl(words, set(bits));
  }

  // The vertices of references `first` and on. Returns a vector that is 0 but for lanes whose bytes
  // are corrupt.
  HWY_INLINE WordVector read_vertices(const Slots& slots, const Named& named, std::uint32_t first,
                                      FloatVector scale, FloatVector (&out)[3]) {
    const auto slot = named.slot;
    const auto begin =
        hn::Sub(permute(slots.middle, slot), multiply(named.back, permute(slots.stride, slot)));
    WordVector bit[3];
    bit[0] = hn::Min(begin, set(most_bits_));
    bit[1] = hn::Add(bit[0], permute(slots.width[0], slot));
    bit[2] = hn::Add(bit[1], permute(slots.width[1], slot));
    WordVector stored[3];
    if (HWY_LIKELY(slots.is_narrow)) {
      HWY_UNROLL(3)
      for (std::size_t k = 0; k < 3; ++k) stored[k] = fields_at(bit[k]);
    } else {
      HWY_UNROLL(3)
      for (std::size_t k = 0; k < 3; ++k) stored[k] = wide_fields_at(bit[k]);
    }
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
      stored[k] =
          hn::Add(hn::And(stored[k], permute(slots.mask[k], slot)), permute(slots.base[k], slot));
    }
    if (view_.numbers == ClusterNumbers::kGrid) {
      HWY_UNROLL(3)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto whole = shift_left(stored[k], field_[kTrailing + k]);
        hn::Store(whole, Words(), number_[k] + first);
        out[k] = hn::Mul(hn::ConvertTo(Floats(), hn::BitCast(Integers(), whole)), scale);
      }
    } else {
      HWY_UNROLL(3)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto sign = hn::BroadcastSignBit(hn::BitCast(Integers(), stored[k]));
        const auto signs = hn::BitCast(Words(), sign);
        const auto magnitude = shift_left(hn::Xor(stored[k], signs), field_[kTrailing + k]);
        const auto bits = hn::Or(magnitude, hn::ShiftLeft<31>(signs));
        hn::Store(bits, Words(), number_[k] + first);
        out[k] = hn::Mul(hn::BitCast(Floats(), bits), scale);
      }
    }
    return hn::Xor(bit[0], begin);
  }

  // The vertices of more than four faces that are apart, and the corners of the leaf.
  template <std::size_t kStride>
  HWY_NOINLINE WordVector read_more(const Faces& faces, const Places& places, const Slots& slots,
                                    FloatVector scale, const FloatVector (&third)[3],
                                    const FloatVector (&apart)[3], float (&out)[3][3][kStride]) {
    const std::uint32_t before = faces.new_thirds | (faces.new_aparts & 0xffu) << kWideChildren;
    const std::uint32_t is_new = faces.new_aparts >> kWideChildren;
    const auto rank =
        hn::Add(ranks(is_new), small(static_cast<std::uint32_t>(std::popcount(before))));
    const Named named =
        read_places(places, lanes_with(small(is_new), kLaneBits), rank, 2 * kWideChildren);
    FloatVector more[3];
    const auto corrupt = read_vertices(slots, named, 2 * kWideChildren, scale, more);
    HWY_ALIGN float all[kReferences];
    for (std::size_t k = 0; k < 3; ++k) {
      hn::Store(third[k], Floats(), all);
      hn::Store(apart[k], Floats(), all + kWideChildren);
      hn::Store(more[k], Floats(), all + 2 * kWideChildren);
      for (std::size_t i = 0; i < kLeafFaces; ++i) {
        out[0][k][i] = all[corner_[0][i]];
        out[1][k][i] = all[corner_[1][i]];
      }
    }
    return hn::IfThenElseZero(is_less(iota(), small(2 * faces.aparts - kWideChildren)), corrupt);
  }

  const ClusterView& view_;
  std::uint32_t cluster_number_ = kNone;
  Cluster cluster_;
  std::uint32_t most_bits_ = 0;  // at which a field may begin
  bool are_narrow_ = false;      // no offset of a vertex can have more than 25 bits
  std::uint32_t own_mask_ = 0;
  // The first bytes of the header, a word each, and as many set bits as each says.
  HWY_ALIGN std::uint32_t field_[2 * kWideChildren];
  HWY_ALIGN std::uint32_t mask_[2 * kWideChildren];
  HWY_ALIGN std::uint32_t step_[kLeafFaces];        // to each face
  HWY_ALIGN std::uint32_t corner_[2][kLeafFaces];   // references of its first two corners
  HWY_ALIGN std::uint32_t number_[3][kReferences];  // [axis]: whole numbers, or bits of floats
};

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
