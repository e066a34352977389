// SPDX-License-Identifier: MIT
// Decodes full leaves from clusters, by vectors of eight lanes that can be permuted (of four for
// numbers of 64 bits, vertex by vertex): the same numbers as decode_cluster_leaf
// (format/cluster.cpp), which decodes any leaf; tree/plain_cluster.h does where vectors are
// shorter.
#if defined(BOXTREE_RUNTIME_WALK_CLUSTER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_WALK_CLUSTER_INL_H
#undef BOXTREE_RUNTIME_WALK_CLUSTER_INL_H
#else
#define BOXTREE_RUNTIME_WALK_CLUSTER_INL_H
#endif

#include <cstddef>

#include "format/cluster_leaf.h"
#include "runtime/tree/frame.h"
#include "runtime/tree/leaf_fields.h"
#include "runtime/walk/cluster_avx512.h"
#include "runtime/walk/cluster_groups-inl.h"
#include "runtime/walk/strip-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if BOXTREE_HAS_EIGHT_LANES

/// Reads leaves of one tree, one at a time.
class ClusterReader {
 public:
  /// `frame`, `doubles`: of numbers of 64 bits, whose positions go there.
  ClusterReader(const ClusterView& view, const Frame& frame, DoublePositions& doubles)
      : view_(view),
        frame_(frame),
        doubles_(doubles),
        leaves_(view),
        read_by_avx512_(view.bytes.empty() || view.numbers == ClusterNumbers::kF64
                            ? nullptr
                            : avx512_leaf_reader()),
        sixteen_(view) {}

  /// Decodes a leaf of 8 faces; coordinates are multiplied by `scale`, or those of 64 bits placed
  /// in tree space and rounded. Corners of leaves without
  /// quads are those of the source but for a turn, which LeafTriangles::read_corners() undoes.
  /// False when its bytes are corrupt, or when decode_cluster_leaf has to read it.
  HWY_INLINE bool read(std::uint32_t leaf, float scale, LeafTriangles& triangles,
                       LeafCoordinates& out) {
    if (!enter(leaf / kClusterLeaves)) return false;
    LeafFields faces;
    if (!leaves_.find(leaf % kClusterLeaves, faces)) return false;
    if (HWY_UNLIKELY(!faces.is_usual)) {
      const LeafFields faces_copy = faces;  // so that the usual case may keep it in registers
      return read_any(faces_copy, scale, triangles, out);
    }
    triangles.count = kLeafFaces;
    const WordVector fields = set(faces.fields);
    const Olds olds{window_at(faces.bytes), faces.others};
    const Vertices thirds =
        find_vertices(faces, olds, lanes_with(fields, kThirdBits), ranks(faces.new_thirds), iota());
    const auto new_thirds = static_cast<std::uint32_t>(std::popcount(faces.new_thirds));
    const std::uint32_t new_aparts = faces.new_others & 0xffu;
    const Vertices aparts =
        find_vertices(faces, olds, lanes_with(small(new_aparts), kLaneBits),
                      hn::Add(ranks(new_aparts), small(new_thirds)), hn::Iota(Words(), kLeafFaces));
    const FloatVector scales = hn::Set(Floats(), scale);
    FloatVector third[3], apart[3];
    bool are_read = true;
    if (HWY_LIKELY(is_narrow_)) {
      read_vertices<true>(thirds, 0, scales, triangles, third);
      read_vertices<true>(aparts, kLeafFaces, scales, triangles, apart);
    } else if (view_.numbers == ClusterNumbers::kF64) {
      are_read =
          read_double_vertices(thirds, 0xff, 0, triangles, third) &&
          read_double_vertices(aparts, (1u << 2 * faces.aparts) - 1, kLeafFaces, triangles, apart);
    } else {
      read_wide_vertices(thirds, 0, scales, triangles, third);
      read_wide_vertices(aparts, kLeafFaces, scales, triangles, apart);
    }
    auto corrupt =
        hn::Or(thirds.corrupt,
               hn::IfThenElseZero(is_less(iota(), small(2 * faces.aparts)), aparts.corrupt));
    const StripCorners corners = join_strip(fields, triangles);
    corrupt = hn::Or(corrupt, corners.corrupt);
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) hn::Store(third[k], Floats(), out[2][k]);
    const TwoVectorLanes first(corners.first), second(corners.second);
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
      hn::Store(first.look_up(third[k], apart[k]), Floats(), out[0][k]);
      hn::Store(second.look_up(third[k], apart[k]), Floats(), out[1][k]);
    }
    return are_read && hn::AllTrue(Words(), hn::Eq(corrupt, hn::Zero(Words())));
  }

  /// The numbers of all corners, [corner][axis][triangle], in the order of the source.
  static HWY_INLINE void find_numbers(const LeafTriangles& triangles,
                                      std::uint32_t (&out)[3][3][kMaxLeafTriangles]) {
    const FaceCorners corners(triangles);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto* const numbers = reinterpret_cast<const float*>(triangles.number[k]);
      FloatVector group[4];
      for (std::size_t g = 0; g < 4; ++g) group[g] = hn::Load(Floats(), numbers + g * kLeafFaces);
      corners.spread(group, reinterpret_cast<float*>(out[0][k]),
                     reinterpret_cast<float*>(out[1][k]), reinterpret_cast<float*>(out[2][k]));
    }
  }

  [[nodiscard]] HWY_INLINE bool has_avx512() const { return read_by_avx512_ != nullptr; }
  /// The same where the machine has AVX-512. False also where read() has to do it.
  HWY_INLINE bool read_by_avx512(std::uint32_t leaf, float scale, LeafTriangles& triangles,
                                 LeafCoordinates& out) {
    return has_avx512() && read_by_avx512_(view_, leaf, scale, sixteen_, triangles, out);
  }

 private:
  // References that are not new.
  struct Olds {
    hn::Vec<Bytes> window;  // 16 bytes with their fields, in each half
    std::uint32_t at;       // bit of these where the first of them begins
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

  HWY_ALIGN static constexpr std::uint32_t kThirdBits[kWideChildren] = {
      1u << 21, 1u << 22, 1u << 23, 1u << 24, 1u << 25, 1u << 26, 1u << 27, 1u << 28};
  static_assert(kThirdBits[0] == 1u << kLeafStepBits);
  HWY_ALIGN static constexpr std::uint32_t kLaneBits[kWideChildren] = {1, 2, 4, 8, 16, 32, 64, 128};

  // Finds the cluster that the last leaf was in at once: neighbours are read one after another.
  HWY_INLINE bool enter(std::uint32_t number) {
    if (HWY_LIKELY(number == leaves_.cluster)) return true;
    return find(number);
  }

  HWY_NOINLINE bool find(std::uint32_t number) {
    Cluster cluster;
    GroupLanes groups;
    if (!find_cluster(view_, number, leaves_, cluster, groups)) return false;
    set_groups(groups);
    bases_ = cluster.bytes + cluster.bases_at;
    groups_ = cluster.groups;
    if (view_.numbers == ClusterNumbers::kF64) {
      set_axes_of_groups(groups);
      is_narrow_ = false;
      return true;
    }
    const ClusterHeaderView header = cluster.header();
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
      hn::Store(set(header.trailing(k)), Words(), trailing_[k]);
      hn::Store(set(header.base_shift(k)), Words(), base_shift_[k]);
      const auto origin = boxtree::load<std::uint32_t>(cluster.bytes + sizeof(ClusterHeader), k);
      hn::Store(set(origin), Words(), origin_[k]);
    }
    return true;
  }

  HWY_INLINE void set_groups(const GroupLanes& groups) {
    const GroupBytes bytes;
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) hn::Store(groups.width[k], bytes, width_[k]);
    hn::Store(groups.stride, bytes, stride_);
    hn::Store(pack(hn::And(groups.start, hn::Set(Halves(), 0xff))), bytes, start_low_);
    hn::Store(pack(hn::ShiftRight<8>(groups.start)), bytes, start_high_);
    // With up to 7 bits before.
    constexpr std::uint8_t kMostOfX = 25, kMostOfTwo = kMostBitsRead;
    is_narrow_ = is_zero(hn::Or(above(groups.width[0], kMostOfX),
                                above(hn::Add(groups.width[0], groups.width[1]), kMostOfTwo)));
  }
  // Of numbers of 64 bits.
  HWY_INLINE void set_axes_of_groups(const GroupLanes& groups) {
    const GroupBytes bytes;
    // Bits of a vertex before each axis.
    const auto z = hn::Add(groups.width[0], groups.width[1]);
    interleave(hn::Zero(bytes), groups.width[0], z, axes_[0]);
    interleave(groups.width[0], groups.width[1], groups.width[2], axes_[1]);
    const auto widest = hn::Max(hn::Max(groups.width[0], groups.width[1]), groups.width[2]);
    is_one_load_ = is_zero(above(widest, kMostBitsRead));
    const auto* const bases = reinterpret_cast<const std::uint8_t*>(bases_);
    interleave(hn::LoadU(bytes, bases), hn::LoadU(bytes, bases + groups_),
               hn::LoadU(bytes, bases + std::size_t{2} * groups_), axes_[2]);
  }
  // x, y and z of each group, and 0.
  static HWY_INLINE void interleave(GroupByteVector x, GroupByteVector y, GroupByteVector z,
                                    std::uint8_t (&out)[ClusterHeader::kMostGroups][4]) {
    const GroupBytes d;
    const hn::Repartition<std::uint16_t, GroupBytes> pairs;
    const auto zero = hn::Zero(d);
    const auto xy_low = hn::BitCast(pairs, hn::InterleaveLower(d, x, y));
    const auto xy_high = hn::BitCast(pairs, hn::InterleaveUpper(d, x, y));
    const auto z_low = hn::BitCast(pairs, hn::InterleaveLower(d, z, zero));
    const auto z_high = hn::BitCast(pairs, hn::InterleaveUpper(d, z, zero));
    hn::Store(hn::BitCast(d, hn::InterleaveLower(pairs, xy_low, z_low)), d, out[0]);
    hn::Store(hn::BitCast(d, hn::InterleaveUpper(pairs, xy_low, z_low)), d, out[4]);
    hn::Store(hn::BitCast(d, hn::InterleaveLower(pairs, xy_high, z_high)), d, out[8]);
    hn::Store(hn::BitCast(d, hn::InterleaveUpper(pairs, xy_high, z_high)), d, out[12]);
  }
  static HWY_INLINE hn::Vec128<std::uint8_t> pack(hn::Vec<Halves> halves) {
    return hn::Vec128<std::uint8_t>{_mm_packus_epi16(_mm256_castsi256_si128(halves.raw),
                                                     _mm256_extracti128_si256(halves.raw, 1))};
  }

  // Lanes of two vectors in a row.
  struct TwoVectorLanes {
    explicit HWY_INLINE TwoVectorLanes(WordVector number)
        : lanes(number),
          is_high(hn::RebindMask(Floats(), is_less(constant<kWideChildren - 1>(), number))) {}
    [[nodiscard]] HWY_INLINE FloatVector look_up(FloatVector low, FloatVector high) const {
      return hn::IfThenElse(is_high, permute(high, lanes), permute(low, lanes));
    }
    WordVector lanes;
    hn::Mask<Floats> is_high;
  };
  // The corners of faces among references, in the order of the source, and the lanes of triangles
  // among faces.
  class FaceCorners {
   public:
    explicit HWY_NOINLINE FaceCorners(const LeafTriangles& triangles)
        : first_(hn::Load(Words(), triangles.corner[0])),
          second_(hn::Load(Words(), triangles.corner[1])),
          has_quads_(triangles.count != kLeafFaces) {
      const auto turn =
          permute(hn::Load(Words(), LeafTriangles::kTurn), hn::Load(Words(), triangles.step));
      by_one_ = hn::RebindMask(Floats(), hn::Eq(turn, small(1)));
      by_two_ = hn::RebindMask(Floats(), hn::Eq(turn, small(2)));
      if (!has_quads_) return;
      for (std::size_t part = 0; part < 2; ++part) {
        const hn::Rebind<std::uint8_t, Words> bytes;
        const auto code =
            hn::PromoteTo(Words(), hn::LoadU(bytes, triangles.code + part * kLeafFaces));
        face_[part] = hn::ShiftRight<1>(code);
        is_half_[part] = hn::RebindMask(Floats(), hn::TestBit(code, small(1)));
      }
    }

    // One axis: `group` has the references, eight by eight, the fourth corners last. Not inlined,
    // for size.
    HWY_NOINLINE void spread(const FloatVector (&group)[4], float* out_0, float* out_1,
                             float* out_2) const {
      const auto first = with_third_group(first_, group);
      const auto second = with_third_group(second_, group);
      const auto third = group[0];
      const auto corner_0 = hn::IfThenElse(by_one_, third, hn::IfThenElse(by_two_, second, first));
      const auto corner_1 = hn::IfThenElse(by_one_, first, hn::IfThenElse(by_two_, third, second));
      const auto corner_2 = hn::IfThenElse(by_one_, second, hn::IfThenElse(by_two_, first, third));
      const Floats d;
      if (!has_quads_) {
        hn::Store(corner_0, d, out_0);
        hn::Store(corner_1, d, out_1);
        hn::Store(corner_2, d, out_2);
        return;
      }
      for (std::size_t part = 0; part < 2; ++part) {
        const WordVector lanes = face_[part];
        const auto middle = permute(corner_2, lanes);
        const std::size_t at = part * kLeafFaces;
        hn::Store(permute(corner_0, lanes), d, out_0 + at);
        hn::Store(hn::IfThenElse(is_half_[part], middle, permute(corner_1, lanes)), d, out_1 + at);
        hn::Store(hn::IfThenElse(is_half_[part], permute(group[3], lanes), middle), d, out_2 + at);
      }
    }

   private:
    static HWY_INLINE FloatVector with_third_group(const TwoVectorLanes& reference,
                                                   const FloatVector (&group)[4]) {
      const auto is_third =
          hn::RebindMask(Floats(), is_less(small(2 * kLeafFaces - 1), reference.lanes));
      return hn::IfThenElse(is_third, permute(group[2], reference.lanes),
                            reference.look_up(group[0], group[1]));
    }

    TwoVectorLanes first_, second_;
    bool has_quads_;
    hn::Mask<Floats> by_one_, by_two_;
    WordVector face_[2];
    hn::Mask<Floats> is_half_[2];
  };

  // The byte of a table that each lane of `group` names.
  static HWY_INLINE WordVector look_up(hn::Vec<Bytes> table, WordVector group) {
    return hn::BitCast(Words(), hn::TableLookupBytes(table, hn::BitCast(Bytes(), group)));
  }
  static HWY_INLINE WordVector look_up(const std::uint8_t (&table)[ClusterHeader::kMostGroups],
                                       WordVector group) {
    return look_up(hn::LoadDup128(Bytes(), table), group);
  }

  static HWY_INLINE hn::Vec<Bytes> window_at(const std::byte* bytes) {
    return hn::LoadDup128(Bytes(), reinterpret_cast<const std::uint8_t*>(bytes));
  }

  // The vertices of eight references. `rank`: how many references up to each are new.
  HWY_INLINE Vertices find_vertices(const LeafFields& faces, const Olds& olds, WordMask is_new,
                                    WordVector rank, WordVector reference) const {
    // Those that are not new have their fields one after another, each in up to three bytes.
    HWY_ALIGN static constexpr std::uint8_t kFirstByte[32] = {
        0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12,
        0, 0, 0, 0, 4, 4, 4, 4, 8, 8, 8, 8, 12, 12, 12, 12};
    const auto old = hn::Sub(reference, rank);
    const auto place = hn::Add(multiply(old, small(faces.old_bits)), set(olds.at));
    const auto byte = hn::TableLookupBytes(hn::BitCast(Bytes(), hn::ShiftRight<3>(place)),
                                           hn::Load(Bytes(), kFirstByte));
    const auto three = hn::Add(hn::BitCast(Words(), byte), constant<kThreeBytes>());
    const auto field = hn::And(
        hn::Shr(
            hn::BitCast(Words(), hn::TableLookupBytes(olds.window, hn::BitCast(Bytes(), three))),
            hn::And(place, constant<7>())),
        set(kLaneConstants.low_bits[faces.old_bits]));
    const auto number =
        hn::IfThenElse(is_new, hn::Add(set(faces.before), rank), hn::Sub(set(faces.last), field));
    const auto inside = hn::Min(number, set(leaves_.last_vertex));
    const auto group = hn::BitCast(
        Words(),
        hn::MulHigh(hn::BitCast(Halves(), inside), hn::BitCast(Halves(), set(leaves_.per_group))));
    const auto in_group = hn::Sub(inside, multiply(group, set(leaves_.group_size)));
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
    const auto* const bytes = reinterpret_cast<const std::uint8_t*>(leaves_.bytes);
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
  template <bool kIsNarrow>
  HWY_INLINE void read_vertices(const Vertices& vertices, std::uint32_t first, FloatVector scale,
                                LeafTriangles& triangles, FloatVector (&out)[3]) {
    WordVector width[3];
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) width[k] = look_up(width_[k], vertices.group);
    const auto [word] = words_at(vertices.byte);
    const auto x = vertices.shift;
    const auto y = hn::Add(x, width[0]);
    const auto z = hn::Add(y, width[1]);
    WordVector stored[3];
    if constexpr (!kIsNarrow) {
      stored[0] = funnel(word[0], word[1], x);
      stored[1] = funnel(word[0], word[1], word[2], y);
      stored[2] = hn::Or(funnel(word[0], word[1], word[2], z),
                         funnel(word[2], word[3], hn::Sub(z, small(64))));
    } else {
      stored[0] = hn::Shr(word[0], x);
      stored[1] = funnel(word[0], word[1], y);
      const auto is_second = is_less(constant<31>(), z);
      const auto first_bit = hn::IfThenElseZero(is_second, small(32));
      stored[2] = funnel(hn::IfThenElse(is_second, word[1], word[0]),
                         hn::IfThenElse(is_second, word[2], word[1]), hn::Sub(z, first_bit));
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
        hn::Store(whole, Words(), triangles.number[k] + first);
        out[k] = hn::Mul(hn::ConvertTo(Floats(), hn::BitCast(Integers(), whole)), scale);
      }
    } else {
      HWY_UNROLL(3)
      for (std::size_t k = 0; k < 3; ++k) {
        const auto sign = hn::BroadcastSignBit(hn::BitCast(Integers(), stored[k]));
        const auto signs = hn::BitCast(Words(), sign);
        const auto magnitude = shift_left(hn::Xor(stored[k], signs), trailing_[k]);
        const auto bits = hn::Or(magnitude, hn::ShiftLeft<31>(signs));
        hn::Store(bits, Words(), triangles.number[k] + first);
        out[k] = hn::Mul(hn::BitCast(Floats(), bits), scale);
      }
    }
  }

  // Not inlined, for size.
  HWY_NOINLINE void read_wide_vertices(const Vertices& vertices, std::uint32_t first,
                                       FloatVector scale, LeafTriangles& triangles,
                                       FloatVector (&out)[3]) {
    read_vertices<false>(vertices, first, scale, triangles, out);
  }

  // Numbers of 64 bits, a lane for each axis.
  using Longs = hn::FixedTag<std::uint64_t, 4>;
  using LongVector = hn::Vec<Longs>;

  static HWY_INLINE LongVector widened(const void* four_bytes) {
    return LongVector{_mm256_cvtepu8_epi64(
        _mm_cvtsi32_si128(boxtree::load<std::int32_t>(static_cast<const std::byte*>(four_bytes))))};
  }

  // The eight bytes at a place, at `y` and at `z`. One load each, as of words_at().
  static HWY_INLINE LongVector longs_at(const std::byte* at, std::uint32_t y, std::uint32_t z) {
    const auto x_y = _mm_loadh_pd(_mm_load_sd(reinterpret_cast<const double*>(at)),
                                  reinterpret_cast<const double*>(at + y));
    const auto only_z = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(at + z));
    return LongVector{_mm256_setr_m128i(_mm_castpd_si128(x_y), only_z)};
  }

  // Those of the vertices of references `first` and on that are `wanted`, of numbers of 64 bits.
  // False where a coordinate is out of range.
  HWY_NOINLINE bool read_double_vertices(const Vertices& vertices, std::uint32_t wanted,
                                         std::uint32_t first, LeafTriangles& triangles,
                                         FloatVector (&out)[3]) {
    HWY_ALIGN std::uint32_t group[kWideChildren], byte[kWideChildren], shift[kWideChildren];
    hn::Store(vertices.group, Words(), group);
    hn::Store(vertices.byte, Words(), byte);
    hn::Store(vertices.shift, Words(), shift);
    const Longs d;
    const hn::FixedTag<std::int64_t, 4> integers;
    const hn::FixedTag<double, 4> doubles;
    const std::byte* const header = leaves_.bytes;
    const auto trailing = widened(header + offsetof(ClusterHeader, trailing));
    const auto base_shift = widened(header + offsetof(ClusterHeader, base_shift));
    const auto least =
        hn::LoadU(d, reinterpret_cast<const std::uint64_t*>(header + sizeof(ClusterHeader)));
    const auto origin = hn::LoadU(doubles, frame_.origin_lanes.lane.data());
    const auto scale = hn::Set(doubles, frame_.inverse_scale);
    auto is_within = hn::Eq(scale, scale);
    for (; wanted != 0; wanted &= wanted - 1) {
      const auto i = static_cast<std::uint32_t>(std::countr_zero(wanted));
      const std::uint32_t g = group[i] & (ClusterHeader::kMostGroups - 1);
      const auto width = widened(axes_[1][g]);
      const auto bit = hn::Add(hn::Set(d, shift[i]), widened(axes_[0][g]));
      const std::byte* const at = leaves_.bytes + byte[i];
      const auto in_byte = hn::And(bit, hn::Set(d, 7));
      const std::uint32_t y = (shift[i] + axes_[0][g][1]) / 8, z = (shift[i] + axes_[0][g][2]) / 8;
      auto bits = hn::Shr(longs_at(at, y, z), in_byte);
      if (!is_one_load_) {
        const auto high = longs_at(at + sizeof(std::uint64_t), y, z);
        bits = hn::Or(bits, hn::Shl(high, hn::Sub(hn::Set(d, 64), in_byte)));  // 0 by 64
      }
      const auto field = hn::AndNot(hn::Shl(hn::Set(d, ~std::uint64_t{0}), width), bits);
      const auto number = hn::Add(hn::Add(field, least), hn::Shl(widened(axes_[2][g]), base_shift));
      // See double_of_number.
      const auto signs = hn::BitCast(d, hn::BroadcastSignBit(hn::BitCast(integers, number)));
      const auto magnitude = hn::Shl(hn::Xor(number, signs), trailing);
      const auto stored = hn::BitCast(doubles, hn::Or(magnitude, hn::ShiftLeft<63>(signs)));
      const auto position = hn::Mul(hn::Sub(stored, origin), scale);
      is_within = hn::And(is_within, hn::Le(hn::Abs(position), hn::Set(doubles, kMaxCoordinate)));
      hn::Store(position, doubles, doubles_[first + i]);
      const hn::FixedTag<float, 4> floats;
      const auto rounded =
          hn::BitCast(hn::FixedTag<std::uint32_t, 4>(), hn::DemoteTo(floats, position));
      triangles.number[0][first + i] = hn::ExtractLane(rounded, 0);
      triangles.number[1][first + i] = hn::ExtractLane(rounded, 1);
      triangles.number[2][first + i] = hn::ExtractLane(rounded, 2);
    }
    for (std::size_t k = 0; k < 3; ++k) {
      out[k] = hn::Load(Floats(), reinterpret_cast<const float*>(triangles.number[k] + first));
    }
    return hn::AllTrue(doubles, hn::Or(is_within, hn::Not(hn::FirstN(doubles, 3))));
  }

  // Any leaf: with quads, with most faces apart, or with far more vertices of others than usual.
  HWY_NOINLINE bool read_any(const LeafFields& faces, float scale, LeafTriangles& triangles,
                             LeafCoordinates& out) {
    const FloatVector scales = hn::Set(Floats(), scale);
    const std::uint32_t is_new = faces.new_thirds | faces.new_others << kLeafFaces;
    auto corrupt = join_strip(set(faces.fields), triangles).corrupt;
    bool are_read = true;
    // References from `first` on, of which lane i gets number `slot`, to numbers from `at` on.
    // Lanes that are not `wanted` get any vertex of the cluster.
    const auto read_group = [&](std::uint32_t first, WordVector slot, WordMask wanted,
                                std::uint32_t at, FloatVector(&position)[3]) {
      const std::uint32_t here = (is_new >> first) & 0xffu;
      const auto before = static_cast<std::uint32_t>(std::popcount(is_new & ((1u << first) - 1)));
      // A window for each group: up to 8 references and the bits before them fit into it.
      static_assert(kWideChildren * (ClusterHeader::kMostOldBits + (1u << kOldWiderBits) - 1) + 7 <=
                    LeafFields::kWindowBits);
      const std::uint32_t place = faces.others + (first - before) * faces.old_bits;
      const Olds olds{window_at(faces.bytes + place / 8), faces.others - place / 8 * 8};
      const Vertices vertices = find_vertices(
          faces, olds, hn::TestBit(hn::Shr(small(here), slot), small(1)),
          hn::Add(permute(ranks(here), slot), small(before)), hn::Add(slot, small(first)));
      corrupt = hn::Or(corrupt, hn::IfThenElseZero(wanted, vertices.corrupt));
      if (view_.numbers != ClusterNumbers::kF64) {
        read_wide_vertices(vertices, at, scales, triangles, position);
      } else if (!read_double_vertices(vertices, bits_of_words(wanted), at, triangles, position)) {
        are_read = false;
      }
    };
    const std::uint32_t apart_others = 2 * faces.aparts;
    FloatVector group[4][3];
    read_group(0, iota(), is_less(iota(), small(kLeafFaces)), 0, group[0]);
    read_group(kLeafFaces, iota(), is_less(iota(), small(apart_others)), kLeafFaces, group[1]);
    const bool has_more = apart_others > kLeafFaces;
    if (has_more) {
      read_group(2 * kLeafFaces, iota(), is_less(iota(), small(apart_others - kLeafFaces)),
                 2 * kLeafFaces, group[2]);
    }
    if (faces.quads != 0) {
      const auto slot = hn::Sub(ranks(faces.quads), small(1));
      read_group(kLeafFaces + apart_others, slot, lanes_with(small(faces.quads), kLaneBits),
                 LeafTriangles::kFourths, group[3]);
    }
    if (!are_read || !hn::AllTrue(Words(), hn::Eq(corrupt, hn::Zero(Words())))) return false;
    triangles.name_lanes(faces.quads);
    const FaceCorners corners(triangles);
    for (std::size_t k = 0; k < 3; ++k) {
      const FloatVector of_axis[4] = {group[0][k], group[1][k], group[has_more ? 2 : 1][k],
                                      group[faces.quads != 0 ? 3 : 0][k]};
      corners.spread(of_axis, out[0][k], out[1][k], out[2][k]);
    }
    return true;
  }

  const ClusterView& view_;
  const Frame& frame_;
  DoublePositions& doubles_;
  LeafTable leaves_;
  const Avx512LeafReader read_by_avx512_;  // null where the machine has none
  std::uint32_t groups_ = 0;
  const std::byte* bases_ = nullptr;
  bool is_narrow_ = false;    // offsets of x and y end in the first 32 and 64 bits of a vertex
  bool is_one_load_ = false;  // offsets of 64 bits take no more than kMostBitsRead
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
  // Of numbers of 64 bits: bits before, widths and bases of x, y and z.
  HWY_ALIGN std::uint8_t axes_[3][ClusterHeader::kMostGroups][4];
  Avx512Cluster sixteen_;
};

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
