// SPDX-License-Identifier: MIT
// What rays need to meet the boxes and triangles of a tree, computed for several side by side: the
// numbers of RayInTree and RayFilter, by the same operations.
#if defined(BOXTREE_RUNTIME_QUERY_RAY_SET_UP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_QUERY_RAY_SET_UP_INL_H
#undef BOXTREE_RUNTIME_QUERY_RAY_SET_UP_INL_H
#else
#define BOXTREE_RUNTIME_QUERY_RAY_SET_UP_INL_H
#endif

#include <bit>
#include <span>

#include "runtime/query/ray_filter.h"
#include "runtime/query/ray_query.h"
#include "runtime/walk/node-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if HWY_TARGET != HWY_SCALAR

/// Rays of one tree, up to sixteen at a time.
class RaySetUp {
 public:
  static constexpr std::size_t kMost = 16;

  explicit RaySetUp(const BoundTree& tree)
      : tree_(tree),
        farthest_(RayFilter::farthest_origin(tree)),
        planes_above_(RaySlab::power_above(tree.largest_abs())),
        rounding_(RayFilter::rounding(tree.largest_abs(), tree.depth())) {}

  /// Whether set_up() takes rays of the tree.
  [[nodiscard]] static bool takes(const BoundTree& tree) {
    return std::abs(tree.scale_exponent()) <= kLargestExponent;
  }

  /// Prepares as many rays as there are, kMost at most.
  void set_up(std::span<const Ray> rays) {
    // Whole vectors: what is behind the last ray is the last ray.
    const std::size_t lanes = (rays.size() + kDoubles - 1) / kDoubles * kDoubles;
    for (std::size_t i = 0; i < lanes; ++i) {
      const Ray& ray = rays[std::min(i, rays.size() - 1)];
      for (std::size_t k = 0; k < 3; ++k) {
        origin_[k][i] = ray.origin[static_cast<Eigen::Index>(k)];
        direction_[k][i] = ray.direction[static_cast<Eigen::Index>(k)];
      }
      t_min_[i] = ray.t_min;
      t_max_[i] = ray.t_max;
    }
    const std::uint32_t all = (1u << rays.size()) - 1;
    taken_ = entering_ = 0;
    for (std::size_t i = 0; i < lanes; i += kDoubles) set_up(i);
    taken_ &= all;
    entering_ &= taken_;
  }

  /// Bit i: of ray i the numbers are known. Others are invalid, or so short, long or far away that
  /// they are looked at one by one.
  [[nodiscard]] std::uint32_t taken() const { return taken_; }
  /// Bit i: it is one of these and enters the root box.
  [[nodiscard]] std::uint32_t entering() const { return entering_; }

  /// Of such a ray.
  void get(std::uint32_t i, RayFilter& filter) const {
    filter.start = start_[i];
    filter.error = float_above(error_[i]);
    for (std::size_t k = 0; k < AxisLanes::kCount; ++k) {
      const std::size_t axis = std::min<std::size_t>(k, 2);
      filter.origin[k] = from_[axis][i];
      filter.inverse[k] = inverse_[axis][i];
      filter.margin[k] = filter.error * std::abs(filter.inverse[k]);
      filter.margins[k] = 2 * filter.margin[k];
      filter.near_high[k] = filter.inverse[k] < 0 ? 1 : 0;
    }
    const std::size_t z = main_axis_[i];
    filter.axis_z = z;
    filter.axis_x = z == 2 ? 0 : z + 1;
    filter.axis_y = z == 0 ? 2 : z - 1;
    filter.shear_x = shear_[0][i];
    filter.shear_y = shear_[1][i];
    filter.shear_z = shear_[2][i];
  }
  /// Its t_max, in parameters of the tree.
  [[nodiscard]] double t_max(std::uint32_t i) const { return t_max_[i]; }

  /// What such a ray needs to meet decoded boxes. It meets plane p of an axis at p * inverse +
  /// offset; the near and the far plane of a box each have an offset that widens the box.
  [[nodiscard]] float inverse(std::size_t axis, std::uint32_t i) const { return inverse_[axis][i]; }
  [[nodiscard]] float near_offset(std::size_t axis, std::uint32_t i) const {
    return near_offset_[axis][i];
  }
  [[nodiscard]] float far_offset(std::size_t axis, std::uint32_t i) const {
    return far_offset_[axis][i];
  }
  /// 1 where the high plane of a box is the near one, else 0.
  [[nodiscard]] std::uint32_t near_high(std::size_t axis, std::uint32_t i) const {
    return std::bit_cast<std::uint32_t>(inverse_[axis][i]) >> 31;
  }
  /// The parameters, of such a ray, above which nothing can improve its answer: aligned, kMost.
  [[nodiscard]] const float* bounds() const { return bound_; }

 private:
  using Doubles = hn::CappedTag<double, 8>;
  using DoubleVector = hn::Vec<Doubles>;
  static constexpr std::size_t kDoubles = hn::MaxLanes(Doubles());
  using Words = hn::Rebind<std::uint64_t, Doubles>;
  using Halves = hn::Rebind<float, Doubles>;
  using DoubleMask = hn::Mask<Doubles>;

  // So that no exponent of a length, or of a tree, or their difference leaves those of normal
  // numbers.
  static constexpr int kLargestExponent = 500;

  static HWY_INLINE std::uint32_t bits(DoubleMask mask, std::size_t first) {
    return bits_of(Doubles(), mask) << first;
  }
  static HWY_INLINE void store(DoubleVector x, float* out) {
    hn::Store(hn::DemoteTo(Halves(), x), Halves(), out);
  }

  HWY_INLINE void set_up(std::size_t i) {
    const Doubles d;
    const auto set = [&](double x) { return hn::Set(d, x); };
    const DoubleVector zero = hn::Zero(d);

    // As invalid_field() and RayInTree. Comparisons are false for NaN.
    DoubleVector magnitude[3], direction[3], origin[3];
    DoubleVector length = zero, origin_max = zero;
    DoubleMask taken = hn::Eq(zero, zero);
    constexpr double kLongest = 0x1p500, kShortest = 0x1p-500;
    static_assert(kLargestExponent == 500);
    for (std::size_t k = 0; k < 3; ++k) {
      direction[k] = hn::Load(d, direction_[k] + i);
      magnitude[k] = hn::Abs(direction[k]);
      taken = hn::And(taken, hn::Le(magnitude[k], set(kLongest)));
      length = hn::Max(length, magnitude[k]);
      origin[k] = hn::Mul(hn::Sub(hn::Load(d, origin_[k] + i), set(tree_.frame().origin_lanes[k])),
                          set(tree_.frame().inverse_scale));
      const DoubleVector far = hn::Abs(origin[k]);
      taken = hn::And(taken, hn::Le(far, set(farthest_)));
      origin_max = hn::Max(origin_max, far);
    }
    DoubleVector t_min = hn::Load(d, t_min_ + i), t_max = hn::Load(d, t_max_ + i);
    taken = hn::And(taken, hn::And(hn::Ge(length, set(kShortest)),
                                   hn::And(hn::Ge(t_min, zero), hn::Le(t_min, t_max))));

    const Words words;
    const auto exponent = hn::ShiftRight<52>(hn::BitCast(words, length));  // biased by 1022
    const auto power = [&](auto biased) { return hn::BitCast(d, hn::ShiftLeft<52>(biased)); };
    const DoubleVector to_one = power(hn::Sub(hn::Set(words, 1022 + 1023), exponent));
    const DoubleVector to_tree = power(
        hn::Sub(exponent, hn::Set(words, static_cast<std::uint64_t>(tree_.scale_exponent() - 1))));
    t_min = hn::Mul(t_min, to_tree);
    t_max = hn::Mul(t_max, to_tree);
    hn::Store(t_max, d, t_max_ + i);

    // As RaySlab.
    DoubleVector inverse[3];
    const DoubleVector margin =
        hn::Mul(set(8 * kRoundoffF64), hn::Add(origin_max, set(planes_above_)));
    DoubleVector enter = set(-std::numeric_limits<double>::infinity());
    DoubleVector leave = set(std::numeric_limits<double>::infinity());
    for (std::size_t k = 0; k < 3; ++k) {
      direction[k] = hn::Mul(direction[k], to_one);
      inverse[k] = hn::Max(set(-RaySlab::kHuge),
                           hn::Min(set(RaySlab::kHuge), hn::Div(set(1), direction[k])));
      const DoubleVector low =
          hn::Mul(hn::Sub(set(tree_.root_lanes().low[k]), hn::Add(origin[k], margin)), inverse[k]);
      const DoubleVector high =
          hn::Mul(hn::Sub(set(tree_.root_lanes().high[k]), hn::Sub(origin[k], margin)), inverse[k]);
      enter = hn::Max(enter, hn::Min(low, high));
      leave = hn::Min(leave, hn::Max(low, high));
    }
    const auto meets = hn::And(hn::And(hn::Le(enter, leave), hn::Ge(leave, t_min)),
                               hn::And(hn::Le(enter, t_max), hn::Lt(enter, set(kInfinity))));
    taken_ |= bits(taken, i);
    const std::uint32_t entering = bits(hn::And(taken, meets), i);
    if (entering == 0) return;
    entering_ |= entering;

    // As RayFilter.
    const DoubleVector start = hn::Max(enter, t_min);
    hn::Store(start, d, start_ + i);
    hn::Store(hn::Add(set(rounding_), hn::Mul(set(RayFilter::kGivenAway),
                                              hn::Add(origin_max, set(tree_.largest_abs())))),
              d, error_ + i);
    const Halves f;
    // Not below the filter's, which rounds to the next float: by two roundings up to nearest.
    const auto above = [&](DoubleVector x) {
      return hn::DemoteTo(f, hn::Mul(x, set(1 + 2 * kRoundoffF32)));
    };
    const auto error = above(hn::Load(d, error_ + i));
    // As RayBoxFilter::bound().
    const auto bound = hn::Add(hn::Mul(above(hn::Max(zero, hn::Sub(t_max, start))),
                                       hn::Set(f, static_cast<float>(1 + 8 * kRoundoffF32))),
                               hn::Mul(hn::Set(f, 4), error));
    hn::Store(bound, f, bound_ + i);
    for (std::size_t k = 0; k < 3; ++k) {
      const auto from = hn::DemoteTo(f, hn::Add(origin[k], hn::Mul(start, direction[k])));
      const auto within =
          hn::DemoteTo(f, hn::Max(hn::Min(inverse[k], set(RayFilter::kLargestInverse)),
                                  set(-RayFilter::kLargestInverse)));
      const auto offset = hn::Neg(hn::Mul(from, within));
      const auto widened = hn::Mul(error, hn::Abs(within));
      hn::Store(from, f, from_[k] + i);
      hn::Store(within, f, inverse_[k] + i);
      hn::Store(hn::Sub(offset, widened), f, near_offset_[k] + i);
      hn::Store(hn::Add(offset, widened), f, far_offset_[k] + i);
    }

    // As RayShear: the largest component is the main axis, the next two are in cyclic order.
    const auto y_larger = hn::Gt(magnitude[1], magnitude[0]);
    const auto z_largest = hn::Gt(magnitude[2], hn::Max(magnitude[0], magnitude[1]));
    const auto select = [&](DoubleVector if_x, DoubleVector if_y, DoubleVector if_z) {
      return hn::IfThenElse(z_largest, if_z, hn::IfThenElse(y_larger, if_y, if_x));
    };
    const DoubleVector along = select(direction[0], direction[1], direction[2]);
    store(hn::Div(select(direction[1], direction[2], direction[0]), along), shear_[0] + i);
    store(hn::Div(select(direction[2], direction[0], direction[1]), along), shear_[1] + i);
    store(select(inverse[0], inverse[1], inverse[2]), shear_[2] + i);
    hn::Store(hn::BitCast(words,
                          select(hn::BitCast(d, hn::Zero(words)), hn::BitCast(d, hn::Set(words, 1)),
                                 hn::BitCast(d, hn::Set(words, 2)))),
              words, main_axis_ + i);
  }

  static constexpr double kInfinity = std::numeric_limits<double>::infinity();

  const BoundTree& tree_;
  double farthest_;      // origins beyond it are not near
  double planes_above_;  // a power of two not below the largest plane
  double rounding_;      // of RayFilter
  std::uint32_t taken_ = 0, entering_ = 0;
  HWY_ALIGN double origin_[3][kMost];
  HWY_ALIGN double direction_[3][kMost];
  HWY_ALIGN double t_min_[kMost];
  HWY_ALIGN double t_max_[kMost];
  HWY_ALIGN double start_[kMost];
  HWY_ALIGN std::uint64_t main_axis_[kMost];
  HWY_ALIGN double error_[kMost];
  HWY_ALIGN float from_[3][kMost];
  HWY_ALIGN float inverse_[3][kMost];
  HWY_ALIGN float near_offset_[3][kMost];
  HWY_ALIGN float far_offset_[3][kMost];
  HWY_ALIGN float bound_[kMost];
  HWY_ALIGN float shear_[3][kMost];
};

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
