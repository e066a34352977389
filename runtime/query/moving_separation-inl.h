// SPDX-License-Identifier: MIT
// When a moving shape may touch boxes and triangles, in single precision: see moving_shape.h for
// why any direction will do.
#if defined(BOXTREE_RUNTIME_QUERY_MOVING_SEPARATION_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_QUERY_MOVING_SEPARATION_INL_H
#undef BOXTREE_RUNTIME_QUERY_MOVING_SEPARATION_INL_H
#else
#define BOXTREE_RUNTIME_QUERY_MOVING_SEPARATION_INL_H
#endif

#include <limits>

#include "runtime/primitive/rounding.h"
#include "runtime/query/cast_filter.h"
#include "runtime/query/triangle_distance-inl.h"
#include "runtime/walk/leaf-inl.h"
#include "runtime/walk/vector3-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if HWY_TARGET != HWY_SCALAR

/// A moving shape and what it is compared with along a vector: their projections overlap from
/// `ahead` / speed to `behind` / speed on, in units of the vector's length, where `ahead` may be
/// too small and `behind` too large, but not the other way round. The speed is known to within
/// `doubt`.
struct Gap {
  /// `first`, `last`: likewise, for a speed of any sign. `size`: the sum of the vector's
  /// magnitudes, of which its speed may be off by 8 u.
  HWY_INLINE Gap(FloatVector first, FloatVector last, FloatVector along, FloatVector size) {
    const Floats d;
    const auto is_against = hn::Lt(along, hn::Zero(d));
    ahead = hn::IfThenElse(is_against, hn::Neg(last), first);
    behind = hn::IfThenElse(is_against, hn::Neg(first), last);
    speed = hn::Abs(along);
    doubt = hn::Mul(size, hn::Set(d, static_cast<float>(8 * kRoundoffF32)));
  }

  /// Whether the shape is before the other, and comes nearer.
  [[nodiscard]] HWY_INLINE hn::Mask<Floats> is_ahead() const {
    return hn::And(hn::Gt(ahead, hn::Zero(Floats())), hn::Gt(speed, doubt));
  }

  FloatVector ahead, behind, speed, doubt;
};

/// From when to when a shape may touch what it is compared with: what some direction separates is
/// cut off.
class MovingInterval {
 public:
  MovingInterval() : enter_(hn::Zero(Floats())), leave_(hn::Set(Floats(), kInfinity)) {}

  HWY_INLINE void cut(const Gap& gap) {
    const Floats d;
    const FloatVector zero = hn::Zero(d);
    const FloatVector later = hn::Div(gap.ahead, hn::Add(gap.speed, gap.doubt));
    enter_ = hn::Max(enter_, hn::IfThenElse(hn::Gt(gap.ahead, zero), later, zero));
    // What is behind comes back no sooner than by what the speed is off.
    const FloatVector slowest = hn::Sub(gap.speed, gap.doubt);
    const auto is_moving = hn::Gt(slowest, zero);
    const FloatVector since = hn::Div(gap.behind, hn::IfThenElse(is_moving, slowest, gap.doubt));
    leave_ = hn::Min(leave_, hn::IfThenElse(is_moving, since, hn::Set(d, kInfinity)));
    enter_ = hn::Max(enter_, hn::IfThenElse(is_moving, zero, hn::Neg(since)));
  }

  /// By an axis of the shape; the range of what it is compared with.
  HWY_INLINE void cut(const AxisMotion& motion, FloatVector low, FloatVector high) {
    const Floats d;
    const FloatVector ahead = motion.is_against ? hn::Neg(high) : low;
    const FloatVector behind = motion.is_against ? hn::Neg(low) : high;
    const FloatVector reach = hn::Set(d, motion.extent);
    enter_ = hn::Max(enter_, hn::Mul(hn::Sub(ahead, reach), hn::Set(d, motion.per_ahead)));
    if (motion.per_behind == 0) {
      enter_ =
          hn::Max(enter_, hn::Mul(hn::Neg(hn::Add(behind, reach)), hn::Set(d, motion.per_return)));
      return;
    }
    leave_ = hn::Min(leave_, hn::Mul(hn::Add(behind, reach), hn::Set(d, motion.per_behind)));
  }

  /// How long nothing touches, rounded down.
  [[nodiscard]] HWY_INLINE FloatVector enter() const {
    return hn::Mul(enter_, hn::Set(Floats(), static_cast<float>(1 - 8 * kRoundoffF32)));
  }
  /// Whether something may touch then.
  [[nodiscard]] HWY_INLINE hn::Mask<Floats> is_left() const {
    return hn::Le(hn::Mul(enter_, hn::Set(Floats(), static_cast<float>(1 - 16 * kRoundoffF32))),
                  leave_);
  }

 private:
  static constexpr float kInfinity = std::numeric_limits<float>::infinity();
  FloatVector enter_, leave_;
};

/// Sums of magnitudes.
[[nodiscard]] HWY_INLINE FloatVector size_of(const Vector3& v) {
  return hn::Add(hn::Add(hn::Abs(v.at[0]), hn::Abs(v.at[1])), hn::Abs(v.at[2]));
}

/// The shape of a filter, for vectors.
class MovingFloats {
 public:
  explicit MovingFloats(const CastFilter& filter) : filter_(filter) {}

  /// Where the center is at s.
  [[nodiscard]] HWY_INLINE Vector3 center_at(FloatVector s) const {
    const Floats d;
    const Vector3 direction = this->direction();
    Vector3 center;
    for (std::size_t k = 0; k < 3; ++k) {
      center.at[k] = hn::MulAdd(s, direction.at[k], hn::Set(d, filter_.origin[k]));
    }
    return center;
  }
  [[nodiscard]] HWY_INLINE Vector3 direction() const { return spread(filter_.direction); }
  [[nodiscard]] HWY_INLINE Vector3 axis(std::uint32_t i) const {
    return spread(filter_.core.axis[i]);
  }
  [[nodiscard]] HWY_INLINE FloatVector half(std::uint32_t i) const {
    return hn::Set(Floats(), filter_.core.half[i]);
  }
  [[nodiscard]] std::uint32_t axes() const { return filter_.core.count; }
  [[nodiscard]] bool is_negative(std::uint32_t i, std::size_t k) const {
    return filter_.core.axis[i][k] < 0;
  }
  [[nodiscard]] const AxisMotion& motion(std::uint32_t i) const { return filter_.motion[i]; }
  /// By how much a projection on a vector is off, for each unit of the sum of its magnitudes.
  [[nodiscard]] float error() const { return 3 * filter_.error; }

  /// How far it reaches along a vector, times its length, and more than products lose that
  /// underflow.
  [[nodiscard]] HWY_INLINE FloatVector reach(const Vector3& v, FloatVector length) const {
    constexpr float kUnderflow = 64 * std::numeric_limits<float>::min();
    const Floats d;
    FloatVector reach = hn::MulAdd(length, hn::Set(d, filter_.radius), hn::Set(d, kUnderflow));
    for (std::uint32_t i = 0; i < axes(); ++i) {
      reach = hn::MulAdd(hn::Abs(dot(v, axis(i))), half(i), reach);
    }
    return reach;
  }

  /// Whether points are surely inside the shape at rest, whose inside is known. `error`: how
  /// far their coordinates may be off, and more than the distance from the core rounds. Halves have
  /// been rounded up.
  [[nodiscard]] HWY_NOINLINE hn::Mask<Floats> hold(const Vector3& point, float error) const {
    constexpr float kDown = static_cast<float>(1 - 8 * kRoundoffF32);
    const Floats d;
    const InnerFloats& inside = filter_.inside;
    // What is found within 2 errors of the smaller core is within 4.
    const float smaller = inside.is_box ? 4 * error * inside.ratio + inside.less : 0;
    float within = inside.is_box ? 2 * error : inside.radius - 2 * error;
    Vector3 rest = point;
    for (std::uint32_t i = 0; i < axes(); ++i) {
      const float half = filter_.core.half[i] * kDown - smaller;
      if (!(half >= 0)) within = 0;
      const Vector3 axis = this->axis(i);
      const FloatVector along =
          hn::Min(hn::Max(dot(point, axis), hn::Set(d, -half)), hn::Set(d, half));
      for (std::size_t k = 0; k < 3; ++k) {
        rest.at[k] = hn::NegMulAdd(along, axis.at[k], rest.at[k]);
      }
    }
    within = std::max(within, 0.0f);
    return hn::Lt(dot(rest, rest), hn::Set(d, within * within * kDown));
  }

 private:
  [[nodiscard]] static HWY_INLINE Vector3 spread(const float* v) {
    const Floats d;
    return {{hn::Set(d, v[0]), hn::Set(d, v[1]), hn::Set(d, v[2])}};
  }

  const CastFilter& filter_;
};

/// Boxes, seen from the shape's centers at `s`.
class MovingBoxes {
 public:
  HWY_INLINE MovingBoxes(const MovingFloats& shape, const VectorBox& box, FloatVector s)
      : shape_(shape) {
    const Vector3 center = shape.center_at(s);
    for (std::size_t k = 0; k < 3; ++k) {
      low_.at[k] = hn::Sub(box.low[k], center.at[k]);
      high_.at[k] = hn::Sub(box.high[k], center.at[k]);
    }
  }

  /// Of the vector to each box from the center of the shape.
  [[nodiscard]] HWY_INLINE Gap gap_along_way() const {
    const Floats d;
    const FloatVector zero = hn::Zero(d);
    Vector3 way;
    for (std::size_t k = 0; k < 3; ++k) {
      way.at[k] = hn::Add(hn::Max(zero, low_.at[k]), hn::Min(zero, high_.at[k]));
    }
    // Where the square underflows, there is no gap.
    const FloatVector squared = dot(way, way), size = size_of(way);
    const FloatVector reach =
        hn::MulAdd(size, hn::Set(d, shape_.error()), shape_.reach(way, hn::Sqrt(squared)));
    return {hn::Sub(squared, reach), hn::Set(d, std::numeric_limits<float>::infinity()),
            dot(way, shape_.direction()), size};
  }

  HWY_INLINE void cut_by_axes(MovingInterval& interval) const {
    for (std::uint32_t i = 0; i < shape_.axes(); ++i) {
      const Vector3 v = shape_.axis(i);
      FloatVector low = hn::Zero(Floats()), high = low;
      for (std::size_t k = 0; k < 3; ++k) {
        const bool is_negative = shape_.is_negative(i, k);
        low = hn::MulAdd(v.at[k], (is_negative ? high_ : low_).at[k], low);
        high = hn::MulAdd(v.at[k], (is_negative ? low_ : high_).at[k], high);
      }
      interval.cut(shape_.motion(i), low, high);
    }
  }

 private:
  const MovingFloats& shape_;
  Vector3 low_, high_;
};

/// Triangles of a part of a leaf, seen from the shape's centers at `s`.
///
/// A projection on a vector v is off by the sum of its magnitudes times what coordinates are off
/// by, see CastFilter, and by 8u of the largest coordinate, which is less.
class MovingTriangles {
 public:
  HWY_INLINE MovingTriangles(const CastFilter& filter, const LeafFloats& leaf, std::size_t group,
                             std::size_t part, FloatVector s)
      : shape_(filter),
        error_(hn::Set(Floats(), shape_.error() + leaf.corner_error())),
        corner_error_(hn::Set(Floats(), leaf.corner_error())) {
    const Vector3 center = shape_.center_at(s);
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        corner_[i].at[k] = hn::Sub(leaf.at(i, k, group, part), center.at[k]);
      }
    }
  }

  /// Relative to the shape's center.
  [[nodiscard]] HWY_INLINE const Vector3& corner(std::size_t i) const { return corner_[i]; }

  /// Of v. A call for each: inline, they take 4 KB more and 3 % of a cast less.
  [[nodiscard]] HWY_NOINLINE Gap gap_along(const Vector3& v) const {
    const FloatVector a = dot(v, corner_[0]), b = dot(v, corner_[1]), c = dot(v, corner_[2]);
    const FloatVector size = size_of(v);
    // The sum of magnitudes, which is no less, where the length has no square.
    constexpr float kLeastSquare = 0x1p-100f;
    const Floats d;
    const FloatVector square = dot(v, v);
    const FloatVector length =
        hn::IfThenElse(hn::Gt(square, hn::Set(d, kLeastSquare)), hn::Sqrt(square), size);
    const FloatVector reach = hn::MulAdd(size, error_, shape_.reach(v, length));
    return {hn::Sub(hn::Min(a, hn::Min(b, c)), reach), hn::Add(hn::Max(a, hn::Max(b, c)), reach),
            dot(v, shape_.direction()), size};
  }

  /// By the normals of the triangles and the axes of a box.
  HWY_INLINE void cut_by_faces(MovingInterval& interval) const {
    interval.cut(gap_along(cross(edge(0), edge(1))));
    if (shape_.axes() == 3) {
      for (std::uint32_t i = 0; i < shape_.axes(); ++i) {
        const Vector3 v = shape_.axis(i);
        const FloatVector a = dot(v, corner_[0]), b = dot(v, corner_[1]), c = dot(v, corner_[2]);
        // What corners are off in addition to boxes.
        const FloatVector off = hn::Mul(size_of(v), corner_error_);
        interval.cut(shape_.motion(i), hn::Sub(hn::Min(a, hn::Min(b, c)), off),
                     hn::Add(hn::Max(a, hn::Max(b, c)), off));
      }
    }
  }
  /// By what is orthogonal to an edge of each.
  HWY_INLINE void cut_by_edges(MovingInterval& interval) const {
    const Vector3 edges[3] = {edge(0), edge(1), edge(2)};
    for (std::uint32_t n = 0; n < 3 * shape_.axes(); ++n) {
      interval.cut(gap_along(cross(edges[n % 3], shape_.axis(n / 3))));
    }
  }

  /// From the core to the triangles, as nearly as one projection after the other gets there.
  /// `offset`: from the center to the point of the core at which the search begins, and then to
  /// that which it finds.
  [[nodiscard]] HWY_NOINLINE Vector3 way_from_core(Vector3& offset) const {
    if (shape_.axes() == 0) return way_from(offset);
    const Floats d;
    const Vector3 way = way_from(offset);
    // To the point of the core that is closest to where that way ends.
    const Vector3 end{{hn::Add(offset.at[0], way.at[0]), hn::Add(offset.at[1], way.at[1]),
                       hn::Add(offset.at[2], way.at[2])}};
    for (std::size_t k = 0; k < 3; ++k) offset.at[k] = hn::Zero(d);
    for (std::uint32_t i = 0; i < shape_.axes(); ++i) {
      const Vector3 axis = shape_.axis(i);
      const FloatVector half = shape_.half(i);
      const FloatVector along = hn::Min(hn::Max(dot(end, axis), hn::Neg(half)), half);
      for (std::size_t k = 0; k < 3; ++k) {
        offset.at[k] = hn::MulAdd(along, axis.at[k], offset.at[k]);
      }
    }
    return minus(end, offset);
  }

 private:
  // From a point to about the closest of each triangle: that of its plane, or of an edge where the
  // plane's is outside.
  [[nodiscard]] HWY_INLINE Vector3 way_from(const Vector3& point) const {
    const Floats d;
    const FloatVector zero = hn::Zero(d);
    const Vector3 e1 = edge(0), e2 = minus(corner_[2], corner_[0]), e3 = edge(1);
    const Vector3 w = minus(point, corner_[0]), w1 = minus(point, corner_[1]);
    const Vector3 n = cross(e1, e2);
    const FloatVector area1 = dot(n, cross(w, e2)), area2 = dot(n, cross(e1, w));
    const FloatVector area3 = dot(n, cross(e3, w1));
    const auto is_outside = hn::Lt(hn::Min(area1, hn::Min(area2, area3)), zero);
    Vector3 rest = from_segment(w, e1);
    FloatVector squared = dot(rest, rest);
    const auto consider = [&](const Vector3& of_edge) {
      const FloatVector other = dot(of_edge, of_edge);
      const auto is_nearer = hn::Lt(other, squared);
      squared = hn::IfThenElse(is_nearer, other, squared);
      for (std::size_t k = 0; k < 3; ++k) {
        rest.at[k] = hn::IfThenElse(is_nearer, of_edge.at[k], rest.at[k]);
      }
    };
    consider(from_segment(w, e2));
    consider(from_segment(w1, e3));
    const FloatVector height =
        hn::Div(dot(n, w), hn::Max(dot(n, n), hn::Set(d, std::numeric_limits<float>::min())));
    Vector3 way;
    for (std::size_t k = 0; k < 3; ++k) {
      way.at[k] = hn::Neg(hn::IfThenElse(is_outside, rest.at[k], hn::Mul(height, n.at[k])));
    }
    return way;
  }

  [[nodiscard]] HWY_INLINE Vector3 edge(std::uint32_t e) const {
    return minus(corner_[(e + 1) % 3], corner_[e]);
  }

  MovingFloats shape_;
  Vector3 corner_[3];
  FloatVector error_, corner_error_;
};

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
