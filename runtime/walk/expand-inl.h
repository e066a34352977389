// SPDX-License-Identifier: MIT
// The children of a node in doubles, decoded by vectors: the same numbers as ErasedCodec::expand.
#if defined(BOXTREE_RUNTIME_WALK_EXPAND_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_WALK_EXPAND_INL_H
#undef BOXTREE_RUNTIME_WALK_EXPAND_INL_H
#else
#define BOXTREE_RUNTIME_WALK_EXPAND_INL_H
#endif

#include "runtime/tree/bound_tree.h"
#include "runtime/walk/decode-inl.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/walk_tree.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if HWY_TARGET != HWY_SCALAR

using Doubles = hn::CappedTag<double, kWideChildren>;
using DoubleVector = hn::Vec<Doubles>;

/// As many boxes as a vector of doubles holds.
struct DoubleBoxes {
  DoubleVector low[3];
  DoubleVector high[3];
};

/// Counts a node and decodes its children. `use(first, boxes)`: called with all children, as many
/// at a time as a vector holds, the first of them number `first`. Precondition: has_float_nodes().
template <class Bound, class Use>
HWY_INLINE Errc expand_in_doubles(const BoundTree& tree, Bound& bound, NodeRef ref,
                                  const Box<double>& box, ErasedCodec::Children& out,
                                  const Use& use) {
  Box<float> in_floats;
  for (std::size_t k = 0; k < 3; ++k) {
    in_floats.low[k] = static_cast<float>(box.low[k]);
    in_floats.high[k] = static_cast<float>(box.high[k]);
  }
  ChildBoxes boxes;
  WideLinks links;
  const Errc error = with_wide_codec<Errc>(tree, [&](const auto& codec) {
    const NodeView node(codec, ref.first);
    links = node.links();
    for (std::size_t part = 0; part < kParts; ++part) decode(node, in_floats, part, boxes);
    return bound.count(check_links(codec, ref.first, links));
  });
  if (error != Errc::kOk) return error;
  const Doubles d;
  const hn::Rebind<float, Doubles> floats;
  for (std::size_t i = 0; i < kWideChildren; i += hn::MaxLanes(d)) {
    DoubleBoxes in_doubles;
    for (std::size_t k = 0; k < 3; ++k) {
      in_doubles.low[k] = hn::PromoteTo(d, hn::Load(floats, boxes.low[k] + i));
      in_doubles.high[k] = hn::PromoteTo(d, hn::Load(floats, boxes.high[k] + i));
      hn::StoreU(in_doubles.low[k], d, out.low[k].data() + i);
      hn::StoreU(in_doubles.high[k], d, out.high[k].data() + i);
    }
    use(i, in_doubles);
  }
  out.count = links.child_count;
  out.leaf_mask = ~links.inner_mask & ((1u << links.child_count) - 1);
  for (std::uint32_t i = 0; i < out.count; ++i) {
    const std::uint32_t face = first_face(links, i);
    out.ref[i] = out.is_leaf(i)
                     ? NodeRef{face, std::min(kLeafFaces, tree.counts().faces_in_leaves - face)}
                     : NodeRef{node_number(links, i), 0};
  }
  return Errc::kOk;
}

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
