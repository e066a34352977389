// SPDX-License-Identifier: MIT
// Compares two leaves: one triangle of the second leaf with eight of the first at a time.
#if defined(BOXTREE_RUNTIME_QUERY_LEAF_PAIR_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_QUERY_LEAF_PAIR_INL_H
#undef BOXTREE_RUNTIME_QUERY_LEAF_PAIR_INL_H
#else
#define BOXTREE_RUNTIME_QUERY_LEAF_PAIR_INL_H
#endif

#include <boxtree/query.h>

#include "runtime/primitive/predicates.h"
#include "runtime/primitive/rounding.h"
#include "runtime/query/pair_filter.h"
#include "runtime/query/pair_work.h"
#include "runtime/tree/bound_tree.h"
#include "runtime/walk/leaf-inl.h"
#include "runtime/walk/vector3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if HWY_TARGET != HWY_SCALAR

/// A leaf with bounds and normals, in the first tree's space.
struct PreparedLeaf {
  HWY_ALIGN float corner[3][3][kMaxLeafTriangles];  // [corner][axis][triangle]
  HWY_ALIGN float low[3][kMaxLeafTriangles];
  HWY_ALIGN float high[3][kMaxLeafTriangles];
  HWY_ALIGN float normal[3][kMaxLeafTriangles];  // e1 x e2
  HWY_ALIGN float length[kMaxLeafTriangles];     // largest component of e1, e2
  float error;                                   // of corners, on every axis

  /// From corner coordinates at(corner, axis, offset) -> FloatVector.
  template <class At>
  HWY_INLINE void prepare(std::size_t groups, At&& at) {
    const Floats d;
    for (std::size_t offset = 0; offset < groups * kWideChildren; offset += kLanes) {
      Vector3 c[3];
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t k = 0; k < 3; ++k) {
          c[i].at[k] = at(i, k, offset);
          hn::Store(c[i].at[k], d, corner[i][k] + offset);
        }
      }
      const Vector3 e1 = minus(c[1], c[0]), e2 = minus(c[2], c[0]);
      const Vector3 n = cross(e1, e2);
      for (std::size_t k = 0; k < 3; ++k) {
        hn::Store(hn::Min(c[0].at[k], hn::Min(c[1].at[k], c[2].at[k])), d, low[k] + offset);
        hn::Store(hn::Max(c[0].at[k], hn::Max(c[1].at[k], c[2].at[k])), d, high[k] + offset);
        hn::Store(n.at[k], d, normal[k] + offset);
      }
      hn::Store(hn::Max(largest(e1), largest(e2)), d, length + offset);
    }
  }

  [[nodiscard]] HWY_INLINE Vector3 corners(std::size_t c, std::size_t offset) const {
    const Floats d;
    return {{hn::Load(d, corner[c][0] + offset), hn::Load(d, corner[c][1] + offset),
             hn::Load(d, corner[c][2] + offset)}};
  }
  [[nodiscard]] HWY_INLINE Vector3 normals(std::size_t offset) const {
    const Floats d;
    return {{hn::Load(d, normal[0] + offset), hn::Load(d, normal[1] + offset),
             hn::Load(d, normal[2] + offset)}};
  }
  /// A corner of one triangle, in all lanes.
  [[nodiscard]] HWY_INLINE Vector3 one_corner(std::size_t c, std::uint32_t triangle) const {
    const Floats d;
    return {{hn::Set(d, corner[c][0][triangle]), hn::Set(d, corner[c][1][triangle]),
             hn::Set(d, corner[c][2][triangle])}};
  }
  [[nodiscard]] HWY_INLINE Vector3 one_normal(std::uint32_t triangle) const {
    const Floats d;
    return {{hn::Set(d, normal[0][triangle]), hn::Set(d, normal[1][triangle]),
             hn::Set(d, normal[2][triangle])}};
  }
};

/// Whether three points all lie provably above or all below a plane, in each lane. Let u =
/// 2^-24, c = `plane_error` and e = `point_error` of corners, L = `length` of the plane's triangle,
/// W the largest component of the vectors from its corner to the points. A component of the normal,
/// at most 2 L^2, is off by 16 (c + u L) L and one of these vectors by c + e + u W, so a height by
/// 64 (c + u L) L W + 8 L^2 (c + e + 4 u W), roundings of the sum included. All coordinates are at
/// most kFloatMaxAbs, so nothing overflows; underflow takes 2^-149 from a component of the normal,
/// which the vector multiplies by less than 2^42, and less from all else.
HWY_INLINE hn::Mask<Floats> is_one_sided(const Vector3& normal, FloatVector length,
                                         float plane_error, const Vector3 (&w)[3],
                                         float point_error) {
  const Floats d;
  const FloatVector h0 = dot(normal, w[0]), h1 = dot(normal, w[1]), h2 = dot(normal, w[2]);
  const FloatVector away = hn::Max(largest(w[0]), hn::Max(largest(w[1]), largest(w[2])));
  const FloatVector blur = hn::MulAdd(hn::Set(d, static_cast<float>(64 * kRoundoffF32)), length,
                                      hn::Set(d, 64 * plane_error));
  const FloatVector spread = hn::MulAdd(hn::Set(d, static_cast<float>(32 * kRoundoffF32)), away,
                                        hn::Set(d, 8 * (plane_error + point_error)));
  constexpr float kUnderflow = 0x1p-100f;
  const FloatVector doubt =
      hn::MulAdd(length, hn::MulAdd(blur, away, hn::Mul(length, spread)), hn::Set(d, kUnderflow));
  return hn::Or(hn::Gt(hn::Min(h0, hn::Min(h1, h2)), doubt),
                hn::Lt(hn::Max(h0, hn::Max(h1, h2)), hn::Neg(doubt)));
}

/// Compares leaves of two trees. Keeps the leaf read last on each side, as it is often needed
/// several times in a row.
class LeafPairs {
 public:
  LeafPairs(const BoundTree& first, const BoundTree& second, const RelativePose& pose,
            const PairFilter& filter, PairVisitor visitor)
      : pose_(pose),
        filter_(filter),
        report_(first, second, visitor),
        first_(first),
        second_(second) {}

  /// Visits the pairs of two leaves, named by their first faces. False to end the walk: stopped()
  /// or an error.
  bool visit(NodeRef first, const Box<float>& first_box, NodeRef second) {
    if (!read_first(first) || !read_second(second)) return false;
    // Which pairs of faces were found: a quad has two triangles, but is reported once.
    std::uint64_t found = 0;
    for (std::size_t group = 0; group < second_.groups(); ++group) {
      const std::uint32_t near = may_touch_box(first_box, group) & second_.lanes(group);
      const bool go_on = for_each_bit(near, [&](std::uint32_t i) {
        return visit_one(static_cast<std::uint32_t>(group * kWideChildren) + i, found);
      });
      if (!go_on) return false;
    }
    return true;
  }

  [[nodiscard]] bool stopped() const { return report_.stopped(); }
  [[nodiscard]] Errc error() const { return error_ != Errc::kOk ? error_ : report_.error(); }

 private:
  bool read_first(NodeRef leaf) {
    if (leaf == first_read_) return true;
    first_read_ = kNone;
    if (!first_.load(leaf.first, leaf.second)) {
      error_ = first_.error();
      return false;
    }
    prepared_first_.error = first_.corner_error();
    prepared_first_.prepare(first_.groups(), [&](std::size_t c, std::size_t k, std::size_t offset) {
      return first_.at(c, k, 0, offset / kLanes);
    });
    first_read_ = leaf;
    return true;
  }

  bool read_second(NodeRef leaf) {
    if (leaf == second_read_) return true;
    second_read_ = kNone;
    if (!second_.load(leaf.first, leaf.second)) {
      error_ = second_.error();
      return false;
    }
    const FloatMap& map = filter_.to_first;
    prepared_second_.error = std::max({map.error[0], map.error[1], map.error[2]});
    prepared_second_.prepare(
        second_.groups(), [&](std::size_t c, std::size_t k, std::size_t offset) {
          const Floats d;
          FloatVector x = hn::Set(d, map.translation[k]);
          for (std::size_t j = 0; j < 3; ++j) {
            x = hn::MulAdd(hn::Set(d, map.linear[j][k]), second_.at(c, j, 0, offset / kLanes), x);
          }
          return x;
        });
    second_read_ = leaf;
    return true;
  }

  // Bit i: triangle i of the second leaf may overlap the box of the first.
  HWY_INLINE std::uint32_t may_touch_box(const Box<float>& box, std::size_t group) const {
    const Floats d;
    const FloatMap& map = filter_.to_first;
    std::uint32_t near = 0;
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t offset = group * kWideChildren + part * kLanes;
      auto overlap = hn::Le(hn::Load(d, prepared_second_.low[0] + offset),
                            hn::Set(d, box.high[0] + map.error[0]));
      for (std::size_t k = 0; k < 3; ++k) {
        const auto below = hn::Le(hn::Load(d, prepared_second_.low[k] + offset),
                                  hn::Set(d, box.high[k] + map.error[k]));
        const auto above = hn::Ge(hn::Load(d, prepared_second_.high[k] + offset),
                                  hn::Set(d, box.low[k] - map.error[k]));
        overlap = hn::And(overlap, hn::And(below, above));
      }
      near |= bits_of(overlap) << (part * kLanes);
    }
    return near;
  }

  bool visit_one(std::uint32_t second_lane, std::uint64_t& found) {
    bool have_moved = false;
    Triangle moved;
    for (std::size_t group = 0; group < first_.groups(); ++group) {
      std::uint32_t near = 0;
      for (std::size_t part = 0; part < kParts; ++part) {
        near |= may_touch(second_lane, group * kWideChildren + part * kLanes) << (part * kLanes);
      }
      near &= first_.lanes(group);
      if (near == 0) continue;
      if (!have_moved && !move_second(second_lane, moved)) return false;
      have_moved = true;
      const bool go_on = for_each_bit(near, [&](std::uint32_t i) {
        return compare(static_cast<std::uint32_t>(group * kWideChildren) + i, second_lane, moved,
                       found);
      });
      if (!go_on) return false;
    }
    return true;
  }

  // Bit i: triangle i of a part of the first leaf may touch triangle j of the second: neither
  // bounds nor a plane separate them.
  HWY_INLINE std::uint32_t may_touch(std::uint32_t j, std::size_t offset) const {
    const Floats d;
    const PreparedLeaf& a = prepared_first_;
    const PreparedLeaf& b = prepared_second_;
    const float error = a.error + b.error;
    auto touch = hn::Le(hn::Load(d, a.low[0] + offset), hn::Set(d, b.high[0][j] + error));
    for (std::size_t k = 0; k < 3; ++k) {
      touch =
          hn::And(touch, hn::Le(hn::Load(d, a.low[k] + offset), hn::Set(d, b.high[k][j] + error)));
      touch =
          hn::And(touch, hn::Ge(hn::Load(d, a.high[k] + offset), hn::Set(d, b.low[k][j] - error)));
    }
    if (hn::AllFalse(d, touch)) return 0;
    Vector3 to_second[3], to_first[3];
    const Vector3 a0 = a.corners(0, offset), b0 = b.one_corner(0, j);
    for (std::size_t c = 0; c < 3; ++c) {
      to_second[c] = minus(b.one_corner(c, j), a0);
      to_first[c] = minus(a.corners(c, offset), b0);
    }
    const auto by_first = is_one_sided(a.normals(offset), hn::Load(d, a.length + offset), a.error,
                                       to_second, b.error);
    const auto by_second =
        is_one_sided(b.one_normal(j), hn::Set(d, b.length[j]), b.error, to_first, a.error);
    return bits_of(hn::AndNot(hn::Or(by_first, by_second), touch));
  }

  // The exact triangle in the first tree's space.
  bool move_second(std::uint32_t lane, Triangle& moved) {
    const bool read = second_.with_triangle(
        lane, [&](const Triangle& triangle, std::uint32_t /*face*/, std::uint32_t /*half*/) {
          for (std::size_t c = 0; c < 3; ++c) {
            moved.corner[c] = pose_.to_first().apply(triangle.corner[c]);
            // Outside the root box that the pose was checked with.
            if (!is_within_range(moved.corner[c])) error_ = Errc::kVertexNotFinite;
          }
        });
    if (!read) error_ = second_.error();
    return error_ == Errc::kOk;
  }

  bool compare(std::uint32_t first_lane, std::uint32_t second_lane, const Triangle& moved,
               std::uint64_t& found) {
    const std::uint32_t first_face = first_.face(first_lane);
    const std::uint32_t second_face = second_.face(second_lane);
    const std::uint64_t pair = std::uint64_t{1} << ((first_face - first_read_.first) * kLeafFaces +
                                                    (second_face - second_read_.first));
    if ((found & pair) != 0) return true;
    bool touch = false;
    const bool read = first_.with_triangle(
        first_lane, [&](const Triangle& triangle, std::uint32_t /*face*/, std::uint32_t /*half*/) {
          touch = triangles_intersect(triangle, moved);
        });
    if (!read) {
      error_ = first_.error();
      return false;
    }
    if (!touch) return true;
    found |= pair;
    return report_.add(first_face, second_face);
  }

  const RelativePose& pose_;
  const PairFilter& filter_;
  PairReport report_;
  LeafFloats first_;
  LeafFloats second_;
  static constexpr NodeRef kNone{0xffffffffu, 0xffffffffu};
  NodeRef first_read_ = kNone;
  NodeRef second_read_ = kNone;
  PreparedLeaf prepared_first_;
  PreparedLeaf prepared_second_;
  Errc error_ = Errc::kOk;
};

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
