// SPDX-License-Identifier: MIT
// The faces that touch each of many shapes, over the wide codecs. Shapes go through a tree in
// packets: a node or leaf is decoded once for all shapes of a packet that reach it, and each of
// them tests its eight children or triangles side by side. So a shape costs what it costs alone but
// for what is shared, and comes upon nodes, faces and errors in the same order.
#if defined(BOXTREE_RUNTIME_WALK_OVERLAP_PACKETS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef BOXTREE_RUNTIME_WALK_OVERLAP_PACKETS_INL_H
#undef BOXTREE_RUNTIME_WALK_OVERLAP_PACKETS_INL_H
#else
#define BOXTREE_RUNTIME_WALK_OVERLAP_PACKETS_INL_H
#endif

#include <array>
#include <bit>
#include <cstdint>
#include <optional>

#include "runtime/walk/overlap-inl.h"
#include "runtime/walk/packets.h"
#include "runtime/walk/walk_tree.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
#if HWY_TARGET != HWY_SCALAR

/// A set of shapes of a packet: bit s is shape s.
using ShapeSet = std::uint32_t;

/// The shapes that are in flight, and what of them does not depend on the codec.
template <class Batch, class Filter>
class ShapePacket {
 public:
  static constexpr std::size_t kMost = 16;
  static_assert(kMost < 32);

  explicit ShapePacket(Batch& batch)
      : batch_(batch), root_(root_box<float>(batch.tree)), leaf_(batch.tree), refs_(batch.tree) {}

  /// Takes the shapes of the batch from `first` on, `count` of them; those that are not valid, or
  /// so far away that single precision resolves nothing, get their results.
  HWY_NOINLINE void take(std::size_t first, std::size_t count) {
    first_ = first;
    taken_ = going_ = 0;
    for (std::uint32_t s = 0; s < count; ++s) {
      const auto shape = batch_.in_tree(first + s);
      if (shape.invalid != nullptr) {
        batch_.refuse(first + s, shape.invalid);
      } else if (!is_near(batch_.tree, shape.shape)) {
        batch_.answer_alone(first + s);
      } else {
        taken_ |= 1u << s;
        shapes_[s].emplace(batch_, shape.shape, first + s);
      }
    }
  }

  /// Those that a walk has to answer.
  [[nodiscard]] ShapeSet all() const { return taken_; }

  /// Begins a walk: those of them that touch the root.
  [[nodiscard]] ShapeSet at_root() {
    for_each_bit(taken_, [&](std::uint32_t s) {
      if (shapes_[s]->shape.overlaps(root_)) going_ |= 1u << s;
      return true;
    });
    return going_;
  }
  [[nodiscard]] const Box<float>& root() const { return root_; }

  HWY_NOINLINE void walk_alone(std::size_t first, std::size_t count) {
    for (std::size_t i = first; i < first + count; ++i) batch_.answer_alone(i);
  }
  /// Every shape's result, once the walk is over.
  HWY_NOINLINE void answer(Errc /*ok: each shape has its own*/) {
    for_each_bit(taken_, [&](std::uint32_t s) {
      batch_.answer(first_ + s, shapes_[s]->report);
      return true;
    });
  }

  /// Those whose visit is not over.
  [[nodiscard]] ShapeSet going() const { return going_; }

  /// Counts a node for `shapes`. Returns those that may go on to its children.
  HWY_INLINE ShapeSet count(ShapeSet shapes, NodeState state) {
    ShapeSet left = shapes;
    for_each_bit(shapes, [&](std::uint32_t s) {
      const Errc error = shapes_[s]->nodes.count(state);
      if (error != Errc::kOk) [[unlikely]] {
        fail(1u << s, error);
        left &= ~(1u << s);
      }
      return true;
    });
    return left;
  }
  /// Ends the visits of `shapes`.
  void fail(ShapeSet shapes, Errc error) {
    going_ &= ~shapes;
    for_each_bit(shapes, [&](std::uint32_t s) {
      shapes_[s]->report.error = error;
      return true;
    });
  }

  [[nodiscard]] const Filter& filter(std::uint32_t s) const { return shapes_[s]->filter; }

  /// Reports faces `first` to first + count - 1, without reading them, to each of `shapes`.
  HWY_NOINLINE void report(ShapeSet shapes, std::uint32_t first, std::uint32_t count) {
    for_each_bit(shapes, [&](std::uint32_t s) {
      for (std::uint32_t face = first; face < first + count && report(s, face); ++face) {
      }
      return true;
    });
  }

  /// Reports the faces of a leaf that touch to each of `shapes`.
  HWY_NOINLINE void visit_leaf(ShapeSet shapes, std::uint32_t first, std::uint32_t count,
                               std::uint32_t next) {
    const bool is_read = leaf_.load(first, count);
    leaf_.read_ahead(next);
    if (!is_read) return fail(shapes, leaf_.error());
    std::array<std::uint32_t, kMost> reported;  // halves of a quad are adjacent
    reported.fill(kNoFaceId);
    for (std::size_t group = 0; group < leaf_.groups(); ++group) {
      VectorTriangle triangles[kParts];
      for (std::size_t part = 0; part < kParts; ++part)
        triangles[part] = leaf_.triangles(group, part);
      for_each_bit(shapes & going_, [&](std::uint32_t s) {
        const Classification classification =
            classify_parts(shapes_[s]->filter, [&](std::size_t part) { return triangles[part]; });
        static_cast<void>(
            for_each_bit(classification.touched & leaf_.lanes(group), [&](std::uint32_t i) {
              const auto lane = static_cast<std::uint32_t>(group * kWideChildren) + i;
              if (leaf_.face(lane) == reported[s]) return true;
              if (((classification.inside >> i) & 1u) == 0 && !touches(s, lane)) return is_going(s);
              reported[s] = leaf_.face(lane);
              return report(s, reported[s]);
            }));
        return true;
      });
    }
  }

 private:
  struct InFlight {
    InFlight(Batch& batch, const typename Batch::QueryShape& queried, std::size_t number)
        : shape(queried),
          filter(batch.tree, queried),
          nodes(batch.tree.node_count()),
          report{batch.tree, {batch.visitor, number}} {}

    typename Batch::QueryShape shape;
    Filter filter;
    WalkBound nodes;
    FaceReport<typename Batch::Visitor> report;
  };

  [[nodiscard]] bool is_going(std::uint32_t s) const { return ((going_ >> s) & 1u) != 0; }

  // Returns whether the shape goes on.
  bool report(std::uint32_t s, std::uint32_t face) {
    if (shapes_[s]->report.report(face, refs_)) return true;
    going_ &= ~(1u << s);
    return false;
  }

  bool touches(std::uint32_t s, std::uint32_t lane) {
    const auto& shape = shapes_[s]->shape;
    bool touched = false;
    const bool read = leaf_.with_triangle(
        lane, [&](const Triangle& triangle, std::uint32_t /*face*/, std::uint32_t /*half*/) {
          touched = shape.overlaps(bounds_of(triangle)) && shape.touches(triangle);
        });
    if (!read) fail(1u << s, leaf_.error());
    return touched;
  }

  Batch& batch_;
  const Box<float> root_;
  std::size_t first_ = 0;  // the place of shape 0 in the batch
  ShapeSet taken_ = 0, going_ = 0;
  std::array<std::optional<InFlight>, kMost> shapes_;
  LeafFloats leaf_;
  LeafFaceRefs refs_;
};

template <class Node, class Packet>
class ShapePacketWalk {
 public:
  ShapePacketWalk(const BoundTree& tree, const WideCodec<Node>& codec, Packet& packet)
      : codec_(codec), packet_(packet), prefetch_(tree, codec) {}

  /// Whether a walk together pays (docs/MEASUREMENTS.md).
  [[nodiscard]] bool was_shared() const { return meets_ >= kPays * visits_; }

  /// Ends as OverlapWalk does: every node counts for each shape that is at it.
  Errc run() {
    meets_ = visits_ = 0;
    ShapeSet shapes = packet_.at_root(), inside = 0;
    Box<float> box = packet_.root();
    std::uint32_t number = 0;
    std::size_t depth = 0;
    if (shapes == 0) return Errc::kOk;
    for (;;) {
      expand(number, box, shapes, inside, depth);
      // The next child that a shape still goes to.
      for (;;) {
        if (depth == 0) return Errc::kOk;
        Children& last = open_[depth - 1];
        const auto i = static_cast<std::uint32_t>(std::countr_zero(last.pending));
        shapes = last.touched[i] & packet_.going();
        inside = last.inside[i] & shapes;
        box = last.boxes.box(i);
        number = node_number(last.links, i);
        last.pending &= last.pending - 1;
        // The place of a node whose last child is taken is free for that child's own children.
        depth -= last.pending == 0 ? 1 : 0;
        if (shapes != 0) break;
      }
    }
  }

 private:
  // Shapes at a node or leaf from which on walks together pay.
  static constexpr std::uint64_t kPays = 2;

  // The children of an open node; the pending ones are nodes.
  struct Children {
    ChildBoxes boxes;  // unspecified when the node is inside of all its shapes
    WideLinks links;
    std::uint32_t pending;
    std::array<ShapeSet, kWideChildren> touched, inside;
  };

  void note_visit(ShapeSet shapes) {
    meets_ += static_cast<std::uint64_t>(std::popcount(shapes));
    ++visits_;
  }

  // Visits the leaves among the children of a node, and opens it if others are left.
  HWY_INLINE void expand(std::uint32_t number, const Box<float>& box, ShapeSet shapes,
                         ShapeSet inside, std::size_t& depth) {
    const NodeView<Node> node(codec_, number);
    if (depth == open_.size()) return packet_.fail(shapes, Errc::kDepthExceeded);
    Children& children = open_[depth];
    const WideLinks links = children.links = node.links();
    shapes = packet_.count(shapes, check_links(codec_, number, links));
    if (shapes == 0) return;
    note_visit(shapes);
    const std::uint32_t passing = meet(node, links, box, shapes, inside & shapes, children);
    std::uint32_t read = 0;  // leaves
    for_each_bit(passing & ~links.inner_mask, [&](std::uint32_t i) {
      if ((children.touched[i] & ~children.inside[i]) != 0) read |= 1u << i;
      return true;
    });
    prefetch_.leaves(links, read);
    prefetch_.nodes(links, passing & links.inner_mask);
    for_each_bit(passing & ~links.inner_mask, [&](std::uint32_t i) {
      const ShapeSet at = children.touched[i] & packet_.going();
      if (at == 0) return true;
      note_visit(at);
      const std::uint32_t first = first_face(links, i);
      const std::uint32_t count = std::min(kLeafFaces, codec_.face_count - first);
      const std::uint32_t later = read & ~1u << i;
      const auto next = static_cast<std::uint32_t>(std::countr_zero(later));
      packet_.report(at & children.inside[i], first, count);
      const ShapeSet tested = at & ~children.inside[i];
      if (tested != 0) {
        packet_.visit_leaf(tested, first, count, later != 0 ? leaf_number(links, next) : kNoLeaf);
      }
      return true;
    });
    children.pending = passing & links.inner_mask;
    depth += children.pending != 0 ? 1 : 0;
  }

  // Returns the children that one of `shapes` touches; `inside`: those that the node is inside of.
  HWY_INLINE std::uint32_t meet(const NodeView<Node>& node, const WideLinks& links,
                                const Box<float>& box, ShapeSet shapes, ShapeSet inside,
                                Children& children) const {
    const std::uint32_t all = (1u << links.child_count) - 1;
    children.touched.fill(inside);
    children.inside.fill(inside);
    const ShapeSet tested = shapes & ~inside;
    if (tested == 0) return all;
    VectorBox boxes[kParts];
    for (std::size_t part = 0; part < kParts; ++part)
      boxes[part] = decode(node, box, part, children.boxes);
    std::uint32_t passing = inside != 0 ? all : 0;
    for_each_bit(tested, [&](std::uint32_t s) {
      Classification classification =
          classify_parts(packet_.filter(s), [&](std::size_t part) { return boxes[part]; });
      classification.touched &= all;
      passing |= classification.touched;
      for_each_bit(classification.touched, [&](std::uint32_t i) {
        children.touched[i] |= 1u << s;
        children.inside[i] |= ((classification.inside >> i) & 1u) << s;
        return true;
      });
      return true;
    });
    return passing;
  }

  const WideCodec<Node>& codec_;
  Packet& packet_;
  const Prefetch<Node> prefetch_;
  // By the last walk: nodes and leaves, and shapes at them.
  std::uint64_t visits_ = 0, meets_ = 0;
  std::array<Children, WideCodec<Node>::kDepthLimit> open_;
};

/// Answers every shape of a batch.
template <class Filter, class Batch>
void walk_packets(Batch& batch) {
  using Packet = ShapePacket<Batch, Filter>;
  static_cast<void>(
      with_wide_codec<Errc>(batch.tree, [&]<class Node>(const WideCodec<Node>& codec) {
        Packet packet(batch);
        ShapePacketWalk<Node, Packet> walk(batch.tree, codec, packet);
        answer_in_packets(batch.shapes.size(), packet, walk);
        return Errc::kOk;
      }));
}

#endif
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();
#endif
