// SPDX-License-Identifier: MIT
// The faces that touch a shape, over the wide codecs. Nodes and leaves entirely inside the shape
// are reported without another test: neither their boxes nor their triangles are read.
#if defined(BOXTREE_RUNTIME_WALK_OVERLAP_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_WALK_OVERLAP_INL_H
#undef BOXTREE_RUNTIME_WALK_OVERLAP_INL_H
#else
#define BOXTREE_RUNTIME_WALK_OVERLAP_INL_H
#endif

#include "runtime/tree/bound_tree.h"
#include "runtime/walk/face_visit.h"
#include "runtime/walk/leaf-inl.h"
#include "runtime/walk/prefetch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if HWY_TARGET != HWY_SCALAR

/// What a shape's filter finds about boxes, decoded or bounds of triangles: bit i of `touched` is
/// clear only when box i provably misses the shape, bit i of `inside` is set only when it provably
/// lies in the shape.
struct Classification {
  std::uint32_t touched;
  std::uint32_t inside;
};

/// Classifies eight boxes or triangles, part by part: part_of(part).
template <class Filter, class PartOf>
HWY_INLINE Classification classify_parts(const Filter& filter, const PartOf& part_of) {
  Classification all{0, 0};
  for (std::size_t part = 0; part < kParts; ++part) {
    const Classification classification = filter.classify(part_of(part));
    all.touched |= classification.touched << (part * kLanes);
    all.inside |= classification.inside << (part * kLanes);
  }
  return all;
}

/// Classifies triangles by their bounds and corners; `inside`: they provably touch the shape. Uses
/// shape.classify(const VectorBox&) and shape.contained(const VectorPoint&), whose bits are set
/// only for points that provably lie in the shape.
template <class Shape>
HWY_INLINE Classification classify_corners(const Shape& shape, const VectorTriangle& triangle) {
  Classification classification = shape.classify(bounds_of(triangle));
  for (const VectorPoint& corner : triangle.corner)
    classification.inside |= shape.contained(corner);
  return classification;
}

/// The leaves that a shape overlaps: the same for both codecs, and compiled once. Each function
/// returns whether to go on.
template <class Shape, class Filter>
class OverlapLeaves {
 public:
  OverlapLeaves(const BoundTree& tree, FaceWalk<Shape>& walk, const Filter& filter)
      : walk_(walk), filter_(filter), leaf_(tree) {}

  /// Reports faces `first` to first + count - 1 without reading them.
  bool report(std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t face = first; face < first + count; ++face) {
      if (!walk_.report(face)) return false;
    }
    return true;
  }

  /// Reports the faces that touch the shape. `next`: the leaf that is visited next, or kNoLeaf.
  HWY_NOINLINE bool visit(std::uint32_t first, std::uint32_t count, std::uint32_t next) {
    const bool is_read = leaf_.load(first, count);
    leaf_.read_ahead(next);
    if (!is_read) {
      walk_.error = leaf_.error();
      return false;
    }
    std::uint32_t reported = kNoFaceId;  // halves of a quad are adjacent
    for (std::size_t group = 0; group < leaf_.groups(); ++group) {
      const Classification classification =
          classify_parts(filter_, [&](std::size_t part) { return leaf_.triangles(group, part); });
      const bool go_on =
          for_each_bit(classification.touched & leaf_.lanes(group), [&](std::uint32_t i) {
            const auto lane = static_cast<std::uint32_t>(group * kWideChildren) + i;
            if (leaf_.face(lane) == reported) return true;
            if (((classification.inside >> i) & 1u) == 0 && !touches(lane))
              return walk_.error == Errc::kOk;
            reported = leaf_.face(lane);
            return walk_.report(reported);
          });
      if (!go_on) return false;
    }
    return true;
  }

 private:
  bool touches(std::uint32_t lane) {
    bool touched = false;
    const bool read = leaf_.with_triangle(
        lane, [&](const Triangle& triangle, std::uint32_t /*face*/, std::uint32_t /*half*/) {
          touched = walk_.shape.overlaps(bounds_of(triangle)) && walk_.shape.touches(triangle);
        });
    if (!read) walk_.error = leaf_.error();
    return touched;
  }

  FaceWalk<Shape>& walk_;
  const Filter& filter_;
  LeafFloats leaf_;
};

template <class Node, class Shape, class Filter>
class OverlapWalk {
 public:
  OverlapWalk(const BoundTree& tree, const WideCodec<Node>& codec, FaceWalk<Shape>& walk)
      : codec_(codec),
        walk_(walk),
        filter_(tree, walk.shape),
        prefetch_(tree, codec),
        leaves_(tree, walk, filter_) {}

  Errc run(const Box<float>& root) {
    Box<float> box = root;
    std::uint32_t number = 0;
    bool inside = false;
    std::size_t depth = 0;
    for (;;) {
      const NodeView<Node> node(codec_, number);
      if (depth == open_.size()) return Errc::kDepthExceeded;
      Children& children = open_[depth];
      const WideLinks links = children.links = node.links();
      const Errc error = walk_.nodes.count(check_links(codec_, number, links));
      if (error != Errc::kOk) return error;
      const Classification classification = classify(node, links, box, inside, children.boxes);
      prefetch_.leaves(links, classification.touched & ~classification.inside & ~links.inner_mask);
      prefetch_.nodes(links, classification.touched & links.inner_mask);
      const std::uint32_t leaves = classification.touched & ~links.inner_mask;
      const std::uint32_t visited = leaves & ~classification.inside;
      const bool go_on = for_each_bit(leaves, [&](std::uint32_t i) {
        const std::uint32_t first = first_face(links, i);
        const std::uint32_t count = std::min(kLeafFaces, codec_.face_count - first);
        if (((visited >> i) & 1u) == 0) return leaves_.report(first, count);
        const std::uint32_t later = visited & ~1u << i;
        const auto next = static_cast<std::uint32_t>(std::countr_zero(later));
        return leaves_.visit(first, count, later != 0 ? leaf_number(links, next) : kNoLeaf);
      });
      if (!go_on) return Errc::kOk;
      children.pending = classification.touched & links.inner_mask;
      children.inside = classification.inside;
      depth += children.pending != 0 ? 1 : 0;
      if (depth == 0) return Errc::kOk;
      // The place of a node whose last child is taken is free for that child's own children.
      Children& last = open_[depth - 1];
      const auto i = static_cast<std::uint32_t>(std::countr_zero(last.pending));
      box = last.boxes.box(i);
      number = node_number(last.links, i);
      inside = ((last.inside >> i) & 1u) != 0;
      last.pending &= last.pending - 1;
      depth -= last.pending == 0 ? 1 : 0;
    }
  }

 private:
  // The children of an open node; the pending ones are nodes.
  struct Children {
    ChildBoxes boxes;  // unspecified when the node is inside the shape
    WideLinks links;
    std::uint32_t pending;
    std::uint32_t inside;
  };

  HWY_INLINE Classification classify(const NodeView<Node>& node, const WideLinks& links,
                                     const Box<float>& box, bool inside,
                                     ChildBoxes& children) const {
    const std::uint32_t all = (1u << links.child_count) - 1;
    if (inside) return {all, all};
    Classification classification = classify_parts(
        filter_, [&](std::size_t part) { return decode(node, box, part, children); });
    classification.touched &= all;
    return classification;
  }

  const WideCodec<Node>& codec_;
  FaceWalk<Shape>& walk_;
  const Filter filter_;
  const Prefetch<Node> prefetch_;
  OverlapLeaves<Shape, Filter> leaves_;
  std::array<Children, WideCodec<Node>::kDepthLimit> open_;
};

template <class Filter, class Node, class Shape>
Errc walk(const BoundTree& tree, const WideCodec<Node>& codec, FaceWalk<Shape>& faces) {
  const Box<float> root = root_box<float>(tree);
  if (!faces.overlaps(root)) return Errc::kOk;
  return OverlapWalk<Node, Shape, Filter>(tree, codec, faces).run(root);
}

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
