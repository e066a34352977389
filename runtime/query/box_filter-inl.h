// SPDX-License-Identifier: MIT
// A box query in vectors of float.
#if defined(BOXTREE_RUNTIME_QUERY_BOX_FILTER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_QUERY_BOX_FILTER_INL_H
#undef BOXTREE_RUNTIME_QUERY_BOX_FILTER_INL_H
#else
#define BOXTREE_RUNTIME_QUERY_BOX_FILTER_INL_H
#endif

#include <limits>

#include "runtime/primitive/rounding.h"
#include "runtime/query/shape_query.h"
#include "runtime/walk/box_bounds-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if HWY_TARGET != HWY_SCALAR

class BoxFilter {
 public:
  // Decoded boxes are exact; triangles were rounded to float.
  BoxFilter(const BoundTree& tree, const BoxQuery& query) {
    const double error =
        tree.largest_abs() * 2 * kRoundoffF32 + double{std::numeric_limits<float>::min()};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      bounds_.set(k, query.low[axis], query.high[axis], error);
    }
  }

  HWY_INLINE Classification classify(const VectorBox& box) const { return bounds_.classify(box); }
  HWY_INLINE Classification classify(const VectorTriangle& triangle) const {
    return classify_corners(bounds_, triangle);
  }

 private:
  BoxBounds bounds_;
};

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
