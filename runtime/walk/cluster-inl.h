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

#include "format/cluster_leaf.h"
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

  /// Decodes a leaf of 8 triangles, with coordinates as floats times `scale`. False when its bytes
  /// are corrupt.
  HWY_INLINE bool read(std::uint32_t leaf, float scale) {
    if (!enter(leaf / kClusterLeaves)) return false;
    self_ = leaf % kClusterLeaves;
    std::uint64_t at = 0;
    return read_references(at) && read_vertices(at, scale);
  }

  /// Corner `corner` of lane `lane`: steps of the grid, or the floats of the source.
  [[nodiscard]] HWY_INLINE std::array<double, 3> position(std::uint32_t lane,
                                                          std::size_t corner) const {
    const std::size_t v = (corners_[lane] >> (8 * corner)) & 0xffu;
    if (view_.numbers == ClusterNumbers::kGrid) {
      return {static_cast<double>(static_cast<std::int32_t>(number_[0][v])),
              static_cast<double>(static_cast<std::int32_t>(number_[1][v])),
              static_cast<double>(static_cast<std::int32_t>(number_[2][v]))};
    }
    return {double{std::bit_cast<float>(number_[0][v])},
            double{std::bit_cast<float>(number_[1][v])},
            double{std::bit_cast<float>(number_[2][v])}};
  }

  /// Coordinates of corner `corner` of the eight triangles, [axis].
  HWY_INLINE void coordinates(std::size_t corner, FloatVector (&out)[3]) const {
    const auto corners = hn::Load(Words(), corners_);
    const auto vertex =
        hn::And(hn::ShiftRightSame(corners, static_cast<int>(8 * corner)), hn::Set(Words(), 0xffu));
    look_up(vertex, out);
  }

 private:
  using Words = hn::Rebind<std::uint32_t, Floats>;
  using Integers = hn::Rebind<std::int32_t, Floats>;
  using WordVector = hn::Vec<Words>;
  // A full leaf of triangles names at most three vertices a face.
  static constexpr std::size_t kMostVertices = std::size_t{3} * kLeafFaces;
  static constexpr std::uint32_t kNone = 0xffffffffu;

  // Constants of the cluster that the last leaf was in: neighbours are read one after another.
  HWY_INLINE bool enter(std::uint32_t number) {
    if (number == cluster_number_) return true;
    cluster_number_ = kNone;
    if (!find_cluster(view_, number, cluster_)) return false;
    const ClusterHeader& header = cluster_.header;
    // Bits fit into 32 bits; corrupt places beyond that are not in any cluster.
    constexpr std::uint64_t kMostBytes = 1u << 28;
    most_bits_ = static_cast<std::uint32_t>(std::min(cluster_.size, kMostBytes)) * 8;
    start_mask_ = (1u << header.start_bits) - 1;
    own_mask_ = (1u << header.own_bits) - 1;
    is_narrow_ = true;
    has_trailing_ = false;
    for (std::size_t k = 0; k < 3; ++k) {
      base_mask_[k] = (1u << header.base_bits[k]) - 1;
      wider_mask_[k] = (1u << header.wider_bits[k]) - 1;
      width_[k] = header.width[k];
      origin_[k] = static_cast<std::uint32_t>(cluster_.origin[k]);
      // A word of 32 bits at the byte of a field has 25 of its bits or more.
      is_narrow_ &= width_[k] + wider_mask_[k] <= 25;
      has_trailing_ |= header.trailing[k] != 0;
    }
    cluster_number_ = number;
    return true;
  }

  // Which vertices the references name, which of them the leaf stores, and the faces. `at`: bit of
  // the first field after them.
  HWY_INLINE bool read_references(std::uint64_t& at) {
    const ClusterHeader& header = cluster_.header;
    const std::byte* const bytes = cluster_.bytes;
    const std::uint64_t start =
        read_bits(bytes, cluster_.table + self_ * cluster_.entry_bits, header.start_bits);
    const std::uint64_t middle = cluster_.leaves_at + self_ * header.leaf_bytes + start;
    if (middle * 8 > most_bits_) return false;
    const auto fields = load<std::uint64_t>(bytes + middle);
    constexpr std::uint32_t kStepBits = StripStep::kBits * (kLeafFaces - 1);
    constexpr std::uint32_t kEachStep = 0x49249u;  // the first bit of each
    References references;
    references.steps = static_cast<std::uint32_t>(fields) & ((1u << kStepBits) - 1);
    const std::uint32_t apart =  // steps 6 and 7
        (references.steps >> 1) & (references.steps >> 2) & kEachStep;
    if ((apart & references.steps) != 0) return false;
    references.count = 3 + (kLeafFaces - 1) + 2 * static_cast<std::uint32_t>(std::popcount(apart));
    references.firsts =
        static_cast<std::uint32_t>((fields >> kStepBits) & low_bits(references.count - 1)) << 1 |
        1u;
    vertices_ = static_cast<std::uint32_t>(std::popcount(references.firsts));
    at = middle * 8 + kStepBits + references.count - 1;
    own_ = static_cast<std::uint32_t>(read_bits(bytes, at, vertices_));
    at += vertices_;
    references.width = width_below(vertices_);
    references.at = at;
    const std::uint32_t bits = (references.count - vertices_) * references.width;
    at += bits;
    if (HWY_LIKELY(references.count <= 2 * kWideChildren && bits <= 25)) {
      return join_faces_by_lanes(references);
    }
    return join_faces(references);
  }

  struct References {
    std::uint32_t steps = 0;
    std::uint32_t count = 0;
    std::uint32_t firsts = 0;  // bit r: reference r is the first to its vertex in the leaf
    std::uint32_t width = 0;   // of the number of the vertex that another leads to
    std::uint64_t at = 0;      // bit of these numbers
  };

  static constexpr std::uint64_t kEachByte = 0x0101010101010101u;

  // Byte i: how many of bits 0 to i are set.
  static HWY_INLINE std::uint64_t ranks(std::uint64_t bits) {
    const std::uint64_t bit_in_byte = (bits * kEachByte) & 0x8040201008040201u;
    const std::uint64_t ones = ((bit_in_byte + 0x7f * kEachByte) >> 7) & kEachByte;
    return ones * kEachByte;
  }

  // Lane i: how many of `bits` up to `first` + i are set.
  static HWY_INLINE WordVector ranks_from(std::uint32_t bits, std::uint32_t first) {
    const auto before = static_cast<std::uint32_t>(std::popcount(bits & ((1u << first) - 1)));
    const std::uint64_t bytes = ranks((bits >> first) & 0xffu) + kEachByte * before;
    return hn::PromoteTo(Words(), hn::BitCast(hn::Rebind<std::uint8_t, Words>(),
                                              hn::Set(hn::FixedTag<std::uint64_t, 1>(), bytes)));
  }
  static HWY_INLINE hn::Mask<Words> lanes_of(std::uint32_t bits) {
    const auto lane_bit = hn::Shl(hn::Set(Words(), 1u), hn::Iota(Words(), 0u));
    return hn::TestBit(hn::Set(Words(), bits), lane_bit);
  }
  static HWY_INLINE hn::Mask<Words> is_above(WordVector a, std::uint32_t limit) {
    return hn::RebindMask(Words(), hn::Gt(hn::BitCast(Integers(), a),
                                          hn::Set(Integers(), static_cast<std::int32_t>(limit))));
  }
  static HWY_INLINE std::uint32_t bits_of_words(hn::Mask<Words> mask) {
    return bits_of(hn::RebindMask(Floats(), mask));
  }
  static HWY_INLINE WordVector permute(WordVector words, WordVector lanes) {
    return hn::TableLookupLanes(words, hn::IndicesFromVec(Words(), lanes));
  }

  // The vertices that references from `first` on lead to. `named`: numbers of vertices that are no
  // first reference's, in a row. Adds references with corrupt numbers to `corrupt`, as bits.
  HWY_INLINE WordVector vertices_of(const References& references, WordVector named,
                                    std::uint32_t first, std::uint32_t& corrupt) const {
    const Words d;
    const auto rank = ranks_from(references.firsts, first);
    const auto number = hn::Add(hn::Iota(d, 0u), hn::Set(d, first));
    // Lanes at and after `count` may shift by more than a word.
    const auto shift =
        hn::And(hn::Mul(hn::Sub(number, rank), hn::Set(d, references.width)), hn::Set(d, 31u));
    const auto other = hn::And(hn::Shr(named, shift), hn::Set(d, (1u << references.width) - 1));
    corrupt |= bits_of_words(is_above(other, vertices_ - 1)) << first;
    return hn::IfThenElse(lanes_of(references.firsts >> first), hn::Sub(rank, hn::Set(d, 1u)),
                          other);
  }

  // The same as join_faces, for up to 16 references: all faces at once. A corner of a face that
  // continues a strip is the one that the last step of the other side, up to there, left behind:
  // the third corner of the face before that step.
  HWY_INLINE bool join_faces_by_lanes(const References& references) {
    const Words d;
    const auto lane = hn::Iota(d, 0u);
    const auto named =
        hn::Set(d, static_cast<std::uint32_t>(read_bits(cluster_.bytes, references.at, 32)));
    std::uint32_t corrupt = 0;
    const auto low = vertices_of(references, named, 0, corrupt);
    const auto high = vertices_of(references, named, kWideChildren, corrupt);
    if ((corrupt & ~references.firsts & ((1u << references.count) - 1)) != 0) return false;
    // The step to each face; the first is apart.
    const auto step =
        hn::And(hn::Shr(hn::Set(d, references.steps << StripStep::kBits | StripStep::kApart),
                        hn::Mul(lane, hn::Set(d, std::uint32_t{StripStep::kBits}))),
                hn::Set(d, (1u << StripStep::kBits) - 1));
    const auto is_apart = is_above(step, StripStep::kApart - 1);
    const auto is_second_side = is_above(step, StripStep::code(1, 0) - 1);  // or apart
    const std::uint32_t aparts = bits_of_words(is_apart);
    const std::uint32_t second_sides = bits_of_words(is_second_side);
    const std::uint32_t first_sides = (~second_sides & 0xffu) | aparts;
    // Numbers of references: of the third corner of each face and of the one before, and what the
    // other two are if a step sets them.
    const auto aparts_so_far = ranks_from(aparts, 0);
    const auto third = hn::Add(lane, hn::Add(aparts_so_far, aparts_so_far));
    const auto one = hn::Set(d, 1u);
    const auto two = hn::Set(d, 2u);
    const auto previous_third = hn::Sub(hn::Sub(third, one), hn::IfThenElseZero(is_apart, two));
    const auto set_first = hn::IfThenElse(is_apart, hn::Sub(third, two), previous_third);
    const auto set_second = hn::IfThenElse(is_apart, hn::Sub(third, one), previous_third);
    const auto first = permute(set_first, last_set(first_sides));
    const auto second = permute(set_second, last_set(second_sides));
    const auto vertex = [&](WordVector reference) {
      const auto lanes = hn::And(reference, hn::Set(d, kWideChildren - 1));
      return hn::IfThenElse(is_above(reference, kWideChildren - 1), permute(high, lanes),
                            permute(low, lanes));
    };
    const auto a = vertex(first), b = vertex(second), c = vertex(third);
    // Turned so that the edge that a face is entered by is the one that its step says.
    const auto sides = hn::Add(hn::IfThenElseZero(is_second_side, hn::Set(d, 3u)),
                               hn::IfThenElseZero(is_apart, hn::Set(d, 3u)));
    const auto turn = hn::Sub(step, sides);
    const auto once = hn::Eq(turn, one), twice = hn::Eq(turn, two);
    const auto turned = [&](WordVector zero, WordVector by_one, WordVector by_two) {
      return hn::IfThenElse(twice, by_two, hn::IfThenElse(once, by_one, zero));
    };
    hn::Store(hn::Or(turned(a, c, b),
                     hn::Or(hn::ShiftLeft<8>(turned(b, a, c)), hn::ShiftLeft<16>(turned(c, b, a)))),
              d, corners_);
    return true;
  }

  // Lane i: the highest of `bits` up to i that is set. Precondition: bit 0 is.
  static HWY_INLINE WordVector last_set(std::uint32_t bits) {
    const auto up_to =
        hn::Sub(hn::Shl(hn::Set(Words(), 2u), hn::Iota(Words(), 0u)), hn::Set(Words(), 1u));
    const auto so_far = hn::BitCast(Integers(), hn::And(hn::Set(Words(), bits), up_to));
    // The exponent of a float.
    const auto exponent = hn::ShiftRight<23>(hn::BitCast(Words(), hn::ConvertTo(Floats(), so_far)));
    return hn::Sub(exponent, hn::Set(Words(), 127u));
  }

  // Corners of all faces, a byte each, from the references that bring them, a step at a time.
  HWY_INLINE bool join_faces(const References& references) {
    for (std::uint32_t r = 0; r < references.count; r += 8) {
      const auto before =
          static_cast<std::uint32_t>(std::popcount(references.firsts & ((1u << r) - 1)));
      const std::uint64_t named =
          ranks((references.firsts >> r) & 0xffu) + kEachByte * before - kEachByte;
      std::memcpy(reference_ + r, &named, sizeof(named));
    }
    std::uint32_t largest = 0;
    std::uint64_t at = references.at;
    for (std::uint32_t others = ~references.firsts & ((1u << references.count) - 1); others != 0;
         others &= others - 1) {
      const auto vertex =
          static_cast<std::uint32_t>(read_bits(cluster_.bytes, at, references.width));
      at += references.width;
      largest = std::max(largest, vertex);
      reference_[std::countr_zero(others)] = static_cast<std::uint8_t>(vertex);
    }
    if (largest >= vertices_) return false;
    const std::uint8_t* next = reference_;
    std::array<std::uint32_t, 3> face{};  // from the corner where the edge begins it is entered by
    for (std::uint32_t f = 0; f < kLeafFaces; ++f) {
      const std::uint32_t step = f == 0 ? StripStep::kApart
                                        : references.steps >> (StripStep::kBits * (f - 1)) &
                                              ((1u << StripStep::kBits) - 1);
      std::uint32_t turn = 0;
      if (step == StripStep::kApart) {
        face = {next[0], next[1], next[2]};
        next += 3;
      } else {
        const bool is_second_side = step >= StripStep::code(1, 0);
        turn = is_second_side ? step - StripStep::code(1, 0) : step;
        face = {is_second_side ? face[0] : face[2], is_second_side ? face[2] : face[1], *next++};
      }
      const std::uint32_t corners = face[0] | face[1] << 8 | face[2] << 16;
      corners_[f] = (corners << 8 * turn | corners >> (24 - 8 * turn)) & 0xffffffu;
    }
    return true;
  }

  // The words of 32 bits that begin at the bytes of some bits, shifted so that the field is lowest.
  // A field of up to 25 bits is whole.
  HWY_INLINE WordVector fields_at(WordVector bit) const {
    return hn::Shr(words_at(hn::ShiftRight<3>(bit)), hn::And(bit, hn::Set(Words(), 7u)));
  }
  // The same for fields of up to 32 bits.
  HWY_INLINE WordVector wide_fields_at(WordVector bit) const {
    const auto byte = hn::ShiftRight<3>(bit);
    const auto shift = hn::And(bit, hn::Set(Words(), 7u));
    const auto above = words_at(hn::Add(byte, hn::Set(Words(), 4u)));
    return hn::Or(hn::Shr(words_at(byte), shift),
                  hn::Shl(hn::ShiftLeft<1>(above), hn::Sub(hn::Set(Words(), 31u), shift)));
  }
  HWY_INLINE WordVector words_at(WordVector byte) const {
    return hn::GatherOffset(Words(), reinterpret_cast<const std::uint32_t*>(cluster_.bytes),
                            hn::BitCast(Integers(), byte));
  }

  // The coordinates of vertices.
  HWY_INLINE void look_up(WordVector vertex, FloatVector (&out)[3]) const {
    if (HWY_LIKELY(vertices_ <= 2 * kWideChildren)) {
      const auto seven = hn::Set(Words(), 7u);
      const auto lanes = hn::IndicesFromVec(Floats(), hn::And(vertex, seven));
      const auto is_high = hn::RebindMask(
          Floats(), hn::Gt(hn::BitCast(Integers(), vertex), hn::BitCast(Integers(), seven)));
      for (std::size_t k = 0; k < 3; ++k) {
        const auto low = hn::TableLookupLanes(hn::Load(Floats(), vertex_[k]), lanes);
        const auto high =
            hn::TableLookupLanes(hn::Load(Floats(), vertex_[k] + kWideChildren), lanes);
        out[k] = hn::IfThenElse(is_high, high, low);
      }
      return;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      out[k] = hn::GatherIndex(Floats(), vertex_[k], hn::BitCast(Integers(), vertex));
    }
  }

  // The vertices that the leaf names. `at`: the first bit of the places of those of other leaves.
  HWY_INLINE bool read_vertices(std::uint64_t at, float scale) {
    if (!find_leaves(at)) return false;
    auto corrupt = hn::Zero(Words());
    for (std::uint32_t first = 0; first < vertices_; first += kWideChildren) {
      corrupt = hn::Or(corrupt, read_group(at, first, hn::Set(Floats(), scale)));
    }
    return hn::AllTrue(Words(), hn::Eq(corrupt, hn::Zero(Words())));
  }

  // Where the leaf and the others that it names vertices of lie, a lane each. `at`: the bit of the
  // number of the others; on return, of the first vertex of theirs. False if some are corrupt.
  HWY_INLINE bool find_leaves(std::uint64_t& at) {
    const Words d;
    const ClusterHeader& header = cluster_.header;
    const std::uint32_t leaf_bits = width_below(self_);
    others_ = 0;
    std::uint64_t numbers = 0;
    if (static_cast<std::uint32_t>(std::popcount(own_)) < vertices_) {
      numbers = read_bits(cluster_.bytes, at, kOtherBits + kMaxOtherLeaves * kMostLeafBits);
      others_ = static_cast<std::uint32_t>(numbers) & ((1u << kOtherBits) - 1);
      numbers >>= kOtherBits;
      at += kOtherBits + others_ * leaf_bits;
    }
    HWY_ALIGN std::uint32_t leaves[kWideChildren];
    for (std::uint32_t slot = 0; slot < kWideChildren; ++slot) {
      const auto other = static_cast<std::uint32_t>(
          numbers >> ((slot - 1) % kWideChildren * leaf_bits) & low_bits(leaf_bits));
      leaves[slot] = slot == 0 || slot > others_ ? self_ : other;
    }
    const auto named = hn::Load(d, leaves);
    const auto leaf = hn::Min(named, hn::Set(d, self_));
    const auto entry =
        hn::Add(hn::Mul(leaf, hn::Set(d, cluster_.entry_bits)), hn::Set(d, cluster_.table));
    const auto start = hn::And(fields_at(entry), hn::Set(d, start_mask_));
    auto fields = fields_at(hn::Add(entry, hn::Set(d, std::uint32_t{header.start_bits})));
    auto stride = hn::Zero(d);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto base = hn::And(fields, hn::Set(d, base_mask_[k]));
      fields = hn::ShiftRightSame(fields, header.base_bits[k]);
      const auto width =
          hn::Add(hn::And(fields, hn::Set(d, wider_mask_[k])), hn::Set(d, width_[k]));
      fields = hn::ShiftRightSame(fields, header.wider_bits[k]);
      stride = hn::Add(stride, width);
      hn::Store(hn::Add(hn::ShiftLeftSame(base, header.base_shift[k]), hn::Set(d, origin_[k])), d,
                slot_.base[k]);
      hn::Store(width, d, slot_.width[k]);
    }
    const auto middle = hn::ShiftLeft<3>(
        hn::Add(start, hn::Add(hn::Mul(leaf, hn::Set(d, std::uint32_t{header.leaf_bytes})),
                               hn::Set(d, cluster_.leaves_at))));
    hn::Store(stride, d, slot_.stride);
    hn::Store(middle, d, slot_.middle);
    const auto inside = hn::Min(middle, hn::Set(d, most_bits_));
    const auto corrupt = hn::Or(hn::Xor(leaf, named), hn::Xor(inside, middle));
    return hn::AllTrue(d, hn::Eq(corrupt, hn::Zero(d)));
  }
  static constexpr std::uint32_t kMostLeafBits = std::bit_width(kClusterLeaves - 1);

  // Of one value for each leaf, those of some.
  static HWY_INLINE WordVector pick(const std::uint32_t* slots, WordVector index) {
    return permute(hn::Load(Words(), slots), index);
  }

  // Eight vertices from `first` on. `at`: the bit of the first vertex of another leaf. Returns a
  // vector that is 0 but for lanes whose bytes are corrupt.
  HWY_INLINE WordVector read_group(std::uint64_t at, std::uint32_t first, FloatVector scale) {
    const Words d;
    const ClusterHeader& header = cluster_.header;
    const auto one = hn::Set(d, 1u);
    const auto lane = hn::Iota(d, 0u);
    // How many of the leaf's own there are up to and with each.
    const auto own_rank = ranks_from(own_, first);
    const auto is_own = lanes_of(own_ >> first);
    const auto number = hn::Add(lane, hn::Set(d, first));
    const auto is_named = hn::Lt(hn::BitCast(Integers(), number),
                                 hn::Set(Integers(), static_cast<std::int32_t>(vertices_)));
    // Another leaf's vertex is named by that leaf and its number there; of those before it, the
    // ones that are not own come first.
    const std::uint32_t other_bits = width_below(others_);
    const auto others = hn::Sub(number, own_rank);
    const auto place =
        fields_at(hn::Add(hn::Set(d, static_cast<std::uint32_t>(at)),
                          hn::Mul(others, hn::Set(d, other_bits + header.own_bits))));
    const auto other = hn::Add(hn::And(place, hn::Set(d, (1u << other_bits) - 1)), one);
    const auto rank_there = hn::Add(
        hn::And(hn::ShiftRightSame(place, static_cast<int>(other_bits)), hn::Set(d, own_mask_)),
        one);
    const auto slot = hn::IfThenZeroElse(is_own, other);
    const auto back = hn::IfThenElse(is_own, own_rank, rank_there);
    const auto leaf = hn::And(slot, hn::Set(d, kWideChildren - 1));
    WordVector width[3];
    for (std::size_t k = 0; k < 3; ++k) width[k] = pick(slot_.width[k], leaf);
    const auto begin = hn::Sub(pick(slot_.middle, leaf), hn::Mul(back, pick(slot_.stride, leaf)));
    auto bit = hn::Min(begin, hn::Set(d, most_bits_));
    const auto is_corrupt =
        hn::Or(hn::Xor(bit, begin), hn::Xor(slot, hn::Min(slot, hn::Set(d, others_))));
    for (std::size_t k = 0; k < 3; ++k) {
      auto offset = is_narrow_ ? fields_at(bit) : wide_fields_at(bit);
      // In two steps, because a width may be that of a word.
      const auto half = hn::ShiftRight<1>(width[k]);
      const auto above = hn::Shl(hn::Shl(hn::Set(d, ~0u), half), hn::Sub(width[k], half));
      offset = hn::AndNot(above, offset);
      bit = hn::Add(bit, width[k]);
      const auto stored = hn::BitCast(Integers(), hn::Add(pick(slot_.base[k], leaf), offset));
      FloatVector value;
      if (view_.numbers == ClusterNumbers::kGrid) {
        auto whole = stored;
        if (has_trailing_) whole = hn::ShiftLeftSame(whole, header.trailing[k]);
        hn::Store(hn::BitCast(d, whole), d, number_[k] + first);
        value = hn::ConvertTo(Floats(), whole);
      } else {
        const auto sign = hn::BroadcastSignBit(stored);
        auto magnitude = hn::Xor(stored, sign);
        if (has_trailing_) magnitude = hn::ShiftLeftSame(magnitude, header.trailing[k]);
        const auto signs =
            hn::And(sign, hn::Set(Integers(), std::numeric_limits<std::int32_t>::min()));
        value = hn::BitCast(Floats(), hn::Or(magnitude, signs));
        hn::Store(hn::BitCast(d, value), d, number_[k] + first);
      }
      hn::Store(hn::Mul(value, scale), Floats(), vertex_[k] + first);
    }
    return hn::IfThenElseZero(hn::RebindMask(d, is_named), is_corrupt);
  }

  const ClusterView& view_;
  std::uint32_t cluster_number_ = kNone;
  Cluster cluster_;
  std::uint32_t most_bits_ = 0;  // at which a field may begin
  bool is_narrow_ = false;       // no offset of a vertex has more than 25 bits
  bool has_trailing_ = false;    // some axis has zero bits taken off
  std::uint32_t start_mask_, own_mask_, base_mask_[3], wider_mask_[3], width_[3], origin_[3];
  std::uint32_t self_ = 0;      // number of the leaf in its cluster
  std::uint32_t vertices_ = 0;  // that it names
  std::uint32_t own_ = 0;       // bit v: it stores vertex v itself
  std::uint32_t others_ = 0;    // leaves whose vertices it names
  // Of the leaf, and of the others after it: place and fields of vertices.
  struct Slots {
    HWY_ALIGN std::uint32_t base[3][kWideChildren];
    HWY_ALIGN std::uint32_t width[3][kWideChildren];
    HWY_ALIGN std::uint32_t stride[kWideChildren];
    HWY_ALIGN std::uint32_t middle[kWideChildren];
  };
  Slots slot_;
  std::uint8_t reference_[kMostVertices + 8];
  HWY_ALIGN std::uint32_t corners_[kLeafFaces];       // vertices, a byte each
  HWY_ALIGN std::uint32_t number_[3][kMostVertices];  // [axis]: whole numbers, or bits of floats
  HWY_ALIGN float vertex_[3][kMostVertices];          // [axis], scaled
};

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
