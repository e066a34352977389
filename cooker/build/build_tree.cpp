// SPDX-License-Identifier: MIT
// The recursion that applies a split rule: preorder nodes, one triangle per leaf, bounded depth.
#include "cooker/build/build_tree.h"

#include <algorithm>

#include <oneapi/tbb/parallel_invoke.h>

#include "cooker/build/face_boxes.h"
#include "cooker/build/splitter.h"

namespace boxtree::cooker {
namespace {

// Subtrees with fewer faces than this are built by one thread: a task costs about a microsecond, a
// subtree of this size some hundred.
constexpr std::size_t kParallelFaces = 2048;

class Recursion {
 public:
  Recursion(std::span<FaceBox> faces, std::span<BuildNode> nodes, SplitRule rule)
      : faces_(faces), nodes_(nodes), rule_(rule) {}

  // Builds faces [first, last) into the nodes from `node` on. n faces fill exactly 2n - 1 nodes, so
  // the place of every subtree is known in advance and threads write to separate places.
  void build(std::size_t first, std::size_t last, std::size_t node, std::uint32_t depth_left) {
    const std::size_t count = last - first;
    const std::span<FaceBox> faces = faces_.subspan(first, count);
    Box<float> bounds = empty_box<float>();
    for (const FaceBox& face : faces) expand(bounds, face.box);
    if (count == 1) {
      nodes_[node] = {bounds, 0, faces[0].face};
      return;
    }

    const Split split = choose_split(faces, bounds, depth_left);
    const std::size_t middle = first + split.left_count;
    const std::size_t left = node + 1;
    const std::size_t right = node + 2 * split.left_count;
    const auto build_left = [&] { build(first, middle, left, depth_left - 1); };
    const auto build_right = [&] { build(middle, last, right, depth_left - 1); };
    if (count >= kParallelFaces) {
      tbb::parallel_invoke(build_left, build_right);
    } else {
      build_left();
      build_right();
    }
    nodes_[node] = inner_node(nodes_, node, right, split.axis);
  }

 private:
  // Even halving needs ceil(log2 n) levels. The rule is used only if more levels are left.
  Split choose_split(std::span<FaceBox> faces, const Box<float>& bounds,
                     std::uint32_t depth_left) const {
    if (halvings(faces.size()) < depth_left) {
      if (const std::optional<Split> split = rule_(faces, bounds)) return *split;
    }
    return split_at(faces, faces.size() / 2, widest_axis(bounds));
  }

  std::span<FaceBox> faces_;
  std::span<BuildNode> nodes_;
  SplitRule rule_;
};

}  // namespace

BuildTree build_tree(const MeshView& mesh, Builder builder, Origin origin,
                     const Duplicates& duplicates) {
  BuildTree tree;
  choose_frame(mesh.positions, origin, tree);
  if (mesh.faces.empty()) return tree;
  std::vector<FaceBox> faces = face_boxes(mesh, tree.frame(), duplicates);
  tree.nodes.resize(2 * faces.size() - 1);
  const SplitRule rule = builder == Builder::kSah ? split_sah : split_paper;
  Recursion(faces, tree.nodes, rule).build(0, faces.size(), 0, kMaxSplitDepth);
  return tree;
}

}  // namespace boxtree::cooker
