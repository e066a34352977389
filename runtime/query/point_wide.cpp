// SPDX-License-Identifier: MIT
// Closest-point queries over the wide codecs.
#include "runtime/query/best_first.h"
#include "runtime/query/point_filter.h"
#include "runtime/query/point_query.h"
#include "runtime/walk/erased_codec.h"
#include "runtime/walk/targets.h"
#include "runtime/walk/walk_tree.h"

#ifndef HWY_TARGET_INCLUDE  // compiled alone
#define HWY_TARGET_INCLUDE "runtime/query/point_wide.cpp"
#endif
#include <hwy/foreach_target.h>
// Highway's headers must come after foreach_target.h.
#include <hwy/highway.h>

#include "runtime/query/point_triangles-inl.h"
#include "runtime/walk/expand-inl.h"
#include "runtime/walk/nearest-inl.h"
#include "runtime/walk/prefetch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace boxtree::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR
Errc walk_point(const BoundTree& tree, PointQuery& query) {
  return traverse_nearest(tree, ErasedCodec{&tree}, query);
}
Errc search_point(const BoundTree& tree, PointQuery& query, SearchBudget& budget) {
  return search_best_first(tree, query, budget);
}
#else
// The leaves near a point: the same for both codecs, and compiled once.
class PointLeaves {
 public:
  PointLeaves(const BoundTree& tree, PointQuery& query, const PointFilter& filter)
      : query_(query), filter_(filter), leaf_(tree) {
    bounds_.set(query.best);
  }

  /// Squared distances above it cannot improve the answer.
  [[nodiscard]] float bound() const { return bounds_.squared; }

  /// Whether what is visited next is worth reading ahead: the first face that is found may exclude
  /// the rest.
  [[nodiscard]] bool reads_ahead() const { return leaf_.reads_ahead() && query_.found; }

  /// Whether to go on. `next`: see NearestWalk.
  HWY_NOINLINE bool visit(std::uint32_t first, std::uint32_t count, std::uint32_t next) {
    const bool is_read = leaf_.load(first, count);
    leaf_.read_ahead(next);
    if (!is_read) {
      query_.error = leaf_.error();
      return false;
    }
    const auto prepared = [&](std::size_t group, std::size_t part) {
      return PreparedTriangles(leaf_, group, part);
    };
    if (test_triangles(leaf_, prepared, filter_, query_, bounds_)) return true;
    query_.error = leaf_.error();
    return false;
  }

 private:
  PointQuery& query_;
  const PointFilter& filter_;
  PointBounds bounds_;
  LeafFloats leaf_;
};

// The query of NearestWalk over the faces of one tree.
template <class Node>
class PointFaces {
 public:
  PointFaces(const BoundTree& tree, const WideCodec<Node>& codec, PointQuery& query)
      : codec_(codec),
        query_(query),
        filter_(tree.largest_abs(), query.point),
        prefetch_(tree, codec),
        leaves_(tree, query, filter_) {}

  [[nodiscard]] float bound() const { return leaves_.bound(); }
  [[nodiscard]] WalkBound& nodes() const { return query_.nodes; }

  HWY_INLINE std::uint32_t intersect(const VectorBox& boxes, FloatVector& key) const {
    key = nearest_squared(filter_, boxes);
    return bits_of(hn::Le(key, hn::Set(Floats(), leaves_.bound())));
  }

  [[nodiscard]] bool reads_ahead() const { return leaves_.reads_ahead(); }
  HWY_INLINE void expanding(const WideLinks& links, std::uint32_t passing) {
    ++query_.nodes_expanded;
    prefetch_.leaves(links, passing & ~links.inner_mask);
    prefetch_.nodes(links, passing & links.inner_mask);
  }

  bool leaf(std::uint32_t number, std::uint32_t next) {
    ++query_.nodes_expanded;
    const std::uint32_t first = number * kLeafFaces;
    return leaves_.visit(first, std::min(kLeafFaces, codec_.face_count - first), next);
  }

 private:
  const WideCodec<Node>& codec_;
  PointQuery& query_;
  const PointFilter filter_;
  const Prefetch<Node> prefetch_;
  PointLeaves leaves_;
};

template <class Node>
Errc walk_point_nodes(const BoundTree& tree, const WideCodec<Node>& codec, PointQuery& query) {
  const Box<float> root = root_box<float>(tree);
  if (query.key(root) > query.bound()) return Errc::kOk;
  PointFaces<Node> faces(tree, codec, query);
  return NearestWalk<Node, PointFaces<Node>>(codec, faces).run(root);
}

// A node's children and their keys, those of squared_distance() to the bit.
HWY_NOINLINE Errc expand(const BoundTree& tree, PointQuery& query, NodeRef ref,
                         const Box<double>& box, NearChildren& out) {
  return expand_in_doubles(
      tree, query.nodes, ref, box, out, [&](std::size_t i, const DoubleBoxes& boxes) HWY_ATTR {
        const Doubles d;
        auto sum = hn::Zero(d);
        for (std::size_t k = 0; k < 3; ++k) {
          const auto p = hn::Set(d, query.point[static_cast<Eigen::Index>(k)]);
          const auto outside =
              hn::Max(hn::Zero(d), hn::Max(hn::Sub(boxes.low[k], p), hn::Sub(p, boxes.high[k])));
          sum = hn::Add(sum, hn::Mul(outside, outside));
        }
        hn::StoreU(sum, d, out.key.data() + i);
      });
}

Errc search_point(const BoundTree& tree, PointQuery& query, SearchBudget& budget) {
  const PointFilter filter(tree.largest_abs(), query.point);
  PointLeaves leaves(tree, query, filter);
  const auto expand_node = [&](NodeRef node, const Box<double>& box, NearChildren& out) {
    return expand(tree, query, node, box, out);
  };
  const auto read = [&](NodeRef leaf) { return leaves.visit(leaf.first, leaf.second, kNoLeaf); };
  return search_best_first(tree, query, budget, {expand_node, read});
}

Errc walk_point(const BoundTree& tree, PointQuery& query) {
  return with_wide_codec<Errc>(
      tree, [&](const auto& codec) { return walk_point_nodes(tree, codec, query); });
}
#endif

}  // namespace
}  // namespace boxtree::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "runtime/walk/dispatch.h"

namespace boxtree {
namespace {

BOXTREE_EXPORT(walk_point);
BOXTREE_EXPORT(search_point);

bool is_filtered(const BoundTree& tree, const PointQuery& query) noexcept {
  return tree.has_float_nodes() && PointFilter::is_near(tree.largest_abs(), query.point);
}

}  // namespace

Errc walk_wide(const BoundTree& tree, PointQuery& query) {
  if (is_filtered(tree, query)) return BOXTREE_DISPATCH(walk_point)(tree, query);
  return traverse_nearest(tree, ErasedCodec{&tree}, query);
}

Errc walk_wide(const BoundTree& tree, PointQuery& query, SearchBudget& budget) {
  if (is_filtered(tree, query)) return BOXTREE_DISPATCH(search_point)(tree, query, budget);
  return search_best_first(tree, query, budget);
}

}  // namespace boxtree
#endif
