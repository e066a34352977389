// SPDX-License-Identifier: MIT
// The closest point over the wide codecs.
#include <boxtree/runtime/wide/point_filter.h>
#include <boxtree/runtime/wide/targets.h>
#include <boxtree/runtime/wide/walks.h>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "boxtree/runtime/wide/point.cpp"
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include <boxtree/runtime/wide/triangle_distance-inl.h>

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

// An inner node that waits, with its decoded box.
struct PointEntry {
  Box<float> box;
  float key;
  std::uint32_t node;
};

template <class Node>
class PointWalk {
 public:
  PointWalk(const Tree& tree, const WideCodec<Node>& codec, PointQuery& query)
      : codec_(codec), query_(query), filter_(tree, query.point), leaf_(tree) {
    set_bound();
  }

  Errc run(const Box<float>& root) {
    std::size_t size = 0;
    PointEntry entry{root, 0, 0};
    std::uint64_t unexpanded = codec_.node_count;
    ChildBoxes children;
    HWY_ALIGN float key[kWideChildren];
    for (;;) {
      const Node* node = reinterpret_cast<const Node*>(codec_.nodes) + entry.node;
      const WideLinks links = links_of(*node);
      if (unexpanded-- == 0 || !is_sound(codec_, entry.node, links)) return Errc::kNodeCorrupt;
      std::uint32_t passing = 0;
      for (std::size_t part = 0; part < kParts; ++part) {
        const FloatVector bound =
            nearest_squared(filter_, decode(*node, entry.box, part, children));
        hn::Store(bound, Floats(), key + part * kLanes);
        passing |= bits_of(hn::Le(bound, hn::Set(Floats(), bound_))) << (part * kLanes);
      }
      passing &= (1u << links.child_count) - 1;
      for (std::uint32_t leaves = passing & ~links.inner_mask; leaves != 0;) {
        const std::uint32_t i = take_smallest(leaves, key);
        if (key[i] > bound_) break;
        const std::uint32_t face = first_face(links, i);
        if (!visit_leaf(face, std::min(kLeafFaces, codec_.face_count - face))) return Errc::kOk;
      }
      const std::size_t bottom = size;
      const bool has_room = for_each_bit(passing & links.inner_mask, [&](std::uint32_t i) {
        if (size == stack_.size()) return false;
        std::size_t place = size++;
        for (; place > bottom && stack_[place - 1].key < key[i]; --place) {
          stack_[place] = stack_[place - 1];
        }
        stack_[place] = {children.box(i), key[i], node_number(links, i)};
        return true;
      });
      if (!has_room) return Errc::kDepthExceeded;
      do {
        if (size == 0) return Errc::kOk;
        entry = stack_[--size];
      } while (entry.key > bound_);
    }
  }

 private:
  void set_bound() {
    bound_ = PointFilter::above(query_.best);
    distance_ = float_above(std::sqrt(query_.best)) * (1 + std::numeric_limits<float>::epsilon());
  }

  bool visit_leaf(std::uint32_t first, std::uint32_t count) {
    if (!leaf_.load(first, count)) {
      query_.error = leaf_.error();
      return false;
    }
    for (std::size_t group = 0; group < leaf_.groups(); ++group) {
      HWY_ALIGN float distance[kWideChildren];
      std::uint32_t near = 0;
      for (std::size_t part = 0; part < kParts; ++part) {
        const FloatVector bound = triangle_distance(filter_, leaf_, group, part);
        hn::Store(bound, Floats(), distance + part * kLanes);
        near |= bits_of(hn::Not(hn::Gt(bound, hn::Set(Floats(), distance_)))) << (part * kLanes);
      }
      near &= leaf_.lanes(group);
      while (near != 0) {
        const std::uint32_t i = take_smallest(near, distance);
        if (distance[i] > distance_) break;
        const auto lane = static_cast<std::uint32_t>(group * kWideChildren) + i;
        const bool read = leaf_.with_triangle(
            lane, [&](const Triangle& triangle, std::uint32_t face, std::uint32_t half) {
              query_.test(triangle, face, half);
            });
        if (!read) {
          query_.error = leaf_.error();
          return false;
        }
        set_bound();
      }
    }
    return true;
  }

  const WideCodec<Node>& codec_;
  PointQuery& query_;
  const PointFilter filter_;
  float bound_;     // of squared distances
  float distance_;  // of distances
  LeafFloats leaf_;
  std::array<PointEntry, kWideStack<Node>> stack_;
};

template <class Node>
Errc walk(const Tree& tree, const WideCodec<Node>& codec, PointQuery& query) {
  const Box<float> root = root_box<float>(tree);
  if (query.key(root) > query.bound()) return Errc::kOk;
  return PointWalk<Node>(tree, codec, query).run(root);
}
Errc point_wide8(const Tree& tree, const WideCodec<Wide8Node>& codec, PointQuery& query) {
  return walk(tree, codec, query);
}
Errc point_wide4(const Tree& tree, const WideCodec<Wide4Node>& codec, PointQuery& query) {
  return walk(tree, codec, query);
}

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace boxtree {
namespace {

HWY_EXPORT(point_wide8);
HWY_EXPORT(point_wide4);

bool is_for_vectors(const Tree& tree, const PointQuery& query) {
  return tree.record().root == RootKind::kSubtree && PointFilter::is_near(tree, query.point);
}

}  // namespace

Errc walk_nearest(const Tree& tree, const WideCodec<Wide8Node>& codec, PointQuery& query) {
  if (!is_for_vectors(tree, query)) return traverse_nearest(tree, codec, query);
  return HWY_DYNAMIC_DISPATCH(point_wide8)(tree, codec, query);
}
Errc walk_nearest(const Tree& tree, const WideCodec<Wide4Node>& codec, PointQuery& query) {
  if (!is_for_vectors(tree, query)) return traverse_nearest(tree, codec, query);
  return HWY_DYNAMIC_DISPATCH(point_wide4)(tree, codec, query);
}

}  // namespace boxtree
#endif
