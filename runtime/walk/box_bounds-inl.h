// SPDX-License-Identifier: MIT
// The box of a query in vectors of float: finds what provably misses it and what is provably
// inside.
#if defined(BOXTREE_RUNTIME_WALK_BOX_BOUNDS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_WALK_BOX_BOUNDS_INL_H
#undef BOXTREE_RUNTIME_WALK_BOX_BOUNDS_INL_H
#else
#define BOXTREE_RUNTIME_WALK_BOX_BOUNDS_INL_H
#endif

#include "runtime/primitive/rounding.h"
#include "runtime/walk/overlap-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if HWY_TARGET != HWY_SCALAR

class BoxBounds {
 public:
  /// The bounds on one axis of the box of the query. What will be classified is off by at most
  /// `error` on that axis.
  void set(std::size_t axis, double low, double high, double error) {
    low_[axis] = float_below(low - error);
    high_[axis] = float_above(high + error);
    inner_low_[axis] = float_above(low + error);
    inner_high_[axis] = float_below(high - error);
  }

  HWY_INLINE Classification classify(const VectorBox& box) const {
    const Floats d;
    auto touched =
        hn::And(hn::Le(box.low[0], hn::Set(d, high_[0])), hn::Ge(box.high[0], hn::Set(d, low_[0])));
    for (std::size_t k = 1; k < 3; ++k) {
      touched = hn::And(touched, hn::And(hn::Le(box.low[k], hn::Set(d, high_[k])),
                                         hn::Ge(box.high[k], hn::Set(d, low_[k]))));
    }
    return {bits_of(touched), contained(box)};
  }

  /// Bit i: box i is inside the box of the query, provably.
  HWY_INLINE std::uint32_t contained(const VectorBox& box) const {
    const Floats d;
    auto inside = hn::And(hn::Ge(box.low[0], hn::Set(d, inner_low_[0])),
                          hn::Le(box.high[0], hn::Set(d, inner_high_[0])));
    for (std::size_t k = 1; k < 3; ++k) {
      inside = hn::And(inside, hn::And(hn::Ge(box.low[k], hn::Set(d, inner_low_[k])),
                                       hn::Le(box.high[k], hn::Set(d, inner_high_[k]))));
    }
    return bits_of(inside);
  }
  HWY_INLINE std::uint32_t contained(const VectorPoint& point) const {
    return contained(box_at(point));
  }

 private:
  std::array<float, 3> low_, high_;
  std::array<float, 3> inner_low_, inner_high_;
};

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
