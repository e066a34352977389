// SPDX-License-Identifier: MIT
// Decoded boxes of all children of a node, in vectors: the same bits as WideCodec::expand.
#if defined(BOXTREE_RUNTIME_WALK_DECODE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_WALK_DECODE_INL_H
#undef BOXTREE_RUNTIME_WALK_DECODE_INL_H
#else
#define BOXTREE_RUNTIME_WALK_DECODE_INL_H
#endif

#include "runtime/walk/node-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {

/// Boxes of eight children or triangles, as many as a vector holds.
struct VectorBox {
  FloatVector low[3];
  FloatVector high[3];
};

/// As many points, or triangles.
struct VectorPoint {
  FloatVector axis[3];
};
struct VectorTriangle {
  VectorPoint corner[3];
};

/// Points as boxes that have no extent.
HWY_INLINE VectorBox box_at(const VectorPoint& point) {
  return {{point.axis[0], point.axis[1], point.axis[2]},
          {point.axis[0], point.axis[1], point.axis[2]}};
}

HWY_INLINE VectorBox bounds_of(const VectorTriangle& triangle) {
  VectorBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    const FloatVector a = triangle.corner[0].axis[k];
    const FloatVector b = triangle.corner[1].axis[k];
    const FloatVector c = triangle.corner[2].axis[k];
    box.low[k] = hn::Min(a, hn::Min(b, c));
    box.high[k] = hn::Max(a, hn::Max(b, c));
  }
  return box;
}

/// The same in memory, all eight.
struct ChildBoxes {
  HWY_ALIGN float low[3][kWideChildren];
  HWY_ALIGN float high[3][kWideChildren];

  [[nodiscard]] Box<float> box(std::uint32_t i) const {
    return {{low[0][i], low[1][i], low[2][i]}, {high[0][i], high[1][i], high[2][i]}};
  }
};

/// Part `part` of the children of `node`, whose decoded box is `box`; also written to `out`.
/// One product and one sum, each rounded: the planes are part of the format. A box has low[axis]
/// and high[axis].
template <class Node, class AnyBox>
HWY_INLINE VectorBox decode(const NodeView<Node>& node, const AnyBox& box, std::size_t part,
                            ChildBoxes& out) {
  const Floats d;
  VectorBox boxes;
  for (std::size_t k = 0; k < 3; ++k) {
    const FloatVector step = hn::Set(d, wide_step<Node>(box.low[k], box.high[k]));
    boxes.low[k] = hn::Add(hn::Set(d, box.low[k]), hn::Mul(node.steps(0, k, part), step));
    boxes.high[k] = hn::Sub(hn::Set(d, box.high[k]), hn::Mul(node.steps(1, k, part), step));
    hn::Store(boxes.low[k], d, out.low[k] + part * kLanes);
    hn::Store(boxes.high[k], d, out.high[k] + part * kLanes);
  }
  return boxes;
}

}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
