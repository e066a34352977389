// SPDX-License-Identifier: MIT
// Full leaves, the collapse and the codes of the wide codecs.
#include <algorithm>
#include <bit>
#include <numeric>

#include <gtest/gtest.h>

#include "cooker/encode/encoders.h"
#include "cooker/encode/wide_collapse.h"
#include "tests/support/meshes.h"

namespace boxtree::cooker {
namespace {

std::vector<SourceMesh> meshes() {
  std::vector<SourceMesh> all = test::all_kinds();
  for (unsigned faces = 1; faces <= 140; faces += 7) all.push_back(test::soup(faces, faces));
  return all;
}

TEST(FullLeaves, EveryFaceOnceAndAllLeavesFullButTheLast) {
  for (const SourceMesh& mesh : meshes()) {
    const BuildTree tree = build_full_leaves(mesh);
    std::vector<std::uint32_t> sorted = tree.order;
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint32_t> all(mesh.faces.size());
    std::iota(all.begin(), all.end(), 0u);
    EXPECT_EQ(sorted, all) << mesh.name;
    std::uint32_t next = 0;
    for (const BuildNode& node : tree.nodes) {
      if (!node.is_leaf()) continue;
      EXPECT_EQ(node.first(), next) << mesh.name;
      next += kLeafFaces;
    }
    EXPECT_EQ(tree.nodes.size(), 2 * ((mesh.faces.size() + 7) / 8) - 1) << mesh.name;
  }
}

// The collapse against every other choice of children, on trees small enough to try all.
double cheapest(const BuildTree& tree, std::uint32_t node, double node_cost);
double cheapest_forest(const BuildTree& tree, const std::vector<std::uint32_t>& roots,
                       double node_cost) {
  double cost = 0;
  for (const std::uint32_t root : roots) cost += cheapest(tree, root, node_cost);
  for (std::size_t i = 0; i < roots.size() && roots.size() < kWideChildren; ++i) {
    if (tree.nodes[roots[i]].is_leaf()) continue;
    std::vector<std::uint32_t> opened = roots;
    opened[i] = roots[i] + 1;
    opened.push_back(tree.nodes[roots[i]].right);
    cost = std::min(cost, cheapest_forest(tree, opened, node_cost));
  }
  return cost;
}
double area_of(const BuildTree& tree, std::uint32_t node) {
  const Box<float>& box = tree.nodes[node].bounds;
  const double x = double{box.high[0]} - box.low[0];
  const double y = double{box.high[1]} - box.low[1];
  const double z = double{box.high[2]} - box.low[2];
  return x * y + y * z + z * x;
}
double cheapest(const BuildTree& tree, std::uint32_t node, double node_cost) {
  if (tree.nodes[node].is_leaf()) return 0;
  return area_of(tree, node) / area_of(tree, 0) + node_cost +
         cheapest_forest(tree, {node + 1, tree.nodes[node].right}, node_cost);
}
double chosen(const BuildTree& tree, const WideCollapse& collapse, std::uint32_t node,
              double node_cost) {
  if (tree.nodes[node].is_leaf()) return 0;
  std::vector<std::uint32_t> children;
  collapse.children_of(node, children);
  EXPECT_GE(children.size(), 2u);
  EXPECT_LE(children.size(), kWideChildren);
  double cost = area_of(tree, node) / area_of(tree, 0) + node_cost;
  for (const std::uint32_t child : children) cost += chosen(tree, collapse, child, node_cost);
  return cost;
}

TEST(WideCollapse, NoChoiceOfChildrenIsCheaper) {
  for (const double node_cost : {0.0, 0.01, 1.0}) {
    for (const unsigned faces : {9u, 40u, 72u, 100u}) {
      const BuildTree tree = build_full_leaves(test::soup(faces, faces));
      const WideCollapse collapse(tree, node_cost);
      EXPECT_NEAR(chosen(tree, collapse, 0, node_cost), cheapest(tree, 0, node_cost), 1e-9)
          << faces << " faces, cost " << node_cost;
    }
  }
}

std::size_t nodes_below(const BuildTree& tree, const WideCollapse& collapse, std::uint32_t node) {
  if (tree.nodes[node].is_leaf()) return 0;
  std::vector<std::uint32_t> children;
  collapse.children_of(node, children);
  std::size_t nodes = 1;
  for (const std::uint32_t child : children) nodes += nodes_below(tree, collapse, child);
  return nodes;
}

// Where bytes are all that counts, every node has eight children but for what does not come out
// even. Faces that all lie in one place have no area and no order, and are divided all the same.
TEST(WideCollapse, NodesAreAsFewAsLeavesAllow) {
  std::vector<SourceMesh> all = meshes();
  for (const unsigned faces : {500u, 513u, 1000u, 5003u, 20000u}) {
    all.push_back(test::soup(faces, faces));
    SourceMesh duplicates = test::soup(1, faces);
    duplicates.faces.resize(faces, duplicates.faces[0]);
    duplicates.face_ids.resize(faces);
    all.push_back(duplicates);
  }
  for (const SourceMesh& mesh : all) {
    const BuildTree tree = build_full_leaves(mesh);
    const std::size_t leaves = leaves_of(mesh.faces.size());
    if (leaves < 2) continue;
    const WideCollapse collapse(tree, 1e6);
    EXPECT_EQ(nodes_below(tree, collapse, 0), (leaves - 1 + 6) / 7)
        << mesh.name << ", " << mesh.faces.size() << " faces";
  }
}

// The same with the weights of the cooker: 64 and 32 bytes a node, 1.3 and 0.65 a triangle.
TEST(WideLayout, TreesAreSmall) {
  for (const unsigned faces : {1000u, 4000u, 20000u}) {
    for (const SourceMesh& mesh : {test::soup(faces, 1), test::sphere(50, faces / 100)}) {
      const WideLayout layout = lay_out_wide(build_full_leaves(mesh));
      EXPECT_LE(static_cast<double>(layout.nodes.size()) * sizeof(Wide8Node),
                1.3 * static_cast<double>(mesh.faces.size()))
          << mesh.name << ", " << mesh.faces.size() << " faces";
    }
  }
}

// What every query reads some of lies together: the nodes of the top three levels have the first
// numbers, level by level, whatever is below them.
TEST(WideLayout, TopLevelsStandTogether) {
  bool goes_deeper = false;
  for (const SourceMesh& mesh :
       {test::soup(40'000, 1), test::sphere(100, 100), test::soup(50, 2)}) {
    const WideLayout layout = lay_out_wide(build_full_leaves(mesh));
    std::uint32_t next = 1;
    std::vector<std::uint32_t> level = {0};
    for (int depth = 1; depth < 3; ++depth) {
      std::vector<std::uint32_t> below;
      for (const std::uint32_t node : level) {
        const WideLinks& links = layout.nodes[node].links;
        const auto count = static_cast<std::uint32_t>(std::popcount(links.inner_mask));
        if (count == 0) continue;
        EXPECT_EQ(links.first_node, next) << mesh.name << ", node " << node;
        for (std::uint32_t i = 0; i < count; ++i) below.push_back(next++);
      }
      level = below;
    }
    goes_deeper |= next < layout.nodes.size();
  }
  EXPECT_TRUE(goes_deeper);
}

TEST(WideEncoder, LeavesFollowTheirNumbersWhateverTheCount) {
  for (const SourceMesh& mesh : meshes()) {
    const WideLayout layout = lay_out_wide(build_full_leaves(mesh));
    std::vector<std::uint32_t> sorted = layout.face_order;
    std::sort(sorted.begin(), sorted.end());
    std::vector<std::uint32_t> all(mesh.faces.size());
    std::iota(all.begin(), all.end(), 0u);
    EXPECT_EQ(sorted, all) << mesh.name;
    for (const CodecId codec : {CodecId::kWide8, CodecId::kWide4}) {
      EXPECT_EQ(encode_wide(layout, codec).leaf_count, (mesh.faces.size() + 7) / 8) << mesh.name;
    }
  }
}

// A box of one mesh in two sizes of code: the finer one is never looser.
TEST(WideEncoder, MoreBitsNeverVisitMore) {
  for (const SourceMesh& mesh : {test::sphere(24, 32), test::terrain(40, 3), test::city(6, 2)}) {
    const WideLayout layout = lay_out_wide(build_full_leaves(mesh));
    const ExpectedVisits fine = encode_wide(layout, CodecId::kWide8).visits;
    const ExpectedVisits coarse = encode_wide(layout, CodecId::kWide4).visits;
    EXPECT_LE(fine.ray, coarse.ray) << mesh.name;
    EXPECT_LE(fine.box, coarse.box) << mesh.name;
    EXPECT_LE(fine.pair, coarse.pair) << mesh.name;
  }
}

}  // namespace
}  // namespace boxtree::cooker
