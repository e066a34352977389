// SPDX-License-Identifier: MIT
#include "runtime/walk/cluster_avx512.h"

#define HWY_WANT_AVX3_DL  // has the funnel shifts and expansions of VBMI2
#include "runtime/walk/targets.h"
// Not for walks by 512 bits without them.
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS BOXTREE_LEAF_DISABLED_TARGETS

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "runtime/walk/cluster_avx512.cpp"
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include "runtime/walk/cluster_groups-inl.h"
#include "runtime/walk/strip-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_AVX3_DL
using Sixteen = __m512i;

HWY_INLINE Sixteen load(const std::uint32_t (&row)[16]) {
  return _mm512_load_si512(row);
}
// A number in all lanes: from memory, where it costs nothing as an operand.
HWY_INLINE Sixteen every(const std::uint32_t& number) {
  return _mm512_set1_epi32(static_cast<std::int32_t>(number));
}
// The same; up to LaneConstants::kMost.
HWY_INLINE Sixteen every_small(std::uint32_t number) {
  return every(kLaneConstants.number[number]);
}
template <std::uint32_t kNumber>
HWY_INLINE Sixteen every_constant() {
  return every(lane_constant<kNumber>()[0]);
}
// Lane i: that of `row` which lane i of `group` names.
HWY_INLINE Sixteen look_up(const std::uint32_t (&row)[16], Sixteen group) {
  return _mm512_permutexvar_epi32(group, load(row));
}
alignas(64) constexpr std::uint32_t kIota[16] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                 8, 9, 10, 11, 12, 13, 14, 15};

HWY_NOINLINE bool find(const ClusterView& view, std::uint32_t number, Avx512Cluster& out) {
  Cluster cluster;
  GroupLanes groups;
  if (!find_cluster(view, number, out.leaves, cluster, groups)) return false;
  const ClusterHeaderView header = cluster.header();
  _mm512_store_si512(out.start, _mm512_cvtepu16_epi32(groups.start.raw));
  _mm512_store_si512(out.stride, _mm512_cvtepu8_epi32(groups.stride.raw));
  const auto two = hn::Add(groups.width[0], groups.width[1]);
  _mm512_store_si512(out.at[0], _mm512_cvtepu8_epi32(groups.width[0].raw));
  _mm512_store_si512(out.at[1], _mm512_cvtepu8_epi32(two.raw));
  constexpr std::uint8_t kMostBefore = 7;
  out.is_long = !is_zero(above(two, 63 - kMostBefore));
  HWY_UNROLL(3)
  for (std::size_t k = 0; k < 3; ++k) {
    out.trailing[k] = header.trailing(k);
    const Sixteen width = _mm512_cvtepu8_epi32(groups.width[k].raw);
    // A shift by 32 gives 0.
    const Sixteen ones = every(0xffffffffu);
    _mm512_store_si512(out.low_bits[k], _mm512_xor_si512(_mm512_sllv_epi32(ones, width), ones));
    const auto* const bases = cluster.bytes + cluster.bases_at + k * cluster.groups;
    const Sixteen base =
        _mm512_cvtepu8_epi32(_mm_loadu_si128(reinterpret_cast<const __m128i*>(bases)));
    const auto origin = boxtree::load<std::uint32_t>(cluster.bytes + sizeof(ClusterHeader), k);
    _mm512_store_si512(
        out.base[k],
        _mm512_add_epi32(_mm512_sll_epi32(base, _mm_cvtsi32_si128(header.base_shift(k))),
                         every(origin)));
  }
  return true;
}

// Words of 32 bits of sixteen words of 128 bits, the lowest first.
struct LongWords {
  Sixteen part[4];
};

// One load each: gathers take longer on most processors, and these have all bits of a vertex.
// `at`: memory through which `byte` gets into scalar registers. Without the fence, compilers would
// take lane by lane out of the vector, in more than twice as many instructions.
HWY_INLINE LongWords words_at(const std::byte* bytes, Sixteen byte, std::uint32_t (&at)[16]) {
  _mm256_store_si256(reinterpret_cast<__m256i*>(at), _mm512_castsi512_si256(byte));
  _mm256_store_si256(reinterpret_cast<__m256i*>(at + 8), _mm512_extracti64x4_epi64(byte, 1));
  HWY_FENCE;
  const auto one = [&](std::size_t i) {
    return _mm_loadu_si128(reinterpret_cast<const __m128i*>(bytes + at[i]));
  };
  // Copies that are masked need no port that moves lanes.
  const auto four = [&](std::size_t i) {
    const Sixteen first = _mm512_castsi128_si512(one(i));
    const Sixteen two = _mm512_mask_broadcast_i32x4(first, 0x00f0, one(i + 4));
    const Sixteen three = _mm512_mask_broadcast_i32x4(two, 0x0f00, one(i + 8));
    return _mm512_mask_broadcast_i32x4(three, 0xf000, one(i + 12));
  };
  const Sixteen a = four(0), b = four(1), c = four(2), d = four(3);
  const __m512 low_ab = _mm512_castsi512_ps(_mm512_unpacklo_epi64(a, b));
  const __m512 low_cd = _mm512_castsi512_ps(_mm512_unpacklo_epi64(c, d));
  const __m512 high_ab = _mm512_castsi512_ps(_mm512_unpackhi_epi64(a, b));
  const __m512 high_cd = _mm512_castsi512_ps(_mm512_unpackhi_epi64(c, d));
  constexpr int kEven = _MM_SHUFFLE(2, 0, 2, 0), kOdd = _MM_SHUFFLE(3, 1, 3, 1);
  return {{_mm512_castps_si512(_mm512_shuffle_ps(low_ab, low_cd, kEven)),
           _mm512_castps_si512(_mm512_shuffle_ps(low_ab, low_cd, kOdd)),
           _mm512_castps_si512(_mm512_shuffle_ps(high_ab, high_cd, kEven)),
           _mm512_castps_si512(_mm512_shuffle_ps(high_ab, high_cd, kOdd))}};
}

// The bits from `bit` on, below 64, and those after them.
struct TwoWords {
  Sixteen low, high;
};
HWY_INLINE TwoWords words_from(const LongWords& words, Sixteen bit) {
  const __mmask16 is_second = _mm512_cmpgt_epu32_mask(bit, every_constant<31>());
  return {_mm512_mask_mov_epi32(words.part[0], is_second, words.part[1]),
          _mm512_mask_mov_epi32(words.part[1], is_second, words.part[2])};
}

// Sixteen vertices of a cluster: their numbers to `number`, and where they are. `kIsLong`: whether
// Avx512Cluster::is_long may be set.
template <bool kIsLong>
HWY_INLINE void read_vertices(const ClusterView& view, Sixteen vertex, float scale,
                              Avx512Cluster& cluster, std::uint32_t* const (&number)[3],
                              __m512 (&position)[3]) {
  // Products below 2^16.
  const Sixteen group = _mm512_mulhi_epu16(vertex, every(cluster.leaves.per_group));
  const Sixteen in_group =
      _mm512_sub_epi32(vertex, _mm512_mullo_epi16(group, every(cluster.leaves.group_size)));
  const Sixteen bit = _mm512_mullo_epi16(in_group, look_up(cluster.stride, group));
  const LongWords words = words_at(
      cluster.leaves.bytes,
      _mm512_add_epi32(look_up(cluster.start, group), _mm512_srli_epi32(bit, 3)), cluster.byte);
  const Sixteen x = _mm512_and_si512(bit, every_constant<7>());
  const Sixteen y = _mm512_add_epi32(x, look_up(cluster.at[0], group));
  const Sixteen z = _mm512_add_epi32(x, look_up(cluster.at[1], group));
  const TwoWords of_y = words_from(words, y);
  TwoWords of_z = words_from(words, z);
  if constexpr (kIsLong) {
    const __mmask16 is_third = _mm512_cmpgt_epu32_mask(z, every_constant<63>());
    of_z = {_mm512_mask_mov_epi32(of_z.low, is_third, words.part[2]),
            _mm512_mask_mov_epi32(of_z.high, is_third, words.part[3])};
  }
  const Sixteen offset[3] = {_mm512_shrdv_epi32(words.part[0], words.part[1], x),
                             _mm512_shrdv_epi32(of_y.low, of_y.high, y),
                             _mm512_shrdv_epi32(of_z.low, of_z.high, z)};
  Sixteen stored[3];
  HWY_UNROLL(3)
  for (std::size_t k = 0; k < 3; ++k) {
    stored[k] = _mm512_add_epi32(_mm512_and_si512(offset[k], look_up(cluster.low_bits[k], group)),
                                 look_up(cluster.base[k], group));
  }
  if (view.numbers == ClusterNumbers::kGrid) {
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
      const Sixteen whole = _mm512_sllv_epi32(stored[k], every(cluster.trailing[k]));
      _mm512_store_si512(number[k], whole);
      position[k] = _mm512_cvtepi32_ps(whole);
    }
  } else {
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
      const Sixteen sign = _mm512_srai_epi32(stored[k], 31);
      const Sixteen magnitude =
          _mm512_sllv_epi32(_mm512_xor_si512(stored[k], sign), every(cluster.trailing[k]));
      const Sixteen bits =
          _mm512_or_si512(magnitude, _mm512_and_si512(sign, every_constant<0x80000000>()));
      _mm512_store_si512(number[k], bits);
      position[k] = _mm512_castsi512_ps(bits);
    }
  }
  HWY_UNROLL(3)
  for (std::size_t k = 0; k < 3; ++k) {
    position[k] = _mm512_mul_ps(position[k], _mm512_set1_ps(scale));
  }
}

// The bytes in which a field that begins at bit `place` is, as places in a window: the first three.
HWY_INLINE Sixteen bytes_of_fields(Sixteen place) {
  const Sixteen first_byte = _mm512_set4_epi32(0x0c0c0c0c, 0x08080808, 0x04040404, 0);
  return _mm512_add_epi32(_mm512_shuffle_epi8(_mm512_srli_epi32(place, 3), first_byte),
                          every_constant<0x80020100>());
}
// The fields, of `words` with these bytes.
HWY_INLINE Sixteen fields_of(Sixteen words, Sixteen place, std::uint32_t old_bits) {
  return _mm512_and_si512(_mm512_srlv_epi32(words, _mm512_and_si512(place, every_constant<7>())),
                          every(kLaneConstants.low_bits[old_bits]));
}

// The vertices of any sixteen references. Returns which are corrupt; those of no reference are any.
HWY_INLINE __mmask16 find_vertices(const LeafFields& faces, std::uint32_t last_vertex,
                                   Sixteen reference, Sixteen& vertex) {
  const Sixteen is_new = every(faces.new_thirds | faces.new_others << kLeafFaces);
  const Sixteen bit = _mm512_sllv_epi32(every_constant<1>(), reference);
  const Sixteen up_to = _mm512_or_si512(bit, _mm512_sub_epi32(bit, every_constant<1>()));
  const Sixteen news = _mm512_popcnt_epi32(_mm512_and_si512(is_new, up_to));
  const Sixteen place = _mm512_add_epi32(
      _mm512_mullo_epi16(_mm512_sub_epi32(reference, news), every_small(faces.old_bits)),
      every_small(faces.others));
  // One window for all fields of a leaf. The highest byte of what is looked up in it is any.
  constexpr std::size_t kWindowBytes = sizeof(Sixteen);
  static_assert(kMostLeafReferences *
                    (1 + ClusterHeader::kMostOldBits + (1u << kOldWiderBits) - 1) <=
                8 * kWindowBytes);
  static_assert(sizeof(faces.fields) + kLeafFaces / 8 + kWindowBytes <= kClusterPadding);
  const Sixteen window = _mm512_loadu_si512(faces.bytes);
  const Sixteen field =
      fields_of(_mm512_permutexvar_epi8(bytes_of_fields(place), window), place, faces.old_bits);
  const Sixteen found =
      _mm512_mask_add_epi32(_mm512_sub_epi32(every(faces.last), field),
                            _mm512_test_epi32_mask(is_new, bit), every(faces.before), news);
  vertex = _mm512_min_epu32(found, every(last_vertex));
  return _mm512_cmpneq_epu32_mask(found, vertex);
}

// The corners of all triangles, in the order of the source, from the references to them.
HWY_INLINE void join_triangles(std::uint32_t quads, const __m512 (&low)[3], const __m512 (&high)[3],
                               LeafTriangles& triangles, LeafCoordinates& out) {
  // A lane for each half that there is.
  constexpr std::uint32_t kFirstHalves = 0x5555;
  const auto is_there = static_cast<__mmask16>(kFirstHalves | _pdep_u32(quads, ~kFirstHalves));
  const Sixteen code = _mm512_maskz_compress_epi32(is_there, load(kIota));
  _mm_storeu_si128(reinterpret_cast<__m128i*>(triangles.code), _mm512_cvtepi32_epi8(code));
  triangles.count = kLeafFaces + static_cast<std::uint32_t>(std::popcount(quads));
  const __mmask16 is_second = _mm512_test_epi32_mask(code, every_constant<1>());
  const Sixteen face = _mm512_srli_epi32(code, 1);
  const auto look_up_eight = [](const std::uint32_t* row, Sixteen lane) {
    const auto eight = _mm256_load_si256(reinterpret_cast<const __m256i*>(row));
    return _mm512_permutexvar_epi32(lane, _mm512_castsi256_si512(eight));
  };
  // See LeafTriangles::find_corners().
  const Sixteen turn = look_up_eight(LeafTriangles::kTurn, look_up_eight(triangles.step, face));
  const Sixteen first = look_up_eight(triangles.corner[0], face);
  const Sixteen second = look_up_eight(triangles.corner[1], face);
  const __mmask16 by_one = _mm512_cmpeq_epi32_mask(turn, every_constant<1>());
  const __mmask16 by_two = _mm512_cmpeq_epi32_mask(turn, every_constant<2>());
  const auto turned = [&](Sixteen by_none, Sixteen if_one, Sixteen if_two) {
    return _mm512_mask_mov_epi32(_mm512_mask_mov_epi32(by_none, by_one, if_one), by_two, if_two);
  };
  const Sixteen third = turned(face, second, first);
  const Sixteen reference[3] = {
      turned(first, face, second),
      _mm512_mask_mov_epi32(turned(second, first, face), is_second, third),
      _mm512_mask_add_epi32(third, is_second, face, every_small(LeafTriangles::kFourths))};
  HWY_UNROLL(3)
  for (std::size_t c = 0; c < 3; ++c) {
    HWY_UNROLL(3)
    for (std::size_t k = 0; k < 3; ++k) {
      _mm512_storeu_ps(out[c][k], _mm512_permutex2var_ps(low[k], reference[c], high[k]));
    }
  }
}

// Any leaf: with quads, with most faces apart, with far more vertices of others than usual, or of a
// cluster whose offsets are wide.
HWY_NOINLINE bool read_any(const ClusterView& view, const LeafFields& faces, float scale,
                           Avx512Cluster& cluster, LeafTriangles& triangles, LeafCoordinates& out) {
  // References in the order of LeafTriangles::number.
  const Sixteen iota = load(kIota);
  const std::uint32_t apart_others = 2 * faces.aparts;
  const Sixteen fourths =
      _mm512_broadcast_i64x4(hn::Add(ranks(faces.quads), small(kLeafFaces - 1 + apart_others)).raw);
  const Sixteen reference[2] = {
      iota,
      _mm512_mask_mov_epi32(_mm512_add_epi32(iota, every_small(2 * kLeafFaces)), 0xff00, fourths)};
  const std::uint32_t of_faces = (1u << (kLeafFaces + apart_others)) - 1;
  const std::uint32_t wanted = of_faces | faces.quads << LeafTriangles::kFourths;
  std::uint32_t corrupt = 0;
  __m512 position[2][3];
  for (std::size_t part = 0; part < 2; ++part) {
    Sixteen vertex;
    const std::uint32_t first = static_cast<std::uint32_t>(16 * part);
    corrupt |= find_vertices(faces, cluster.leaves.last_vertex, reference[part], vertex) << first;
    read_vertices<true>(
        view, vertex, scale, cluster,
        {triangles.number[0] + first, triangles.number[1] + first, triangles.number[2] + first},
        position[part]);
  }
  const StripCorners corners = join_strip(hn::Set(Words(), faces.fields), triangles);
  join_triangles(faces.quads, position[0], position[1], triangles, out);
  return (corrupt & wanted) == 0 &&
         hn::AllTrue(Words(), hn::Eq(corners.corrupt, hn::Zero(Words())));
}

bool find_and_read(const ClusterView& view, std::uint32_t leaf, float scale, Avx512Cluster& cluster,
                   LeafTriangles& triangles, LeafCoordinates& out);

// Neighbours are read one after another, so the cluster is mostly the one of the last leaf.
bool read(const ClusterView& view, std::uint32_t leaf, float scale, Avx512Cluster& cluster,
          LeafTriangles& triangles, LeafCoordinates& out) {
  if (HWY_UNLIKELY(leaf / kClusterLeaves != cluster.leaves.cluster)) {
    return find_and_read(view, leaf, scale, cluster, triangles, out);
  }
  LeafFields faces;
  if (!cluster.leaves.find(leaf % kClusterLeaves, faces)) return false;
  if (HWY_UNLIKELY(!faces.is_usual || cluster.is_long)) {
    const LeafFields faces_copy = faces;  // so that the usual case may keep it in registers
    return read_any(view, faces_copy, scale, cluster, triangles, out);
  }
  triangles.count = kLeafFaces;

  // Which vertices references are to: new ones in a row, and others by their distance from the last
  // new one. Fields of those follow each other.
  const Sixteen iota = load(kIota);
  const auto is_new = static_cast<__mmask16>(faces.new_thirds | faces.new_others << kLeafFaces);
  const Sixteen place = _mm512_add_epi32(_mm512_mullo_epi16(iota, every_small(faces.old_bits)),
                                         every_small(faces.others));
  const Sixteen window =
      _mm512_broadcast_i32x4(_mm_loadu_si128(reinterpret_cast<const __m128i*>(faces.bytes)));
  const Sixteen field =
      fields_of(_mm512_shuffle_epi8(window, bytes_of_fields(place)), place, faces.old_bits);
  const Sixteen news =
      _mm512_maskz_expand_epi32(is_new, _mm512_add_epi32(iota, every(faces.before + 1)));
  const Sixteen vertex = _mm512_mask_expand_epi32(news, static_cast<__mmask16>(~is_new),
                                                  _mm512_sub_epi32(every(faces.last), field));
  const Sixteen inside = _mm512_min_epu32(vertex, every(cluster.leaves.last_vertex));
  const auto references = static_cast<__mmask16>((1u << (kLeafFaces + faces.others)) - 1);
  const __mmask16 corrupt = _mm512_mask_cmpneq_epu32_mask(references, vertex, inside);
  __m512 position[3];
  read_vertices<false>(view, inside, scale, cluster,
                       {triangles.number[0], triangles.number[1], triangles.number[2]}, position);

  // Corners of faces are references.
  const StripCorners corners = join_strip(hn::Set(Words(), faces.fields), triangles);
  const Sixteen both =
      _mm512_inserti64x4(_mm512_castsi256_si512(corners.first.raw), corners.second.raw, 1);
  HWY_UNROLL(3)
  for (std::size_t k = 0; k < 3; ++k) {
    const __m512 first_two = _mm512_permutexvar_ps(both, position[k]);
    _mm256_store_ps(out[0][k], _mm512_castps512_ps256(first_two));
    _mm256_store_ps(out[1][k], _mm512_extractf32x8_ps(first_two, 1));
    _mm256_store_ps(out[2][k], _mm512_castps512_ps256(position[k]));
  }
  return corrupt == 0 && hn::AllTrue(Words(), hn::Eq(corners.corrupt, hn::Zero(Words())));
}

HWY_NOINLINE bool find_and_read(const ClusterView& view, std::uint32_t leaf, float scale,
                                Avx512Cluster& cluster, LeafTriangles& triangles,
                                LeafCoordinates& out) {
  return find(view, leaf / kClusterLeaves, cluster) &&
         read(view, leaf, scale, cluster, triangles, out);
}

Avx512LeafReader reader() {
  return read;
}
#else
Avx512LeafReader reader() {
  return nullptr;
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "runtime/walk/dispatch.h"

namespace boxtree {
namespace {

BOXTREE_EXPORT(reader);

}  // namespace

Avx512LeafReader avx512_leaf_reader() noexcept {
  return BOXTREE_DISPATCH(reader)();
}

}  // namespace boxtree
#endif
