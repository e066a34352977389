// SPDX-License-Identifier: MIT
// The triangles of a leaf in single precision, side by side, for filters.
#if defined(BOXTREE_RUNTIME_WALK_LEAF_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_WALK_LEAF_INL_H
#undef BOXTREE_RUNTIME_WALK_LEAF_INL_H
#else
#define BOXTREE_RUNTIME_WALK_LEAF_INL_H
#endif

#include <algorithm>
#include <utility>

#include "runtime/primitive/rounding.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/tree/plain_cluster.h"
#include "runtime/walk/cluster-inl.h"
#include "runtime/walk/decode-inl.h"
#include "runtime/walk/traversal.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if HWY_TARGET != HWY_SCALAR  // without vectors the generic walks are used

// Whether leaves of clusters are read as floats. Where a build has vectors of eight numbers, too,
// few machines walk by shorter ones, and LeafReader reads them, for size.
#undef BOXTREE_READS_CLUSTERS
#if BOXTREE_HAS_EIGHT_LANES || (HWY_TARGETS & (HWY_AVX2 | HWY_AVX3)) == 0
#define BOXTREE_READS_CLUSTERS 1
#else
#define BOXTREE_READS_CLUSTERS 0
#endif
#if BOXTREE_HAS_EIGHT_LANES
using LeafClusters = ClusterReader;
#else
using LeafClusters = PlainClusterReader;
#endif

/// Reads leaves of one tree. Coordinates are the exact ones or those rounded to nearest, see
/// corner_error(). Exact triangles come from with_triangle().
class LeafFloats {
 public:
  explicit LeafFloats(const BoundTree& tree)
      : reader_(tree.leaves()),
        mesh_(reader_.mesh()),
        floats_(reader_.floats()),
        lane_code_{0, 2, 4, 6, 8, 10, 12, 14}
#if BOXTREE_READS_CLUSTERS
        ,
        clusters_(reader_.clusters(), reader_.frame(), doubles_)
#endif
  {
  }
  LeafFloats(const LeafFloats&) = delete;  // leaf_ points into it

  /// Reads the leaf of `count` faces from `first` on. False when its bytes are corrupt; see
  /// error().
  HWY_INLINE bool load(std::uint32_t first, std::uint32_t count) {
    first_ = first;
    count_ = count;
    is_direct_ = floats_.is_direct && first % kLeafFaces == 0 && count == kLeafFaces &&
                 in_range(first, count, mesh_.face_count);
#if BOXTREE_HAS_EIGHT_LANES
    // The usual case without another call.
    if (is_direct_ &&
        (take_ahead(first / kLeafFaces) || read_by_avx512(first / kLeafFaces, *leaf_))) {
      count_ = leaf_->triangles.count;
      return true;
    }
#endif
    return load_any();
  }

  /// Whether read_ahead() gains something.
  [[nodiscard]] HWY_INLINE bool reads_ahead() const {
#if BOXTREE_HAS_EIGHT_LANES
    return floats_.is_direct && clusters_.has_avx512();
#else
    return false;
#endif
  }

  /// Decodes leaf `next`, which is likely to be loaded next, if reads_ahead(); kNoLeaf: none.
  /// Called between load() and the tests of the leaf before, so that the two are decoded side by
  /// side: a decoder is a chain of instructions that wait for each other. Where it fails, load()
  /// reads the leaf again and tells why.
  HWY_INLINE void read_ahead(std::uint32_t next) {
#if BOXTREE_HAS_EIGHT_LANES
    if (next == kNoLeaf || !reads_ahead()) return;
    const bool is_read = next < mesh_.face_count / kLeafFaces && read_by_avx512(next, other());
    ahead_ = is_read ? next : kNoLeaf;
#else
    (void)next;
#endif
  }

  /// Bounds how far the coordinates of a leaf are off: mostly by underflow alone when they were
  /// gathered from floats, by half an ulp of the largest otherwise.
  [[nodiscard]] float corner_error() const {
    return is_direct_ ? floats_.direct_rounding : floats_.rounding;
  }

  /// Triangles of the leaf; lanes from there on are unspecified.
  [[nodiscard]] std::uint32_t count() const {
    return count_;
  }
  [[nodiscard]] std::size_t groups() const {
    return count_ > kWideChildren ? 2 : 1;
  }
  /// Bit i: lane i of a group is a triangle.
  [[nodiscard]] std::uint32_t lanes(std::size_t group) const {
    return (((1u << count_) - 1) >> (group * kWideChildren)) & 0xffu;
  }
  /// Coordinates of the triangles of a group and part.
  [[nodiscard]] FloatVector at(std::size_t corner, std::size_t axis, std::size_t group,
                               std::size_t part) const {
    return hn::Load(Floats(),
                    &leaf_->coordinate[corner][axis][group * kWideChildren + part * kLanes]);
  }

  [[nodiscard]] VectorTriangle triangles(std::size_t group, std::size_t part) const {
    VectorTriangle triangle;
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) triangle.corner[c].axis[k] = at(c, k, group, part);
    }
    return triangle;
  }
  /// Their bounds.
  [[nodiscard]] VectorBox bounds(std::size_t group, std::size_t part) const {
    return bounds_of(triangles(group, part));
  }

  /// The face that a lane belongs to, in the tree's order.
  [[nodiscard]] std::uint32_t face(std::uint32_t lane) const {
    return is_direct_ ? first_ + face_and_half(lane) / 2 : batch_.face[lane];
  }

  /// Which of the face's triangles it is.
  [[nodiscard]] std::uint32_t half(std::uint32_t lane) const {
    return is_direct_ ? face_and_half(lane) % 2 : half_of_face(batch_, lane);
  }

  /// Calls visit(triangle, face, half) with the exact triangle of a lane. False when its bytes are
  /// corrupt.
  template <class Visitor>
  bool with_triangle(std::uint32_t lane, Visitor&& visit) {
    Triangle triangle;
    if (!exact_triangle(lane, triangle)) return false;
    visit(triangle, face(lane), half(lane));
    return true;
  }

#if BOXTREE_HAS_EIGHT_LANES
  /// The exact triangles of all lanes, as LeafReader::read() gives them. False where that has to
  /// read them: the leaf was not gathered, or a coordinate is out of range. Precondition: the tree
  /// has clusters.
  [[nodiscard]] HWY_INLINE bool exact_triangles(TriangleBatch& out) const {
    if (!is_direct_) return false;
    const LeafTriangles& leaf = leaf_->triangles;
    HWY_ALIGN std::uint32_t number[3][3][kMaxLeafTriangles];
    ClusterReader::find_numbers(leaf, number);
    for (std::uint32_t lane = 0; lane < count_; ++lane)
      out.face[lane] = first_ + leaf.face_and_half(lane) / 2;
    out.count = count_;
    if (floats_.is_f64) {
      for (std::uint32_t lane = 0; lane < count_; ++lane) {
        std::uint32_t references[3];
        leaf.find_corners(lane, references);
        for (std::size_t c = 0; c < 3; ++c) {
          for (std::size_t k = 0; k < 3; ++k) {
            out.coordinate[c][k][lane] = doubles_[references[c]][k];
          }
        }
      }
      return true;
    }
    const hn::CappedTag<double, 4> doubles;
    const hn::Rebind<std::int32_t, decltype(doubles)> integers;
    const hn::Rebind<float, decltype(doubles)> floats;
    const auto scale = hn::Set(doubles, reader_.stored_scale());
    const bool is_grid = reader_.is_grid();
    auto is_within = hn::Eq(scale, scale);
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t lane = 0; lane < count_; lane += hn::MaxLanes(doubles)) {
          const auto bits =
              hn::Load(integers, reinterpret_cast<const std::int32_t*>(&number[c][k][lane]));
          const auto stored = is_grid ? hn::PromoteTo(doubles, bits)
                                      : hn::PromoteTo(doubles, hn::BitCast(floats, bits));
          const auto position = hn::Mul(stored, scale);
          hn::StoreU(position, doubles, &out.coordinate[c][k][lane]);
          is_within =
              hn::And(is_within, hn::Le(hn::Abs(position), hn::Set(doubles, kMaxCoordinate)));
        }
      }
    }
    return hn::AllTrue(doubles, is_within);
  }
#endif

  [[nodiscard]] Errc error() const {
    return error_;
  }

 private:
  struct Leaf {
    HWY_ALIGN LeafCoordinates coordinate;
#if BOXTREE_READS_CLUSTERS
    LeafTriangles triangles;  // of a cluster
#endif
  };

#if BOXTREE_HAS_EIGHT_LANES
  HWY_INLINE bool read_by_avx512(std::uint32_t number, Leaf& out) {
    return clusters_.read_by_avx512(number, floats_.scale, out.triangles, out.coordinate);
  }
  [[nodiscard]] HWY_INLINE Leaf& other() {
    return leaves_[leaf_ == leaves_ ? 1 : 0];
  }
  // Whether a leaf was read ahead; then it is the current one.
  HWY_INLINE bool take_ahead(std::uint32_t number) {
    if (number != std::exchange(ahead_, kNoLeaf)) return false;
    leaf_ = &other();
    return true;
  }
#endif

  HWY_NOINLINE bool load_any() {
    is_direct_ = is_direct_ && gather();
    return is_direct_ || convert();
  }

#if BOXTREE_HAS_EIGHT_LANES
  // Of arrays of floats: a corner is a vector. Its fourth number is the next one of the array, see
  // find_triangles().
  HWY_INLINE bool exact_triangle_of_arrays(std::uint32_t lane, Triangle& triangle) {
    const hn::CappedTag<double, AxisLanes::kCount> d;
    const hn::Rebind<float, decltype(d)> floats;
    static constexpr double kNoOrigin[AxisLanes::kCount] = {};
    const auto origin = hn::LoadU(
        d, reader_.is_from_origin() ? kNoOrigin : reader_.frame().origin_lanes.lane.data());
    const auto scale = hn::Set(d, reader_.stored_scale());
    const hn::Half<decltype(d)> half;
    static_assert(sizeof triangle.corner == 9 * sizeof(double));
    auto* const corners = reinterpret_cast<double*>(&triangle.corner);
    auto is_within = hn::FirstN(d, 3);
    const auto* const positions = reinterpret_cast<const float*>(mesh_.positions);
    for (std::size_t c = 0; c < 3; ++c) {
      const auto stored =
          hn::PromoteTo(d, hn::LoadU(floats, positions + start_[std::size_t{3} * lane + c]));
      const auto position = hn::Mul(hn::Sub(stored, origin), scale);
      // Two whole vectors, each fourth number of which the next corner overwrites: stores by masks
      // are slow, the more so if what they wrote is read at once.
      if (c < 2) {
        hn::StoreU(position, d, corners + 3 * c);
      } else {
        hn::StoreU(hn::LowerHalf(half, position), half, corners + 6);
        corners[8] = hn::GetLane(hn::UpperHalf(half, position));
      }
      is_within = hn::And(is_within, hn::Le(hn::Abs(position), hn::Set(d, kMaxCoordinate)));
    }
    if (hn::CountTrue(d, is_within) == 3) return true;
    error_ = Errc::kVertexNotFinite;
    return false;
  }
#endif

  // The triangle of a lane. Not inlined, for the size of the code.
  HWY_NOINLINE bool exact_triangle(std::uint32_t lane, Triangle& triangle) {
    if (!is_direct_) {
      triangle = batch_.triangle(lane);
      return true;
    }
#if BOXTREE_HAS_EIGHT_LANES
    if (!reader_.has_clusters() && !floats_.is_f64) return exact_triangle_of_arrays(lane, triangle);
#endif
#if BOXTREE_READS_CLUSTERS
    if (reader_.has_clusters() && floats_.is_f64) {
      std::uint32_t references[3];
      leaf_->triangles.find_corners(lane, references);
      for (std::size_t c = 0; c < 3; ++c) {
        const double(&position)[4] = doubles_[references[c]];
        triangle.corner[c] = {position[0], position[1], position[2]};
      }
      return true;
    }
#endif
    const bool is_grid = reader_.is_grid();
    const double scale = reader_.stored_scale();
    const Eigen::Vector3d origin =
        reader_.is_from_origin() ? Eigen::Vector3d::Zero() : reader_.frame().origin;
    double corner[3][4];
    read_corners(lane, corner);
    bool is_finite = true;
    for (std::size_t c = 0; c < 3; ++c) {
      triangle.corner[c] =
          (Eigen::Vector3d(corner[c][0], corner[c][1], corner[c][2]) - origin) * scale;
      is_finite &= is_grid || is_within_range(triangle.corner[c]);
    }
    if (!is_finite) {
      error_ = Errc::kVertexNotFinite;
      return false;
    }
    return true;
  }

  HWY_INLINE bool gather() {
    if (reader_.has_clusters()) {
#if BOXTREE_READS_CLUSTERS
      return gather_cluster();
#else
      return false;
#endif
    }
    const bool is_read =
        mesh_.corner_bytes == 2 ? find_triangles<std::uint16_t>() : find_triangles<std::uint32_t>();
    if (!is_read) return false;
    if (floats_.is_f64) return gather_doubles();
    gather_positions(reinterpret_cast<const float*>(mesh_.positions), start_, floats_.scale,
                     floats_.shift);
    return true;
  }

#if BOXTREE_READS_CLUSTERS
  HWY_INLINE bool gather_cluster() {
    if (!clusters_.read(first_ / kLeafFaces, floats_.scale, leaf_->triangles, leaf_->coordinate)) {
      return false;
    }
    count_ = leaf_->triangles.count;
    return true;
  }

#endif

  // See LeafTriangles, of a leaf that was gathered.
  [[nodiscard]] HWY_INLINE std::uint32_t face_and_half(std::uint32_t lane) const {
#if BOXTREE_READS_CLUSTERS
    if (reader_.has_clusters()) return leaf_->triangles.face_and_half(lane);
#endif
    return lane_code_[lane];
  }

  // [corner][axis], as they are stored.
  HWY_INLINE void read_corners(std::uint32_t lane, double (&out)[3][4]) const {
#if BOXTREE_READS_CLUSTERS
    if (reader_.has_clusters())
      return leaf_->triangles.read_corners(lane, reader_.clusters().numbers, out);
#endif
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Vector3d p = position_of(mesh_, start_[std::size_t{3} * lane + c] / 3);
      for (std::size_t k = 0; k < 3; ++k) out[c][k] = p[static_cast<Eigen::Index>(k)];
    }
  }

  // To start_, of each triangle. The common case: in floats, in the tree's order, and scaled
  // without rounding. Four floats are read at once, so a leaf with the last vertex takes the other
  // path.
  template <class Corner>
  HWY_INLINE bool find_triangles() {
    if (mesh_.corners_per_face == 3) return read_starts<Corner, 3>(start_);
    HWY_ALIGN std::uint32_t starts[std::size_t{4} * kLeafFaces];
    if (!read_starts<Corner, 4>(starts)) return false;
    join_triangles(starts, 3 * std::uint32_t{static_cast<Corner>(kMissingCorner)});
    return true;
  }
  // Of each corner of each face, also of missing ones. False if there is no such vertex.
  template <class Corner, std::uint32_t kCornersPerFace>
  HWY_INLINE bool read_starts(std::uint32_t* starts) const {
    const hn::Repartition<std::uint32_t, Floats> words;
    const hn::Rebind<Corner, decltype(words)> stored;
    const auto* corners =
        reinterpret_cast<const Corner*>(mesh_.corners) + std::size_t{first_} * kCornersPerFace;
    // Quads are rarer: a loop that is not unrolled, for size.
    const std::uint32_t count =
        kLeafFaces * (kCornersPerFace == 3 ? kCornersPerFace : mesh_.corners_per_face);
    auto largest = hn::Zero(words);
    for (std::size_t i = 0; i < count; i += kLanes) {
      const auto vertex = widen(words, hn::LoadU(stored, corners + i));
      auto named = vertex;
      if constexpr (kCornersPerFace == 4) {
        const auto three = hn::Set(words, 3);
        const auto is_missing =
            hn::And(hn::Eq(hn::And(hn::Iota(words, 0), three), three),
                    hn::Eq(vertex, hn::Set(words, static_cast<Corner>(kMissingCorner))));
        named = hn::IfThenZeroElse(is_missing, vertex);
      }
      largest = hn::Max(largest, named);
      hn::Store(hn::Add(vertex, hn::ShiftLeft<1>(vertex)), words, starts + i);
    }
    return hn::AllTrue(words, hn::Lt(largest, hn::Set(words, mesh_.vertex_count - 1)));
  }
  // The triangles of faces of four corners, of which the last may be missing. For size: what is
  // done with them takes the time.
  [[gnu::cold]] HWY_NOINLINE void join_triangles(const std::uint32_t* starts,
                                                 std::uint32_t missing) {
    std::uint32_t count = 0;
    for (std::uint32_t face = 0; face < kLeafFaces; ++face, starts += 4) {
      const std::size_t corners = starts[3] == missing ? 3 : 4;
      for (std::size_t second = 1; second + 1 < corners; ++second, ++count) {
        start_[3 * count] = starts[0];
        start_[3 * count + 1] = starts[second];
        start_[3 * count + 2] = starts[second + 1];
        lane_code_[count] = static_cast<std::uint8_t>(2 * face + second - 1);
      }
    }
    count_ = count;
    // The other lanes of vectors are read, too.
    for (; count % kWideChildren != 0; ++count) std::fill_n(start_ + 3 * count, 3, 0);
  }
  // Those that are doubles: placed in tree space as LeafReader does. False where one is out of
  // range.
  HWY_NOINLINE bool gather_doubles() {
#if HWY_HAVE_FLOAT64
    static constexpr float kNoShift[3] = {};
    HWY_ALIGN float row[3 * kMaxLeafTriangles][4];
    std::uint32_t rows[3 * kMaxLeafTriangles];
    for (std::uint32_t i = 0; i < 3 * kMaxLeafTriangles; ++i) rows[i] = 4 * i;
    const hn::CappedTag<double, 4> d;
    const hn::Rebind<float, decltype(d)> floats;
    const auto* const positions = reinterpret_cast<const double*>(mesh_.positions);
    const auto scale = hn::Set(d, reader_.stored_scale());
    const auto most = hn::Set(d, kMaxCoordinate);
    const std::size_t corners = 3 * kWideChildren * groups();
    for (std::size_t k = 0; k < 4; k += hn::MaxLanes(d)) {
      const auto origin = hn::LoadU(d, reader_.frame().origin_lanes.lane.data() + k);
      auto is_within = hn::Eq(scale, scale);
      for (std::size_t i = 0; i < corners; ++i) {
        const auto stored = hn::LoadU(d, positions + start_[i] + k);
        const auto position = hn::Mul(hn::Sub(stored, origin), scale);
        is_within = hn::And(is_within, hn::Le(hn::Abs(position), most));
        hn::Store(hn::DemoteTo(floats, position), floats, row[i] + k);
      }
      // The fourth number is the next one of the array.
      if (!hn::AllTrue(d, hn::Or(is_within, hn::Not(hn::FirstN(d, 3 - k))))) return false;
    }
    gather_positions(row[0], rows, 1, kNoShift);
    return true;
#else
    return false;
#endif
  }
  // `start`: of each corner, in floats. Not inlined, for size.
  HWY_NOINLINE void gather_positions(const float* rows, const std::uint32_t* start, float scale,
                                     const float (&shift)[3]) {
    for (std::size_t group = 0; group < groups(); ++group) {
      for (std::size_t c = 0; c < 3; ++c) {
        transpose(
            rows, [&](std::size_t lane) { return start[3 * lane + c]; }, c, group * kWideChildren,
            scale, shift);
      }
    }
  }
  template <class D, class V>
  static HWY_INLINE hn::Vec<D> widen(D words, V stored) {
    if constexpr (sizeof(hn::TFromV<V>) == sizeof(hn::TFromD<D>)) {
      return stored;
    } else {
      return hn::PromoteTo(words, stored);
    }
  }

  // Corner `corner` of eight lanes from `first` on; that of lane i is start(i) floats after `rows`.
  template <class Start>
  HWY_INLINE void transpose(const float* rows, const Start& start, std::size_t corner,
                            std::size_t first, float of_scale, const float (&shift)[3]) {
    const Floats d;
    const FloatVector scale = hn::Set(Floats(), of_scale);
    const hn::Repartition<std::uint64_t, Floats> pairs;
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t lane = first + part * kLanes;
      // Of each block of four rows: x0 x1 y0 y1, z0 z1 - -, and so on, to x0 x1 x2 x3.
      const auto r0 = blocks(rows, start, lane), r1 = blocks(rows, start, lane + 1);
      const auto r2 = blocks(rows, start, lane + 2), r3 = blocks(rows, start, lane + 3);
      const auto xy01 = hn::BitCast(pairs, hn::InterleaveLower(d, r0, r1));
      const auto xy23 = hn::BitCast(pairs, hn::InterleaveLower(d, r2, r3));
      const auto z01 = hn::BitCast(pairs, hn::InterleaveUpper(d, r0, r1));
      const auto z23 = hn::BitCast(pairs, hn::InterleaveUpper(d, r2, r3));
      const auto store = [&](std::size_t axis, auto values) {
        // The product is exact, so that it does not matter whether it is rounded.
        hn::Store(hn::MulSub(hn::BitCast(d, values), scale, hn::Set(d, shift[axis])), Floats(),
                  &leaf_->coordinate[corner][axis][lane]);
      };
      store(0, hn::InterleaveLower(pairs, xy01, xy23));
      store(1, hn::InterleaveUpper(pairs, xy01, xy23));
      store(2, hn::InterleaveLower(pairs, z01, z23));
    }
  }
  // The row of a lane and, in the next block, of the one four lanes on.
  template <class Start>
  static HWY_INLINE FloatVector blocks(const float* rows, const Start& start, std::size_t lane) {
    const hn::CappedTag<float, 4> four;
    const auto row = hn::LoadU(four, rows + start(lane));
#if HWY_MAX_BYTES >= 32
    return hn::Combine(Floats(), hn::LoadU(four, rows + start(lane + 4)), row);
#else
    return row;
#endif
  }

  bool convert() {
    error_ = reader_.read(first_, count_, batch_);
    count_ = batch_.count;
    if (error_ != Errc::kOk) return false;
    batch_.round_to_floats(leaf_->coordinate);
    return true;
  }

  const LeafReader& reader_;
  const MeshArrays& mesh_;
  const FloatLeaves& floats_;
  bool is_direct_;  // whether the leaf was gathered as it is stored
  std::uint32_t first_ = 0;
  std::uint32_t count_ = 0;
  Errc error_ = Errc::kOk;
  // Of each corner's position, in floats: three for each lane.
  HWY_ALIGN std::uint32_t start_[std::size_t{3} * kMaxLeafTriangles];
  // Of each lane of arrays: see LeafTriangles::face_and_half().
  std::uint8_t lane_code_[kMaxLeafTriangles];
  TriangleBatch batch_;
#if BOXTREE_READS_CLUSTERS
  HWY_ALIGN DoublePositions doubles_;  // of the current leaf of a cluster
  LeafClusters clusters_;
#endif
#if BOXTREE_HAS_EIGHT_LANES
  std::uint32_t ahead_ = kNoLeaf;  // the leaf that was read ahead, which is in the other one
  Leaf leaves_[2];
#else
  Leaf leaves_[1];
#endif
  Leaf* leaf_ = leaves_;  // the current one
};

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
