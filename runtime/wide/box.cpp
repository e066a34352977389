// SPDX-License-Identifier: MIT
// Boxes over the wide codecs.
#include <boxtree/runtime/query/erased_codec.h>
#include <boxtree/runtime/query/shape_query.h>
#include <boxtree/runtime/wide/targets.h>
#include <boxtree/runtime/wide/walks.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "boxtree/runtime/wide/box.cpp"
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include <boxtree/runtime/wide/overlap-inl.h>

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
Errc walk_box(const Tree& tree, FaceWalk<BoxQuery>& faces) {
  return traverse_overlap(tree, ErasedCodec{&tree}, faces);
}
#else
class BoxFilter {
 public:
  // Decoded boxes are exact; triangles were rounded to float.
  BoxFilter(const Tree& tree, const BoxQuery& query) {
    const double error = reach_of(tree).maxCoeff() * std::numeric_limits<float>::epsilon() +
                         double{std::numeric_limits<float>::min()};
    for (std::size_t k = 0; k < 3; ++k) {
      const auto axis = static_cast<Eigen::Index>(k);
      low_[k] = float_below(query.low[axis] - error);
      high_[k] = float_above(query.high[axis] + error);
      inner_low_[k] = float_above(query.low[axis] + error);
      inner_high_[k] = float_below(query.high[axis] - error);
    }
  }

  HWY_INLINE Verdict judge(const VectorBox& box) const {
    const Floats d;
    auto touched =
        hn::And(hn::Le(box.low[0], hn::Set(d, high_[0])), hn::Ge(box.high[0], hn::Set(d, low_[0])));
    for (std::size_t k = 1; k < 3; ++k) {
      touched = hn::And(touched, hn::And(hn::Le(box.low[k], hn::Set(d, high_[k])),
                                         hn::Ge(box.high[k], hn::Set(d, low_[k]))));
    }
    return {bits_of(touched), bits_of(contained(box.low, box.high))};
  }

  HWY_INLINE std::uint32_t contained(const FloatVector (&point)[3]) const {
    return bits_of(contained(point, point));
  }

 private:
  HWY_INLINE hn::Mask<Floats> contained(const FloatVector (&low)[3],
                                        const FloatVector (&high)[3]) const {
    const Floats d;
    auto inside = hn::And(hn::Ge(low[0], hn::Set(d, inner_low_[0])),
                          hn::Le(high[0], hn::Set(d, inner_high_[0])));
    for (std::size_t k = 1; k < 3; ++k) {
      inside = hn::And(inside, hn::And(hn::Ge(low[k], hn::Set(d, inner_low_[k])),
                                       hn::Le(high[k], hn::Set(d, inner_high_[k]))));
    }
    return inside;
  }

  std::array<float, 3> low_, high_;
  std::array<float, 3> inner_low_, inner_high_;
};

Errc walk_box(const Tree& tree, FaceWalk<BoxQuery>& faces) {
  return with_wide_codec<Errc>(
      tree, [&](const auto& codec) { return walk<BoxFilter>(tree, codec, faces); });
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxtree {
namespace {

HWY_EXPORT(walk_box);

}  // namespace

Errc walk_wide(const Tree& tree, FaceWalk<BoxQuery>& walk) {
  if (tree.has_nodes()) {
    return HWY_DYNAMIC_DISPATCH(walk_box)(tree, walk);
  }
  return traverse_overlap(tree, ErasedCodec{&tree}, walk);
}

}  // namespace boxtree
#endif
