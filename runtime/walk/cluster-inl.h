// SPDX-License-Identifier: MIT
// Decodes full leaves with 32-bit numbers from clusters, by vectors of eight lanes that can be
// permuted: the same numbers as decode_cluster_leaf (format/cluster.cpp), which decodes any leaf,
// and all of them where vectors are shorter.
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
  explicit ClusterReader(const ClusterView& view)
      : view_(view), quad_bytes_(view.corners_per_face == 4 ? kLeafFaces / 8 : 0) {}

  /// Decodes a leaf of 8 faces: coordinates as floats times `scale`, [corner][axis][triangle].
  /// Corners of leaves without quads are those of the source but for a turn, which read_corners()
  /// undoes. False when its bytes are corrupt, or when decode_cluster_leaf has to read it.
  template <std::size_t kStride>
  HWY_INLINE bool read(std::uint32_t leaf, float scale, float (&out)[3][3][kStride]) {
    if (!enter(leaf / kClusterLeaves)) return false;
    Faces faces;
    if (!find_faces(leaf % kClusterLeaves, faces)) return false;
    if (HWY_UNLIKELY(!faces.is_usual)) {
      const Faces faces_copy = faces;  // so that the usual case may keep it in registers
      return read_any(faces_copy, scale, out);
    }
    triangles_ = kLeafFaces;
    const Vertices thirds =
        find_vertices(faces, lanes_with(faces.word, kThirdBits), ranks(faces.new_thirds), 0);
    const auto new_thirds = static_cast<std::uint32_t>(std::popcount(faces.new_thirds));
    const std::uint32_t new_aparts = faces.new_others & 0xffu;
    const Vertices aparts =
        find_vertices(faces, lanes_with(small(new_aparts), kLaneBits),
                      hn::Add(ranks(new_aparts), small(new_thirds)), kLeafFaces);
    const FloatVector scales = hn::Set(Floats(), scale);
    FloatVector third[3], apart[3];
    if (HWY_LIKELY(layout_ == Layout::kLong)) {
      read_vertices<Layout::kLong>(thirds, 0, scales, third);
      read_vertices<Layout::kLong>(aparts, kLeafFaces, scales, apart);
    } else if (layout_ == Layout::kShort) {
      read_vertices<Layout::kShort>(thirds, 0, scales, third);
      read_vertices<Layout::kShort>(aparts, kLeafFaces, scales, apart);
    } else {
      read_vertices<Layout::kAny>(thirds, 0, scales, third);
      read_vertices<Layout::kAny>(aparts, kLeafFaces, scales, apart);
    }
    auto corrupt =
        hn::Or(thirds.corrupt,
               hn::IfThenElseZero(is_less(iota(), small(2 * faces.aparts)), aparts.corrupt));
    const Corners corners = join_faces(faces);
    corrupt = hn::Or(corrupt, corners.corrupt);
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) hn::Store(third[k], Floats(), out[2][k]);
    const TwoVectorLanes first(corners.first), second(corners.second);
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
      hn::Store(first.look_up(third[k], apart[k]), Floats(), out[0][k]);
      hn::Store(second.look_up(third[k], apart[k]), Floats(), out[1][k]);
    }
    return hn::AllTrue(Words(), hn::Eq(corrupt, hn::Zero(Words())));
  }

  /// Of the last leaf; a quad is two, one after the other.
  [[nodiscard]] std::uint32_t triangle_count() const { return triangles_; }
  [[nodiscard]] HWY_INLINE std::uint32_t face(std::uint32_t lane) const {
    return triangles_ == kLeafFaces ? lane : of_quads_[lane].face;
  }
  /// 1 for the second triangle of a quad.
  [[nodiscard]] HWY_INLINE std::uint32_t half(std::uint32_t lane) const {
    return triangles_ == kLeafFaces ? 0 : of_quads_[lane].half;
  }

  /// Calls set(corner, x, y, z) for the corners of lane `lane`: steps of the grid, or the floats of
  /// the source.
  template <class Setter>
  HWY_INLINE void read_corners(std::uint32_t lane, const Setter& set) const {
    // Its references, and the corner of the source that the first of them is.
    std::uint32_t references[3] = {0, 0, lane};
    std::uint32_t turn = 0;
    if (triangles_ == kLeafFaces) {
      references[0] = corner_[0][lane];
      references[1] = corner_[1][lane];
      static constexpr std::uint8_t kTurn[] = {0, 1, 2, 0, 1, 2, 0, 0};
      static_assert(kTurn[StripStep::kApart] == 0 && kTurn[StripStep::code(1, 2)] == 2);
      turn = kTurn[step_[lane]];
    } else {
      for (std::size_t c = 0; c < 3; ++c) references[c] = of_quads_[lane].reference[c];
    }
    static constexpr std::uint8_t kNext[] = {0, 1, 2, 0, 1};
    const std::uint8_t* const place = kNext + turn;
    const auto fill = [&](const auto& real) {
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t r = references[i];
        set(place[i], real(number_[0][r]), real(number_[1][r]), real(number_[2][r]));
      }
    };
    if (view_.numbers == ClusterNumbers::kGrid) {
      fill([](std::uint32_t number) { return double{static_cast<std::int32_t>(number)}; });
    } else {
      fill([](std::uint32_t number) { return double{std::bit_cast<float>(number)}; });
    }
  }

 private:
  using Words = hn::Rebind<std::uint32_t, Floats>;
  using Integers = hn::Rebind<std::int32_t, Floats>;
  using Halves = hn::Repartition<std::uint16_t, Floats>;
  using Bytes = hn::Repartition<std::uint8_t, Floats>;
  using Pairs = hn::Repartition<std::uint64_t, Floats>;
  using WordVector = hn::Vec<Words>;
  using WordMask = hn::Mask<Words>;
  // Third corners of all faces, a lane each; after them, the other two of those that are apart, and
  // the fourth corners of quads.
  static constexpr std::size_t kReferences = kMostLeafReferences;
  // A triangle of a leaf with quads.
  struct OfQuads {
    std::uint8_t face, half;
    std::array<std::uint8_t, 3> reference;
  };
  static constexpr std::uint32_t kNone = 0xffffffffu;

  // The faces of a leaf, and where the vertices are that it refers to.
  struct Faces {
    std::uint32_t aparts = 0;      // faces that share nothing with the one before
    std::uint32_t new_thirds = 0;  // bit f: the third corner of face f is new
    std::uint32_t quads = 0;       // bit f: face f is one
    std::uint32_t others = 0;      // other references: two for each of `aparts`, one for each quad
    std::uint32_t new_others = 0;  // bit r: the same for these
    std::uint32_t before = 0;      // vertices that leaves before use, less 1
    std::uint32_t last = 0;        // number of the last new vertex
    std::uint32_t old_bits = 0;    // of each reference that is not new
    const std::uint8_t* bytes = nullptr;  // new_others, then references that are not new
    hn::Vec<Bytes> window;                // the first 16 of them, or some later ones, in each half
    std::uint32_t places_at = 0;          // bit of `window` where the first of these begins
    WordVector word;                      // has the bits of new_thirds, see kThirdBits
    bool is_usual = false;  // triangles whose other references are 8 and whose bytes are `window`
  };

  // References of the first two corners of eight faces.
  struct Corners {
    WordVector first, second;
    WordVector corrupt;  // 0 if nothing is
  };

  // Where eight vertices are.
  struct Vertices {
    WordVector group;    // as an index for look_up
    WordVector byte;     // of the cluster
    WordVector shift;    // the bit of that byte
    WordVector corrupt;  // 0 if nothing is
  };

  // Eight words of 128 bits: words of 32 bits of each, the lowest first.
  struct LongWords {
    WordVector part[4];
  };

  // Where the offsets of all vertices of a cluster lie, by which they are cut out of the words that
  // hold them. In the first two, that of x is in the first 32 bits, and that of y in the first 64.
  enum class Layout : std::uint8_t {
    kShort,  // z, too
    kLong,   // z begins after the first 32 bits
    kAny,
  };

  // Of the fields of a leaf: steps, a bit for each third corner, and how many bits more than
  // ClusterHeader::old_bits references have.
  static constexpr std::uint32_t kStepBits = StripStep::kBits * (kLeafFaces - 1);
  static_assert(kStepBits + kLeafFaces + kOldWiderBits == 32);
  static constexpr std::uint32_t kWindowBits = 128;
  HWY_ALIGN static constexpr std::uint32_t kThirdBits[kWideChildren] = {
      1u << 21, 1u << 22, 1u << 23, 1u << 24, 1u << 25, 1u << 26, 1u << 27, 1u << 28};
  static_assert(kThirdBits[0] == 1u << kStepBits);
  HWY_ALIGN static constexpr std::uint32_t kLaneBits[kWideChildren] = {1, 2, 4, 8, 16, 32, 64, 128};

  // Finds the cluster that the last leaf was in at once: neighbours are read one after another.
  HWY_INLINE bool enter(std::uint32_t number) {
    if (HWY_LIKELY(number == cluster_number_)) return true;
    return find(number);
  }

  HWY_NOINLINE bool find(std::uint32_t number) {
    cluster_number_ = kNone;
    Cluster cluster;
    if (!find_cluster(view_, number, cluster)) return false;
    const ClusterHeader header = cluster.header();
    if (header.group_size > ClusterHeader::kFastGroupSize || !find_groups(cluster)) return false;
    bytes_ = cluster.bytes;
    size_ = static_cast<std::uint32_t>(std::min<std::uint64_t>(cluster.size, 0xffffffffu));
    table_ = cluster.table;
    entry_bits_ = cluster.entry_bits;
    start_bits_ = header.start_bits;
    start_slope_ = header.start_slope;
    starts_at_ = header.leaves_at - std::uint32_t{header.start_bias};
    first_slope_ = header.first_slope;
    first_bias_ = header.first_bias + 1u;
    old_bits_ = header.old_bits;
    bases_ = cluster.bytes + cluster.bases_at;
    groups_ = cluster.groups;
    last_vertex_ = header.vertex_count - 1u;
    group_size_ = header.group_size;
    per_group_ = 0xffffu / header.group_size + 1;
    const hn::Rebind<std::uint8_t, Words> small;
    HWY_ALIGN std::uint32_t field[kWideChildren];  // the first bytes of the header
    hn::Store(
        hn::PromoteTo(Words(), hn::LoadU(small, reinterpret_cast<const std::uint8_t*>(bytes_))),
        Words(), field);
    constexpr std::size_t kTrailing = offsetof(ClusterHeader, trailing);
    constexpr std::size_t kBaseShift = offsetof(ClusterHeader, base_shift);
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
      hn::Store(set(field[kTrailing + k]), Words(), trailing_[k]);
      hn::Store(set(field[kBaseShift + k]), Words(), base_shift_[k]);
      const auto origin = boxtree::load<std::uint32_t>(bytes_ + sizeof(ClusterHeader), k);
      hn::Store(set(origin), Words(), origin_[k]);
    }
    cluster_number_ = number;
    return true;
  }
  // With up to 7 bits before, in the first 32 and 64.
  static constexpr std::uint8_t kWord = 32, kNarrow = kMostBitsRead, kOfX = 25;
  HWY_ALIGN static constexpr std::uint8_t kMostOfX[] = {kOfX, kOfX, kOfX, kOfX, kOfX, kOfX,
                                                        kOfX, kOfX, kOfX, kOfX, kOfX, kOfX,
                                                        kOfX, kOfX, kOfX, kOfX};
  HWY_ALIGN static constexpr std::uint8_t kWordBits[] = {kWord, kWord, kWord, kWord, kWord, kWord,
                                                         kWord, kWord, kWord, kWord, kWord, kWord,
                                                         kWord, kWord, kWord, kWord};
  HWY_ALIGN static constexpr std::uint8_t kMostOfTwo[] = {
      kNarrow, kNarrow, kNarrow, kNarrow, kNarrow, kNarrow, kNarrow, kNarrow,
      kNarrow, kNarrow, kNarrow, kNarrow, kNarrow, kNarrow, kNarrow, kNarrow};
  HWY_ALIGN static constexpr std::uint8_t kNibble[] = {15, 15, 15, 15, 15, 15, 15, 15,
                                                       15, 15, 15, 15, 15, 15, 15, 15};

  // The same as boxtree::find_groups. Precondition: groups have at most kFastGroupSize vertices.
  HWY_INLINE bool find_groups(const Cluster& cluster) {
    const ClusterHeader header = cluster.header();
    const hn::FixedTag<std::uint8_t, ClusterHeader::kMostGroups> bytes;
    using ByteVector = hn::Vec<decltype(bytes)>;
    const hn::FixedTag<std::uint8_t, ClusterHeader::kMostGroups / 2> half;
    const auto is_group = hn::FirstN(bytes, cluster.groups);
    ByteVector width[3];
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto* const at = reinterpret_cast<const std::uint8_t*>(cluster.bytes) +
                             cluster.wider_at + k * cluster.wider_bytes();
      const ByteVector pairs{hn::LoadU(half, at).raw};
      const hn::Repartition<std::uint16_t, decltype(bytes)> halves;
      const auto high = hn::BitCast(bytes, hn::ShiftRight<4>(hn::BitCast(halves, pairs)));
      const auto wider = hn::And(hn::InterleaveLower(bytes, pairs, high), hn::Load(bytes, kNibble));
      width[k] = hn::IfThenElseZero(is_group, hn::Add(wider, hn::Set(bytes, header.width[k])));
      hn::Store(width[k], bytes, width_[k]);
    }
    const auto two = hn::Add(width[0], width[1]);
    const auto stride = hn::Add(two, width[2]);
    hn::Store(stride, bytes, stride_);
    // How much numbers are above what they may be.
    const auto above = [&](ByteVector numbers, const std::uint8_t(&most)[16]) {
      return hn::SaturatedSub(numbers, hn::Load(bytes, most));
    };
    const auto is_zero = [&](ByteVector numbers) {
      return hn::AllTrue(bytes, hn::Eq(numbers, hn::Zero(bytes)));
    };
    const auto widest = hn::Max(hn::Max(width[0], width[1]), width[2]);
    if (!is_zero(above(widest, kWordBits))) return false;
    layout_ = Layout::kAny;
    if (is_zero(hn::Or(above(width[0], kMostOfX), above(two, kMostOfTwo)))) {
      const auto least = hn::IfThenElseZero(is_group, hn::Load(bytes, kWordBits));
      if (is_zero(hn::SaturatedSub(least, two))) {
        layout_ = Layout::kLong;
      } else if (is_zero(above(stride, kMostOfTwo))) {
        layout_ = Layout::kShort;
      }
    }
    // Where they start: sums of what those before take.
    HWY_ALIGN static constexpr std::uint16_t kIota[ClusterHeader::kMostGroups] = {
        0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const auto half_words = [](std::uint32_t value) {
      return hn::Set(Halves(), static_cast<std::uint16_t>(value));
    };
    const auto is_last = hn::Eq(hn::Load(Halves(), kIota), half_words(cluster.groups - 1));
    const auto vertices = hn::IfThenElse(is_last, half_words(cluster.last_group_size()),
                                         half_words(header.group_size));
    const auto taken = hn::ShiftRight<3>(
        hn::Add(hn::Mul(hn::PromoteTo(Halves(), stride), vertices), half_words(7)));
    auto end = taken;
    end = hn::Add(end, hn::ShiftLeftLanes<1>(Halves(), end));
    end = hn::Add(end, hn::ShiftLeftLanes<2>(Halves(), end));
    end = hn::Add(end, hn::ShiftLeftLanes<4>(Halves(), end));
    const auto carried = hn::Broadcast<7>(end);
    end = hn::Add(end, hn::ConcatLowerLower(Halves(), carried, hn::Zero(Halves())));
    const auto start = hn::Add(hn::Sub(end, taken), half_words(cluster.vertices_at));
    const auto low = hn::And(start, half_words(0xff));
    const auto high = hn::ShiftRight<8>(start);
    hn::Store(pack(low), bytes, start_low_);
    hn::Store(pack(high), bytes, start_high_);
    const std::uint32_t all = hn::ExtractLane(hn::UpperHalf(hn::Half<Halves>(), end), 7);
    return cluster.vertices_at + all == header.leaves_at;
  }
  static HWY_INLINE hn::Vec128<std::uint8_t> pack(hn::Vec<Halves> halves) {
    return hn::Vec128<std::uint8_t>{_mm_packus_epi16(_mm256_castsi256_si128(halves.raw),
                                                     _mm256_extracti128_si256(halves.raw, 1))};
  }

  static HWY_INLINE WordVector iota() { return hn::Iota(Words(), 0u); }
  static HWY_INLINE WordVector set(const std::uint32_t& value) { return hn::Set(Words(), value); }
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
  // Products below 2^16, in half the time of those of words.
  static HWY_INLINE WordVector multiply(WordVector a, WordVector b) {
    return hn::BitCast(Words(), hn::Mul(hn::BitCast(Halves(), a), hn::BitCast(Halves(), b)));
  }

  // Lane i: the highest of `bits` up to i that is set. Precondition: bit 0 is; less than 2^8.
  static HWY_INLINE WordVector last_set(std::uint32_t bits) {
    HWY_ALIGN static constexpr std::uint32_t kUpTo[kWideChildren] = {1, 3, 7, 15, 31, 63, 127, 255};
    const auto so_far = hn::BitCast(Integers(), hn::And(small(bits), hn::Load(Words(), kUpTo)));
    // The exponent of a float.
    const auto exponent = hn::ShiftRight<23>(hn::BitCast(Words(), hn::ConvertTo(Floats(), so_far)));
    return hn::Sub(exponent, constant<127>());
  }

  // False if the leaf is corrupt.
  HWY_INLINE bool find_faces(std::uint32_t self, Faces& faces) const {
    const std::byte* const bytes = bytes_;
    const std::uint32_t bit = table_ + self * entry_bits_;
    const auto entry =
        static_cast<std::uint32_t>(boxtree::load<std::uint64_t>(bytes + bit / 8) >> (bit % 8)) &
        ((1u << entry_bits_) - 1);
    constexpr std::uint32_t kSlopeBits = ClusterHeader::kSlopeBits;
    const std::uint32_t byte =
        starts_at_ + (self * start_slope_ >> kSlopeBits) + (entry & ((1u << start_bits_) - 1));
    if (byte > size_) return false;
    // In a store with quads, a bit for each face tells whether it is one.
    const std::uint32_t at = byte + quad_bytes_;
    faces.quads = quad_bytes_ != 0 ? std::to_integer<std::uint32_t>(bytes[byte]) : 0;
    const auto fields = boxtree::load<std::uint32_t>(bytes + at);
    faces.bytes = reinterpret_cast<const std::uint8_t*>(bytes) + at + sizeof(fields);
    faces.word = set(fields);
    faces.window = hn::LoadDup128(Bytes(), faces.bytes);
    faces.new_thirds = (fields >> kStepBits) & 0xffu;
    faces.old_bits = old_bits_ + (fields >> (kStepBits + kLeafFaces));
    constexpr std::uint32_t kEachStep = 0x49249u;  // the first bit of each
    faces.aparts =
        1 + static_cast<std::uint32_t>(std::popcount((fields >> 1) & (fields >> 2) & kEachStep));
    faces.others = 2 * faces.aparts + static_cast<std::uint32_t>(std::popcount(faces.quads));
    faces.new_others =
        boxtree::load<std::uint32_t>(bytes + at + sizeof(fields)) & ((1u << faces.others) - 1);
    const auto new_vertices = static_cast<std::uint32_t>(
        std::popcount(faces.new_others << kLeafFaces | faces.new_thirds));
    faces.before = (entry >> start_bits_) + (self * first_slope_ >> kSlopeBits) - first_bias_;
    faces.last = faces.before + new_vertices;
    faces.places_at = faces.others;
    const std::uint32_t olds = kLeafFaces + faces.others - new_vertices;
    faces.is_usual = faces.quads == 0 && faces.aparts <= kWideChildren / 2 &&
                     faces.others + olds * faces.old_bits <= kWindowBits;
    return true;
  }

  // The corners of faces, and those of the source, which read_corners() needs.
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

  // The byte of a table that each lane of `group` names.
  static HWY_INLINE WordVector look_up(hn::Vec<Bytes> table, WordVector group) {
    return hn::BitCast(Words(), hn::TableLookupBytes(table, hn::BitCast(Bytes(), group)));
  }
  static HWY_INLINE WordVector look_up(const std::uint8_t (&table)[ClusterHeader::kMostGroups],
                                       WordVector group) {
    return look_up(hn::LoadDup128(Bytes(), table), group);
  }

  // The vertices of references `first` to `first` + 7. `rank`: how many up to each are new.
  HWY_INLINE Vertices find_vertices(const Faces& faces, WordMask is_new, WordVector rank,
                                    std::uint32_t first) const {
    // Those that are not new have their fields one after another, each in up to three bytes.
    HWY_ALIGN static constexpr std::uint8_t kFirstByte[32] = {
        0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12,
        0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12};
    const auto old = hn::Sub(hn::Iota(Words(), first), rank);
    const auto place = hn::Add(multiply(old, small(faces.old_bits)), set(faces.places_at));
    const auto byte = hn::TableLookupBytes(hn::BitCast(Bytes(), hn::ShiftRight<3>(place)),
                                           hn::Load(Bytes(), kFirstByte));
    const auto three = hn::Add(hn::BitCast(Words(), byte), constant<kThreeBytes>());
    const auto field = hn::And(
        hn::Shr(
            hn::BitCast(Words(), hn::TableLookupBytes(faces.window, hn::BitCast(Bytes(), three))),
            hn::And(place, constant<7>())),
        set(kLaneConstants.low_bits[faces.old_bits]));
    const auto number =
        hn::IfThenElse(is_new, hn::Add(set(faces.before), rank), hn::Sub(set(faces.last), field));
    const auto inside = hn::Min(number, set(last_vertex_));
    const auto group = hn::BitCast(Words(), hn::MulHigh(hn::BitCast(Halves(), inside),
                                                        hn::BitCast(Halves(), set(per_group_))));
    const auto in_group = hn::Sub(inside, multiply(group, set(group_size_)));
    Vertices out;
    out.group = hn::Or(group, constant<kLowByte>());
    const auto start =
        hn::Or(look_up(start_low_, out.group), hn::ShiftLeft<8>(look_up(start_high_, out.group)));
    const auto bit = multiply(in_group, look_up(stride_, out.group));
    out.byte = hn::Add(start, hn::ShiftRight<3>(bit));
    out.shift = hn::And(bit, constant<7>());
    out.corrupt = hn::Xor(number, inside);
    return out;
  }
  static constexpr std::uint32_t kThreeBytes = 0x80020100u;  // added to the first, in each
  static constexpr std::uint32_t kLowByte = 0x80808000u;     // other bytes name nothing

  // The low bits of words, up to 32 of them: a shift by 32 gives 0 here.
  static HWY_INLINE WordVector low_bits_of(WordVector width) {
    return hn::Not(hn::Shl(set(~0u), width));
  }
  static HWY_INLINE WordVector shift_left(WordVector words,
                                          const std::uint32_t (&bits)[kWideChildren]) {
    return hn::Shl(words, hn::Load(Words(), bits));
  }
  // One load each: gathers take longer on most processors, and these have all bits of a vertex.
  HWY_INLINE LongWords words_at(WordVector byte) const {
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(bytes_);
    HWY_ALIGN std::uint32_t at[kWideChildren];
    hn::Store(byte, Words(), at);
    const auto two = [&](std::size_t i) {
      const auto low = _mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes + at[i]));
      const auto high = _mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes + at[i + 4]));
      return hn::Vec<Pairs>{_mm256_setr_m128i(low, high)};
    };
    const auto a = two(0), b = two(1), c = two(2), d = two(3);
    // Of each block of four words: 0 0 1 1, 2 2 3 3 of two lanes, and so on.
    const auto low_ab = hn::BitCast(Words(), hn::InterleaveLower(Pairs(), a, b));
    const auto low_cd = hn::BitCast(Words(), hn::InterleaveLower(Pairs(), c, d));
    const auto high_ab = hn::BitCast(Words(), hn::InterleaveUpper(Pairs(), a, b));
    const auto high_cd = hn::BitCast(Words(), hn::InterleaveUpper(Pairs(), c, d));
    return {{every_second<0>(low_ab, low_cd), every_second<1>(low_ab, low_cd),
             every_second<0>(high_ab, high_cd), every_second<1>(high_ab, high_cd)}};
  }
  // Within each block, words kFirst and kFirst + 2 of `a`, then of `b`.
  template <int kFirst>
  static HWY_INLINE WordVector every_second(WordVector a, WordVector b) {
    return WordVector{_mm256_castps_si256(
        _mm256_shuffle_ps(_mm256_castsi256_ps(a.raw), _mm256_castsi256_ps(b.raw),
                          _MM_SHUFFLE(kFirst + 2, kFirst, kFirst + 2, kFirst)))};
  }

  // The 32 bits from `bit` on of two words, `bit` at most 32. Shifts by 32 and more, which negative
  // numbers are here, give 0.
  static HWY_INLINE WordVector funnel(WordVector low, WordVector high, WordVector bit) {
    return hn::Or(hn::Shr(low, bit), hn::Shl(high, hn::Sub(small(32), bit)));
  }
  // The same of three words, `bit` at most 64.
  static HWY_INLINE WordVector funnel(WordVector low, WordVector middle, WordVector high,
                                      WordVector bit) {
    return hn::Or(funnel(low, middle, bit), funnel(middle, high, hn::Sub(bit, small(32))));
  }

  // The vertices of references `first` and on.
  template <Layout kLayout>
  HWY_INLINE void read_vertices(const Vertices& vertices, std::uint32_t first, FloatVector scale,
                                FloatVector (&out)[3]) {
    WordVector width[3];
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) width[k] = look_up(width_[k], vertices.group);
    const auto [word] = words_at(vertices.byte);
    const auto x = vertices.shift;
    const auto y = hn::Add(x, width[0]);
    const auto z = hn::Add(y, width[1]);
    WordVector stored[3];
    if constexpr (kLayout == Layout::kAny) {
      stored[0] = funnel(word[0], word[1], x);
      stored[1] = funnel(word[0], word[1], word[2], y);
      stored[2] = hn::Or(funnel(word[0], word[1], word[2], z),
                         funnel(word[2], word[3], hn::Sub(z, small(64))));
    } else {
      stored[0] = hn::Shr(word[0], x);
      stored[1] = funnel(word[0], word[1], y);
      stored[2] = kLayout == Layout::kLong ? funnel(word[1], word[2], hn::Sub(z, small(32)))
                                           : hn::Or(funnel(word[0], word[1], z),
                                                    hn::Shr(word[1], hn::Sub(z, small(32))));
    }
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto* const bases = reinterpret_cast<const std::uint8_t*>(bases_) + k * groups_;
      const auto base = look_up(hn::LoadDup128(Bytes(), bases), vertices.group);
      stored[k] = hn::Add(hn::And(stored[k], low_bits_of(width[k])),
                          hn::Add(shift_left(base, base_shift_[k]), hn::Load(Words(), origin_[k])));
    }
    if (view_.numbers == ClusterNumbers::kGrid) {
      HWY_UNROLL(3)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto whole = shift_left(stored[k], trailing_[k]);
        hn::Store(whole, Words(), number_[k] + first);
        out[k] = hn::Mul(hn::ConvertTo(Floats(), hn::BitCast(Integers(), whole)), scale);
      }
    } else {
      HWY_UNROLL(3)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto sign = hn::BroadcastSignBit(hn::BitCast(Integers(), stored[k]));
        const auto signs = hn::BitCast(Words(), sign);
        const auto magnitude = shift_left(hn::Xor(stored[k], signs), trailing_[k]);
        const auto bits = hn::Or(magnitude, hn::ShiftLeft<31>(signs));
        hn::Store(bits, Words(), number_[k] + first);
        out[k] = hn::Mul(hn::BitCast(Floats(), bits), scale);
      }
    }
  }

  // Any leaf: its triangles in the order of decoders of one leaf.
  template <std::size_t kStride>
  HWY_NOINLINE bool read_any(const Faces& faces, float scale, float (&out)[3][3][kStride]) {
    static_assert(kStride >= 2 * kLeafFaces);
    const FloatVector scales = hn::Set(Floats(), scale);
    const std::uint32_t is_new = faces.new_thirds | faces.new_others << kLeafFaces;
    const std::uint32_t count = kLeafFaces + faces.others;
    HWY_ALIGN float all[3][kReferences];
    auto corrupt = join_faces(faces).corrupt;
    Faces of_group = faces;
    for (std::uint32_t first = 0; first < count; first += kWideChildren) {
      const std::uint32_t here = (is_new >> first) & 0xffu;
      const auto before = static_cast<std::uint32_t>(std::popcount(is_new & ((1u << first) - 1)));
      // A window for each group: up to 8 references and the bits before them fit into it.
      static_assert(kWideChildren * (ClusterHeader::kMostOldBits + (1u << kOldWiderBits) - 1) + 7 <=
                    kWindowBits);
      const std::uint32_t place = faces.others + (first - before) * faces.old_bits;
      of_group.window = hn::LoadDup128(Bytes(), faces.bytes + place / 8);
      of_group.places_at = faces.others - place / 8 * 8;
      const Vertices vertices = find_vertices(of_group, lanes_with(small(here), kLaneBits),
                                              hn::Add(ranks(here), small(before)), first);
      FloatVector position[3];
      read_vertices<Layout::kAny>(vertices, first, scales, position);
      for (std::size_t k = 0; k < 3; ++k) hn::Store(position[k], Floats(), all[k] + first);
      corrupt = hn::Or(corrupt,
                       hn::IfThenElseZero(is_less(iota(), small(count - first)), vertices.corrupt));
    }
    if (!hn::AllTrue(Words(), hn::Eq(corrupt, hn::Zero(Words())))) return false;
    std::uint32_t fourth = kLeafFaces + 2 * faces.aparts;
    triangles_ = 0;
    for (std::uint32_t f = 0; f < kLeafFaces; ++f) {
      const std::uint32_t turn = step_[f] == StripStep::kApart ? 0 : step_[f] % 3;
      std::uint8_t corner[3];
      corner[turn] = static_cast<std::uint8_t>(corner_[0][f]);
      corner[(turn + 1) % 3] = static_cast<std::uint8_t>(corner_[1][f]);
      corner[(turn + 2) % 3] = static_cast<std::uint8_t>(f);
      const auto face = static_cast<std::uint8_t>(f);
      of_quads_[triangles_++] = {face, 0, {corner[0], corner[1], corner[2]}};
      if (((faces.quads >> f) & 1u) == 0) continue;
      of_quads_[triangles_++] = {
          face, 1, {corner[0], corner[2], static_cast<std::uint8_t>(fourth++)}};
    }
    for (std::uint32_t i = 0; i < triangles_; ++i) {
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t k = 0; k < 3; ++k) out[c][k][i] = all[k][of_quads_[i].reference[c]];
      }
    }
    return true;
  }

  const ClusterView& view_;
  const std::uint32_t quad_bytes_;  // that a leaf has in front of its other fields
  std::uint32_t cluster_number_ = kNone;
  const std::byte* bytes_ = nullptr;
  std::uint32_t size_ = 0;  // at which a leaf may begin
  std::uint32_t table_ = 0, entry_bits_ = 0;
  std::uint32_t start_bits_ = 0, starts_at_ = 0, start_slope_ = 0;
  std::uint32_t first_slope_ = 0, first_bias_ = 0;  // with 1 more
  std::uint32_t old_bits_ = 0;
  std::uint32_t groups_ = 0;
  const std::byte* bases_ = nullptr;
  std::uint32_t last_vertex_ = 0;
  std::uint32_t group_size_ = 0;
  std::uint32_t per_group_ = 0;  // 2^16 / group_size_, rounded up
  Layout layout_ = Layout::kAny;
  // Each in all lanes.
  HWY_ALIGN std::uint32_t origin_[3][kWideChildren];
  HWY_ALIGN std::uint32_t base_shift_[3][kWideChildren];
  HWY_ALIGN std::uint32_t trailing_[3][kWideChildren];
  // Of each group: the widths of offsets, the bits of a vertex, the byte of the cluster where it
  // starts.
  HWY_ALIGN std::uint8_t width_[3][ClusterHeader::kMostGroups];
  HWY_ALIGN std::uint8_t stride_[ClusterHeader::kMostGroups];
  HWY_ALIGN std::uint8_t start_low_[ClusterHeader::kMostGroups];
  HWY_ALIGN std::uint8_t start_high_[ClusterHeader::kMostGroups];
  std::uint32_t triangles_ = 0;  // of the last leaf; more than 8 if it has quads
  OfQuads of_quads_[2 * kLeafFaces];
  HWY_ALIGN std::uint32_t step_[kLeafFaces];        // to each face
  HWY_ALIGN std::uint32_t corner_[2][kLeafFaces];   // references of its first two corners
  HWY_ALIGN std::uint32_t number_[3][kReferences];  // [axis]: whole numbers, or bits of floats
};

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
