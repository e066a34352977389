// SPDX-License-Identifier: MIT
// Boxes and spheres over the wide codecs. What is inside the shape as a whole is reported without
// another test: neither its boxes nor its triangles are read.
#include <boxtree/runtime/wide/point_filter.h>
#include <boxtree/runtime/wide/targets.h>
#include <boxtree/runtime/wide/walks.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "boxtree/runtime/wide/overlap.cpp"
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include <boxtree/runtime/wide/distance-inl.h>
#include <boxtree/runtime/wide/leaf-inl.h>
#include <boxtree/runtime/wide/prefetch-inl.h>

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

// Both filters answer for boxes, decoded or bounds of triangles: bit i of `touched` is clear only
// when box i misses the shape beyond doubt, bit i of `inside` is set only when it lies in the shape
// beyond doubt.
struct Verdict {
  std::uint32_t touched;
  std::uint32_t inside;
};

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

class SphereFilter {
 public:
  SphereFilter(const Tree& tree, const SphereQuery& query)
      : center_(tree, query.center),
        above_(PointFilter::above(query.squared_radius)),
        below_(PointFilter::below(query.squared_radius)) {}

  HWY_INLINE Verdict judge(const VectorBox& box) const {
    const Floats d;
    return {bits_of(hn::Le(nearest_squared(center_, box), hn::Set(d, above_))),
            bits_of(hn::Le(farthest_squared(center_, box), hn::Set(d, below_)))};
  }

  HWY_INLINE std::uint32_t contained(const FloatVector (&point)[3]) const {
    const VectorBox box{{point[0], point[1], point[2]}, {point[0], point[1], point[2]}};
    return bits_of(hn::Le(farthest_squared(center_, box), hn::Set(Floats(), below_)));
  }

 private:
  PointFilter center_;
  float above_, below_;  // squared radius
};

template <class Node, class Shape, class Filter>
class OverlapWalk {
 public:
  OverlapWalk(const Tree& tree, const WideCodec<Node>& codec, FaceWalk<Shape>& walk)
      : tree_(tree),
        codec_(codec),
        walk_(walk),
        filter_(tree, walk.shape),
        prefetch_(tree, codec),
        leaf_(tree) {}

  Errc run(const Box<float>& root) {
    Box<float> box = root;
    std::uint32_t number = 0;
    bool inside = false;
    std::size_t depth = 0;
    std::uint64_t unexpanded = codec_.node_count;
    for (;;) {
      const Node* node = reinterpret_cast<const Node*>(codec_.nodes) + number;
      if (depth == open_.size()) return Errc::kDepthExceeded;
      Children& children = open_[depth];
      const WideLinks links = children.links = links_of(*node);
      if (unexpanded-- == 0 || !is_sound(codec_, number, links)) return Errc::kNodeCorrupt;
      const Verdict verdict = judge(*node, box, inside, children.boxes);
      prefetch_.leaves(links, verdict.touched & ~verdict.inside & ~links.inner_mask);
      prefetch_.nodes(links, verdict.touched & links.inner_mask);
      const bool go_on = for_each_bit(verdict.touched & ~links.inner_mask, [&](std::uint32_t i) {
        const std::uint32_t first = first_face(links, i);
        const std::uint32_t count = std::min(kLeafFaces, codec_.face_count - first);
        return ((verdict.inside >> i) & 1u) != 0 ? report_all(first, count)
                                                 : visit_leaf(first, count);
      });
      if (!go_on) return Errc::kOk;
      children.waiting = verdict.touched & links.inner_mask;
      children.inside = verdict.inside;
      depth += children.waiting != 0 ? 1 : 0;
      if (depth == 0) return Errc::kOk;
      // The place of a node whose last child is taken is free for that child's own children.
      Children& last = open_[depth - 1];
      const auto i = static_cast<std::uint32_t>(std::countr_zero(last.waiting));
      box = last.boxes.box(i);
      number = node_number(last.links, i);
      inside = ((last.inside >> i) & 1u) != 0;
      last.waiting &= last.waiting - 1;
      depth -= last.waiting == 0 ? 1 : 0;
    }
  }

 private:
  // The children of an open node; those that wait are nodes.
  struct Children {
    ChildBoxes boxes;  // unspecified when the node is inside the shape
    WideLinks links;
    std::uint32_t waiting;
    std::uint32_t inside;
  };

  HWY_INLINE Verdict judge(const Node& node, const Box<float>& box, bool inside,
                           ChildBoxes& children) const {
    const std::uint32_t all = (1u << links_of(node).child_count) - 1;
    if (inside) return {all, all};
    Verdict verdict{0, 0};
    for (std::size_t part = 0; part < kParts; ++part) {
      const Verdict of_part = filter_.judge(decode(node, box, part, children));
      verdict.touched |= of_part.touched << (part * kLanes);
      verdict.inside |= of_part.inside << (part * kLanes);
    }
    verdict.touched &= all;
    return verdict;
  }

  bool report(std::uint32_t face) {
    walk_.stopped = !walk_.visitor(face_ref(tree_, face));
    return !walk_.stopped;
  }

  bool report_all(std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t face = first; face < first + count; ++face) {
      if (!report(face)) return false;
    }
    return true;
  }

  bool visit_leaf(std::uint32_t first, std::uint32_t count) {
    if (!leaf_.load(first, count)) {
      walk_.error = leaf_.error();
      return false;
    }
    std::uint32_t reported = kNoFaceId;  // halves of a quad stand side by side
    for (std::size_t group = 0; group < leaf_.groups(); ++group) {
      std::uint32_t touched = 0, certain = 0;
      for (std::size_t part = 0; part < kParts; ++part) {
        const Verdict verdict = filter_.judge(leaf_.bounds(group, part));
        touched |= verdict.touched << (part * kLanes);
        certain |= (verdict.inside | any_corner(group, part)) << (part * kLanes);
      }
      const bool go_on = for_each_bit(touched & leaf_.lanes(group), [&](std::uint32_t i) {
        const auto lane = static_cast<std::uint32_t>(group * kWideChildren) + i;
        if (leaf_.face(lane) == reported) return true;
        if (((certain >> i) & 1u) == 0 && !touches(lane)) return walk_.error == Errc::kOk;
        reported = leaf_.face(lane);
        return report(reported);
      });
      if (!go_on) return false;
    }
    return true;
  }

  // Bit i: a corner of triangle i is inside the shape.
  HWY_INLINE std::uint32_t any_corner(std::size_t group, std::size_t part) const {
    std::uint32_t any = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      const FloatVector corner[3] = {leaf_.at(c, 0, group, part), leaf_.at(c, 1, group, part),
                                     leaf_.at(c, 2, group, part)};
      any |= filter_.contained(corner);
    }
    return any;
  }

  bool touches(std::uint32_t lane) {
    bool touched = false;
    const bool read = leaf_.with_triangle(
        lane, [&](const Triangle& triangle, std::uint32_t /*face*/, std::uint32_t /*half*/) {
          touched = walk_.shape.overlaps(bounds_of(triangle)) && walk_.shape.touches(triangle);
        });
    if (!read) walk_.error = leaf_.error();
    return touched;
  }

  const Tree& tree_;
  const WideCodec<Node>& codec_;
  FaceWalk<Shape>& walk_;
  const Filter filter_;
  const Prefetch<Node> prefetch_;
  LeafFloats leaf_;
  std::array<Children, WideCodec<Node>::kDepthLimit> open_;
};

template <class Filter, class Node, class Shape>
Errc walk(const Tree& tree, const WideCodec<Node>& codec, FaceWalk<Shape>& faces) {
  const Box<float> root = root_box<float>(tree);
  if (!faces.overlaps(root)) return Errc::kOk;
  return OverlapWalk<Node, Shape, Filter>(tree, codec, faces).run(root);
}

Errc box_wide8(const Tree& tree, const WideCodec<Wide8Node>& codec, FaceWalk<BoxQuery>& faces) {
  return walk<BoxFilter>(tree, codec, faces);
}
Errc box_wide4(const Tree& tree, const WideCodec<Wide4Node>& codec, FaceWalk<BoxQuery>& faces) {
  return walk<BoxFilter>(tree, codec, faces);
}
Errc sphere_wide8(const Tree& tree, const WideCodec<Wide8Node>& codec,
                  FaceWalk<SphereQuery>& faces) {
  return walk<SphereFilter>(tree, codec, faces);
}
Errc sphere_wide4(const Tree& tree, const WideCodec<Wide4Node>& codec,
                  FaceWalk<SphereQuery>& faces) {
  return walk<SphereFilter>(tree, codec, faces);
}

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxtree {
namespace {

HWY_EXPORT(box_wide8);
HWY_EXPORT(box_wide4);
HWY_EXPORT(sphere_wide8);
HWY_EXPORT(sphere_wide4);

bool is_for_vectors(const Tree& tree, const SphereQuery& query) {
  return tree.has_nodes() && PointFilter::is_near(tree, query.center);
}

}  // namespace

Errc walk_overlap(const Tree& tree, const WideCodec<Wide8Node>& codec, FaceWalk<BoxQuery>& walk) {
  if (!tree.has_nodes()) return traverse_overlap(tree, codec, walk);
  return HWY_DYNAMIC_DISPATCH(box_wide8)(tree, codec, walk);
}
Errc walk_overlap(const Tree& tree, const WideCodec<Wide4Node>& codec, FaceWalk<BoxQuery>& walk) {
  if (!tree.has_nodes()) return traverse_overlap(tree, codec, walk);
  return HWY_DYNAMIC_DISPATCH(box_wide4)(tree, codec, walk);
}
Errc walk_overlap(const Tree& tree, const WideCodec<Wide8Node>& codec,
                  FaceWalk<SphereQuery>& walk) {
  if (!is_for_vectors(tree, walk.shape)) return traverse_overlap(tree, codec, walk);
  return HWY_DYNAMIC_DISPATCH(sphere_wide8)(tree, codec, walk);
}
Errc walk_overlap(const Tree& tree, const WideCodec<Wide4Node>& codec,
                  FaceWalk<SphereQuery>& walk) {
  if (!is_for_vectors(tree, walk.shape)) return traverse_overlap(tree, codec, walk);
  return HWY_DYNAMIC_DISPATCH(sphere_wide4)(tree, codec, walk);
}

}  // namespace boxtree
#endif
