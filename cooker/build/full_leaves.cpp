// SPDX-License-Identifier: MIT
// Builder of trees with full leaves: large sets are divided by bins, small ones by a sweep. The
// sizes of the sides are chosen so that wide nodes are full, too.
#include <algorithm>

#include <oneapi/tbb/parallel_invoke.h>

#include "cooker/build/build_tree.h"
#include "cooker/build/face_boxes.h"
#include "cooker/build/full_nodes.h"
#include "cooker/build/unit_sweep.h"

namespace boxtree::cooker {
namespace {

class LeafRecursion {
 public:
  LeafRecursion(std::span<FaceBox> faces, std::span<BuildNode> nodes)
      : faces_(faces), nodes_(nodes) {}

  // A set to build: faces [first, last) become the nodes from `node` on, and `roots` children of a
  // wide node. n leaves fill exactly 2n - 1 nodes, so the place of every subtree is known in
  // advance and threads write to separate places.
  struct Set {
    std::size_t first, last;
    std::size_t node;
    std::size_t roots;
    std::uint32_t depth_left;

    [[nodiscard]] std::size_t count() const { return last - first; }
  };

  void build(const Set& set) {
    if (set.count() <= UnitSweep::kMaxFaces) {
      UnitSweep sweep(faces_.subspan(set.first, set.count()));
      build_swept(sweep, set.first, set);
      return;
    }
    const Split split = choose_split(set);
    const Sides parts = sides(set, split);
    tbb::parallel_invoke([&] { build(parts.left); }, [&] { build(parts.right); });
    nodes_[set.node] = inner_node(nodes_, set.node, parts.right.node, split.axis);
  }

 private:
  struct Sides {
    Set left, right;
  };

  // The same for a part of a small set whose faces start at `base`. Within a leaf, faces are
  // ordered by number.
  void build_swept(UnitSweep& sweep, std::size_t base, const Set& set) {
    const std::size_t first = set.first - base, last = set.last - base;
    if (set.count() <= kLeafFaces) {
      nodes_[set.node] = {sweep.bounds(first, last), 0, static_cast<std::uint32_t>(set.first)};
      sweep.copy_to(first, faces_.subspan(set.first, set.count()));
      return;
    }
    const Split split = may_choose(set)
                            ? sweep.best_split(first, last, children_of(set.roots))
                            : Split{half(set) * kLeafFaces, widest_axis(sweep.bounds(first, last))};
    sweep.divide(first, last, split);
    const Sides parts = sides(set, split);
    build_swept(sweep, base, parts.left);
    build_swept(sweep, base, parts.right);
    nodes_[set.node] = inner_node(nodes_, set.node, parts.right.node, split.axis);
  }

  // Even halving needs ceil(log2 n) levels. Other splits are possible only if more levels are left.
  static bool may_choose(const Set& set) {
    return halvings(leaves_of(set.count())) < set.depth_left;
  }
  static std::size_t half(const Set& set) { return leaves_of(set.count()) / 2; }

  [[nodiscard]] Split choose_split(const Set& set) const {
    const std::span<FaceBox> faces = faces_.subspan(set.first, set.count());
    std::size_t left_leaves = half(set);
    if (may_choose(set)) {
      const std::size_t roots = children_of(set.roots);
      if (const std::optional<Split> split = split_sah_full_leaves(faces, roots)) return *split;
      left_leaves = nearest_full_side(left_leaves, leaves_of(set.count()), roots);
    }
    Box<float> bounds = empty_box<float>();
    for (const FaceBox& face : faces) expand(bounds, face.box);
    return split_at(faces, left_leaves * kLeafFaces, widest_axis(bounds));
  }

  // The left side is the next node; the right side follows all nodes of the left.
  static Sides sides(const Set& set, const Split& split) {
    const std::size_t left_leaves = split.left_count / kLeafFaces;
    const std::size_t middle = set.first + split.left_count;
    const std::size_t roots = children_of(set.roots);
    // Even halving at the depth limit may leave nodes partly full; then any share is allowed.
    const std::size_t left_roots = std::clamp<std::size_t>(
        roots_on_left(left_leaves, leaves_of(set.count()), roots), 1, roots - 1);
    const std::uint32_t depth_left = set.depth_left - 1;
    return {{set.first, middle, set.node + 1, left_roots, depth_left},
            {middle, set.last, set.node + 2 * left_leaves, roots - left_roots, depth_left}};
  }

  std::span<FaceBox> faces_;
  std::span<BuildNode> nodes_;
};

}  // namespace

BuildTree build_full_leaves(const MeshView& mesh, Origin origin, const Duplicates& duplicates) {
  BuildTree tree;
  choose_frame(mesh.positions, origin, tree);
  if (mesh.faces.empty()) return tree;
  std::vector<FaceBox> faces = face_boxes(mesh, tree.frame(), duplicates);
  tree.nodes.resize(2 * leaves_of(faces.size()) - 1);
  LeafRecursion(faces, tree.nodes).build({0, faces.size(), 0, 1, kMaxSplitDepth});
  tree.order.reserve(faces.size());
  for (const FaceBox& face : faces) tree.order.push_back(face.face);
  return tree;
}

}  // namespace boxtree::cooker
