// SPDX-License-Identifier: MIT
// Contacts of a sphere that stays where it is, four triangles side by side in doubles: what
// MovingShape::contact_at_rest(), closest_corners() and face_normal() find one by one, bit for bit,
// but for the rare triangles that need their care. Every operation is theirs, in their order; where
// they branch, both ways are computed.
#if defined(BOXTREE_RUNTIME_QUERY_SPHERE_CONTACTS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_QUERY_SPHERE_CONTACTS_INL_H
#undef BOXTREE_RUNTIME_QUERY_SPHERE_CONTACTS_INL_H
#else
#define BOXTREE_RUNTIME_QUERY_SPHERE_CONTACTS_INL_H
#endif

#include <algorithm>
#include <limits>
#include <utility>

#include "runtime/primitive/closest_point.h"
#include "runtime/primitive/normal.h"
#include "runtime/primitive/penetration.h"
#include "runtime/primitive/separation.h"
#include "runtime/query/cast_query.h"
#include "runtime/walk/leaf-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
// Shorter vectors hold two doubles, which gain little.
#undef BOXTREE_FINDS_SPHERE_CONTACTS
#if BOXTREE_HAS_EIGHT_LANES && BOXTREE_HAS_COLLIDE_QUERIES
#define BOXTREE_FINDS_SPHERE_CONTACTS 1
#else
#define BOXTREE_FINDS_SPHERE_CONTACTS 0
#endif

#if BOXTREE_FINDS_SPHERE_CONTACTS

/// Triangles of a leaf that a sphere may touch.
class SphereContacts {
 public:
  explicit SphereContacts(CastQuery& query)
      : query_(query),
        center_(query.moving.center_at(0)),
        are_wanted_(query.wanted == CastQuery::Wanted::kContacts && query.moving.shape.axes == 0 &&
                    query.moving.shape.hull == nullptr) {
    if (are_wanted_) query.set_triangle({}, 0, 0, touch_);
  }

  /// Whether contacts of that kind are looked for.
  [[nodiscard]] bool are_wanted() const { return are_wanted_; }

  /// A triangle in tree space. Precondition: at most kWideChildren were added since visit().
  HWY_INLINE void add(const Triangle& triangle, std::uint32_t face, std::uint32_t half) {
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        in_tree_[c][k][count_] = triangle.corner[c][static_cast<Eigen::Index>(k)];
      }
    }
    face_[count_] = face;
    half_[count_] = half;
    ++count_;
  }

  /// Gives the query the contacts with triangles that were added, in that order, until it is done.
  /// Leaves those that do not fill a vector for the next time.
  void visit() {
    const std::uint32_t full = count_ / kDoubles * kDoubles;
    if (full == 0) return;
    visit_first(full);
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) move_to_front(in_tree_[c][k], full);
    }
    move_to_front(face_, full);
    move_to_front(half_, full);
    count_ -= full;
  }
  /// The same with none left.
  void visit_all() {
    visit_first(count_);
    count_ = 0;
  }

 private:
  template <class Number>
  static HWY_INLINE void move_to_front(Number* numbers, std::uint32_t from) {
    for (std::size_t i = 0; i < kDoubles; ++i) numbers[i] = numbers[from + i];
  }

  HWY_NOINLINE void visit_first(std::uint32_t count) {
    for (std::uint32_t first = 0; first < count; first += kDoubles) {
      const Found found = find(first);
      const std::uint32_t last = std::min<std::uint32_t>(count, first + kDoubles);
      for (std::uint32_t i = first; i < last && !query_.is_done(); ++i) {
        if (((found.apart >> (i - first)) & 1u) != 0) continue;
        for (std::size_t c = 0; c < 3; ++c) touch_.in_tree.corner[c] = vector(in_tree_[c], i);
        if (((found.touching >> (i - first)) & 1u) == 0) {
          query_.test(touch_.in_tree, face_[i], half_[i]);
          continue;
        }
        touch_.face = {kNoFaceId, face_[i]};
        touch_.original = face_[i];
        touch_.half = half_[i];
        touch_.at.point = vector(point_, i);
        touch_.at.normal = vector(normal_, i);
        touch_.at.depth = depth_[i];
        touch_.at.feature = TrianglePart::with_corners(static_cast<std::uint32_t>(corners_[i]));
        touch_.face_normal = vector(face_normal_, i);
        query_.take(touch_);
      }
    }
  }

  using Doubles = hn::CappedTag<double, 4>;
  using DoubleVector = hn::Vec<Doubles>;
  using DoubleMask = hn::Mask<Doubles>;
  static constexpr std::size_t kDoubles = hn::MaxLanes(Doubles());
  struct Vector {
    DoubleVector at[3];
  };
  static constexpr std::size_t kMost = kWideChildren + kDoubles;  // with those that are left
  using Stored = double[3][kMost];

  static HWY_INLINE DoubleVector set(double x) { return hn::Set(Doubles(), x); }
  static HWY_INLINE Vector minus(const Vector& a, const Vector& b) {
    return {{hn::Sub(a.at[0], b.at[0]), hn::Sub(a.at[1], b.at[1]), hn::Sub(a.at[2], b.at[2])}};
  }
  static HWY_INLINE Vector plus(const Vector& a, const Vector& b) {
    return {{hn::Add(a.at[0], b.at[0]), hn::Add(a.at[1], b.at[1]), hn::Add(a.at[2], b.at[2])}};
  }
  static HWY_INLINE Vector times(DoubleVector s, const Vector& a) {
    return {{hn::Mul(s, a.at[0]), hn::Mul(s, a.at[1]), hn::Mul(s, a.at[2])}};
  }
  static HWY_INLINE Vector over(const Vector& a, DoubleVector s) {
    return {{hn::Div(a.at[0], s), hn::Div(a.at[1], s), hn::Div(a.at[2], s)}};
  }
  static HWY_INLINE Vector negative(const Vector& a) {
    return {{hn::Neg(a.at[0]), hn::Neg(a.at[1]), hn::Neg(a.at[2])}};
  }
  static HWY_INLINE Vector select(DoubleMask mask, const Vector& yes, const Vector& no) {
    return {{hn::IfThenElse(mask, yes.at[0], no.at[0]), hn::IfThenElse(mask, yes.at[1], no.at[1]),
             hn::IfThenElse(mask, yes.at[2], no.at[2])}};
  }
  // As in vector3.h.
  static HWY_INLINE DoubleVector dot(const Vector& a, const Vector& b) {
    return hn::Add(hn::Add(hn::Mul(a.at[0], b.at[0]), hn::Mul(a.at[1], b.at[1])),
                   hn::Mul(a.at[2], b.at[2]));
  }
  static HWY_INLINE DoubleVector squared_length(const Vector& a) { return dot(a, a); }
  static HWY_INLINE Vector cross(const Vector& a, const Vector& b) {
    const auto minor = [&](std::size_t i, std::size_t j) HWY_ATTR {
      return hn::Sub(hn::Mul(a.at[i], b.at[j]), hn::Mul(a.at[j], b.at[i]));
    };
    return {{minor(1, 2), minor(2, 0), minor(0, 1)}};
  }
  static HWY_INLINE DoubleVector largest(const Vector& a) {
    return hn::Max(hn::Max(hn::Abs(a.at[0]), hn::Abs(a.at[1])), hn::Abs(a.at[2]));
  }
  static HWY_INLINE DoubleVector largest(const Vector (&a)[3]) {
    return hn::Max(hn::Max(largest(a[0]), largest(a[1])), largest(a[2]));
  }
  static HWY_INLINE DoubleMask equal(const Vector& a, const Vector& b) {
    return hn::And(hn::And(hn::Eq(a.at[0], b.at[0]), hn::Eq(a.at[1], b.at[1])),
                   hn::Eq(a.at[2], b.at[2]));
  }
  // See power_to_one() of normal.cpp.
  static HWY_INLINE DoubleVector power_to_one(DoubleVector x) {
    const hn::Rebind<std::uint64_t, Doubles> bits;
    const auto exponent = hn::ShiftRight<52>(hn::BitCast(bits, x));
    return hn::BitCast(Doubles(), hn::ShiftLeft<52>(hn::Sub(hn::Set(bits, kTwiceBias), exponent)));
  }

  static HWY_INLINE void store(const Vector& a, Stored& out, std::size_t first) {
    for (std::size_t k = 0; k < 3; ++k) hn::Store(a.at[k], Doubles(), out[k] + first);
  }
  static HWY_INLINE Eigen::Vector3d vector(const Stored& stored, std::uint32_t i) {
    return {stored[0][i], stored[1][i], stored[2][i]};
  }

  // A point of a segment from `from` to `to`: see on_segment() of closest_point.cpp.
  static HWY_INLINE Vector on_segment(const Vector& from, const Vector& edge, const Vector& to,
                                      DoubleVector fraction) {
    const Vector inside = plus(from, times(fraction, edge));
    const Vector before = select(hn::Ge(fraction, set(1)), to, inside);
    return select(hn::Gt(fraction, set(0)), before, from);
  }

  // The closest to the origin of the points tried so far.
  struct Nearest {
    HWY_INLINE void consider(const Vector& candidate, DoubleMask is_tried) {
      const DoubleVector squared = squared_length(candidate);
      const auto is_nearer = hn::And(is_tried, hn::Lt(squared, distance));
      best = select(is_nearer, candidate, best);
      distance = hn::IfThenElse(is_nearer, squared, distance);
    }
    Vector best;
    DoubleVector distance;
  };

  // What closest_point_on_triangle() and closest_corners() say of the origin.
  struct Closest {
    Vector point;
    DoubleVector corners;  // a number
    DoubleMask is_known;
  };
  static HWY_INLINE Closest closest_to_origin(const Vector (&corner)[3]) {
    const DoubleVector zero = set(0), one = set(1);
    const Vector& a = corner[0];
    const Vector& b = corner[1];
    const Vector& c = corner[2];
    const Vector origin{{zero, zero, zero}};
    const Vector base = minus(b, a), side = minus(c, a), away = minus(origin, a);
    const DoubleVector base_square = squared_length(base);
    const DoubleVector side_along = hn::Div(dot(side, base), base_square);
    const DoubleVector away_along = hn::Div(dot(away, base), base_square);
    const Vector height = minus(side, times(side_along, base));
    const DoubleVector height_square = squared_length(height);
    const DoubleVector weight_c =
        hn::Div(dot(minus(away, times(away_along, base)), height), height_square);
    const DoubleVector weight_b = hn::Sub(away_along, hn::Mul(weight_c, side_along));
    const auto is_inside = hn::And(hn::And(hn::Ge(weight_b, zero), hn::Ge(weight_c, zero)),
                                   hn::Le(hn::Add(weight_b, weight_c), one));
    const Vector foot = plus(a, plus(times(weight_b, base), times(weight_c, side)));

    const DoubleVector weight_a = hn::Sub(hn::Sub(one, weight_b), weight_c);
    const DoubleVector side_square = squared_length(side);
    const auto is_outside =
        hn::And(hn::And(hn::Lt(hn::Min(weight_a, hn::Min(weight_b, weight_c)), set(-kWeightError)),
                        hn::Gt(hn::Min(height_square, base_square),
                               hn::Mul(set(kThin), hn::Max(side_square, base_square)))),
                hn::Lt(squared_length(away), hn::Mul(set(kFar), base_square)));
    const auto is_tried = [&](DoubleVector weight) HWY_ATTR {
      return hn::Or(hn::Not(is_outside), hn::Le(weight, set(kWeightError)));
    };
    const Vector on_base = on_segment(a, base, b, away_along);
    const Vector on_side = on_segment(a, side, c, hn::Div(dot(away, side), side_square));
    const Vector last = minus(c, b);
    const Vector on_last =
        on_segment(b, last, c, hn::Div(dot(minus(origin, b), last), squared_length(last)));
    Nearest nearest{a, set(std::numeric_limits<double>::infinity())};
    nearest.consider(on_base, is_tried(weight_c));
    nearest.consider(on_side, is_tried(weight_b));
    nearest.consider(on_last, is_tried(weight_a));

    Closest found;
    found.point = select(is_inside, foot, nearest.best);
    // The first of these that it is.
    found.corners = set(7);
    const auto of_place = [&](const Vector& place, double corners) HWY_ATTR {
      found.corners = hn::IfThenElse(equal(found.point, place), set(corners), found.corners);
    };
    of_place(on_last, 6);
    of_place(on_side, 5);
    of_place(on_base, 3);
    of_place(c, 4);
    of_place(b, 2);
    of_place(a, 1);
    // Nor is a weight infinite or NaN, as for collinear corners.
    const DoubleVector weights =
        hn::Add(hn::Add(hn::Abs(weight_a), hn::Abs(weight_b)), hn::Abs(weight_c));
    found.is_known = hn::And(hn::Ge(base_square, set(kShortestSquare)),
                             hn::Lt(weights, set(std::numeric_limits<double>::infinity())));
    return found;
  }

  // What unit_normal() says, where it has no need of more than double.
  struct Normal {
    Vector normal;
    DoubleMask is_known;
  };
  static HWY_INLINE Normal unit_normal_of(const Vector (&corner)[3]) {
    const DoubleVector scale =
        power_to_one(hn::Max(set(std::numeric_limits<double>::min()), largest(corner)));
    const Vector at = times(scale, corner[0]);
    const Vector first = minus(times(scale, corner[1]), at);
    const Vector second = minus(times(scale, corner[2]), at);
    const Vector across = cross(first, second);
    const DoubleVector product = hn::Mul(largest(first), largest(second));
    const DoubleVector size = largest(across);
    const Vector scaled = times(power_to_one(size), across);
    return {over(scaled, hn::Sqrt(squared_length(scaled))),
            hn::And(hn::Ge(size, hn::Mul(product, set(kNearlyCollinear))), hn::Gt(size, set(0)))};
  }

  // See PlacedCast.
  HWY_INLINE void place(Vector (&corner)[3]) const {
    const PlacedCast& placed = *query_.placed;
    const AffineMap& map = placed.to_world;
    for (Vector& at : corner) {
      Vector image;
      for (std::size_t i = 0; i < 3; ++i) {
        const auto row = static_cast<Eigen::Index>(i);
        image.at[i] = set(map.translation[row]);
        for (std::size_t k = 0; k < 3; ++k) {
          const double entry = map.linear(row, static_cast<Eigen::Index>(k));
          image.at[i] = hn::Add(image.at[i], hn::Mul(set(entry), at.at[k]));
        }
      }
      at = image;
    }
    if (placed.is_mirror) std::swap(corner[1], corner[2]);
  }

  // Bit i: triangle first + i does not touch the sphere, or it does and what is stored of it holds.
  // The others are for CastQuery::test().
  struct Found {
    std::uint32_t apart, touching;
  };
  HWY_INLINE Found find(std::uint32_t first) {
    const Doubles d;
    const DoubleVector zero = set(0);
    Vector compared[3];
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) compared[c].at[k] = hn::Load(d, in_tree_[c][k] + first);
    }
    if (query_.placed != nullptr) place(compared);
    const Vector center{{set(center_[0]), set(center_[1]), set(center_[2])}};
    const Vector corner[3] = {minus(compared[0], center), minus(compared[1], center),
                              minus(compared[2], center)};
    const Closest closest = closest_to_origin(corner);
    const double radius = query_.moving.shape.radius, doubt = query_.moving.doubt;

    // See closest_points().
    const DoubleVector max_abs = largest(corner);
    const DoubleVector length = hn::Sqrt(squared_length(closest.point));
    const DoubleVector off =
        hn::Add(hn::Mul(set(kPointDistanceError), max_abs), set(kSeparationUnderflow));
    // Not only to within the doubt: then the bounds touch, too.
    const auto is_touch = hn::Le(hn::Add(length, off), set(radius));
    // As core_distance() sees it: then no step of first_touch() ends in a touch.
    const auto is_apart =
        hn::And(closest.is_known, hn::Gt(hn::Sub(length, off), set(radius + 2 * doubt)));

    // See penetration_of_core().
    const DoubleVector error = hn::Add(set(4 * doubt), hn::Mul(set(kDepthError), max_abs));
    const Vector axis = over(minus({{zero, zero, zero}}, closest.point), length);
    const DoubleVector on_a = dot(axis, corner[0]), on_b = dot(axis, corner[1]),
                       on_c = dot(axis, corner[2]);
    const DoubleVector high = hn::Max(hn::Max(on_a, on_b), on_c);
    const DoubleVector back = hn::Sub(zero, hn::Min(hn::Min(on_a, on_b), on_c));
    const auto is_back = hn::Lt(back, hn::Sub(high, error));
    const DoubleVector depth = hn::IfThenElse(is_back, back, high);
    const Vector normal = select(is_back, negative(axis), axis);
    const auto is_clear =
        hn::And(hn::Gt(length, set(2 * doubt)), hn::Le(depth, hn::Sub(error, length)));
    const Normal front = unit_normal_of(compared);
    const Vector face_normal =
        select(hn::Lt(dot(front.normal, normal), zero), negative(front.normal), front.normal);

    store(closest.point, point_, first);
    store(normal, normal_, first);
    store(face_normal, face_normal_, first);
    const DoubleVector inside = hn::Add(set(radius), depth);
    hn::Store(hn::IfThenElse(hn::Gt(inside, zero), inside, zero), d, depth_ + first);
    hn::Store(closest.corners, d, corners_ + first);
    const auto is_touching =
        hn::And(hn::And(closest.is_known, front.is_known), hn::And(is_touch, is_clear));
    return {bits_of(d, is_apart), bits_of(d, is_touching)};
  }

  CastQuery& query_;
  Eigen::Vector3d center_;
  bool are_wanted_;
  std::uint32_t count_ = 0;
  HWY_ALIGN double in_tree_[3][3][kMost];  // [corner][axis]
  std::uint32_t face_[kMost], half_[kMost];
  HWY_ALIGN Stored point_, normal_, face_normal_;
  HWY_ALIGN double depth_[kMost];
  HWY_ALIGN double corners_[kMost];
  CastCandidate touch_;
};

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
