// SPDX-License-Identifier: MIT
#include "cooker/choose/work.h"

#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "cooker/cook.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"

namespace boxtree::cooker {
namespace {

using test::require;

struct Reached {
  std::size_t nodes = 0;
  std::size_t leaves = 0;
};

// Every box of the tree that a box overlaps, by recursion.
void count(const Tree& tree, const Node& node, const Eigen::AlignedBox3d& box, Reached& reached) {
  const Eigen::AlignedBox3d here(Eigen::Map<const Eigen::Vector3d>(node.box.low.data()),
                                 Eigen::Map<const Eigen::Vector3d>(node.box.high.data()));
  if (!here.intersects(box)) return;
  if (node.is_leaf) {
    ++reached.leaves;
    return;
  }
  ++reached.nodes;
  NodeChildren children;
  ASSERT_EQ(BoundTree::of(tree).expand(node, children), NodeState::kValid);
  for (std::uint32_t i = 0; i < children.count; ++i) {
    count(tree, children.child[i], box, reached);
  }
}

TEST(CountWork, OfBoxesEqualsAWalkOverAllNodes) {
  const SourceMesh mesh = test::torus(40, 24);
  for (const CodecInfo& codec : kCodecs) {
    const EncodedTree encoded = require(cook_as(mesh, codec.id));
    const Tree tree = require(bind_encoded(encoded));
    Workload queries;
    queries.boxes = choice_queries(bounds_of(mesh)).boxes;
    Reached reached;
    for (const Eigen::AlignedBox3d& box : queries.boxes) {
      count(tree, BoundTree::of(tree).root(),
            {BoundTree::of(tree).frame().to_tree(box.min()),
             BoundTree::of(tree).frame().to_tree(box.max())},
            reached);
    }
    const auto boxes = static_cast<double>(queries.boxes.size());
    const Work work = require(count_work(tree, queries))[1];
    EXPECT_EQ(work.nodes, static_cast<double>(reached.nodes) / boxes) << codec.name;
    EXPECT_EQ(work.leaves, static_cast<double>(reached.leaves) / boxes) << codec.name;
    EXPECT_GT(reached.leaves, 0u);
  }
}

TEST(CountWork, EveryKindIsCountedAndTwiceTheSame) {
  const SourceMesh mesh = test::torus(40, 24);
  const Workload queries = choice_queries(bounds_of(mesh));
  const EncodedTree encoded = require(cook_as(mesh, CodecId::kWide4));
  const Tree tree = require(bind_encoded(encoded));
  const WorkOfKinds first = require(count_work(tree, queries));
  const WorkOfKinds second = require(count_work(tree, queries));
  for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
    EXPECT_GT(first[kind].nodes, 0) << kQueryNames[kind];
    EXPECT_GT(first[kind].leaves, 0) << kQueryNames[kind];
    EXPECT_EQ(first[kind].nodes, second[kind].nodes);
    EXPECT_EQ(first[kind].leaves, second[kind].leaves);
  }
}

// Found by a robustness test: every query met every triangle, and pairs met every pair.
TEST(CountWork, EndsWhereAllFacesLieOnTopOfEachOther) {
  SourceMesh mesh = test::torus(3, 3);
  mesh.faces.assign(200'000, mesh.faces.front());
  const EncodedTree encoded = require(cook_as(mesh, CodecId::kWide8));
  const Tree tree = require(bind_encoded(encoded));
  for (const Work& work : require(count_work(tree, choice_queries(bounds_of(mesh))))) {
    EXPECT_LE(work.nodes + work.leaves, 1'000'008);
  }
}

// Found by a tester: pairs of triangles on one line, each by exact arithmetic, took minutes.
TEST(CountWork, ComparesNoTrianglesOfLeaves) {
  SourceMesh mesh;
  constexpr std::uint32_t kFaces = 2000;
  std::mt19937 random(1);
  for (std::uint32_t vertex = 0; vertex < 3 * kFaces; ++vertex) {
    const auto along = static_cast<float>(random() >> 10);  // so that thrice that is exact
    mesh.positions.f32.insert(mesh.positions.f32.end(), {along, 2 * along, 3 * along});
    if (vertex % 3 == 2) mesh.faces.push_back({{vertex - 2, vertex - 1, vertex, kNoCorner}});
  }
  const EncodedTree encoded = require(cook_as(mesh, CodecId::kWide8));
  const Tree tree = require(bind_encoded(encoded));
  const WorkOfKinds work = require(count_work(tree, choice_queries(bounds_of(mesh))));
  EXPECT_GT(work[static_cast<std::size_t>(QueryKind::kPair)].leaves, kFaces);
}

TEST(CountWork, ATreeWithoutFacesHasNone) {
  const EncodedTree encoded = require(cook_as(SourceMesh(), CodecId::kWide8));
  const Tree tree = require(bind_encoded(encoded));
  const Workload queries = choice_queries(bounds_of(test::torus(4, 4)));
  for (const Work& work : require(count_work(tree, queries))) {
    EXPECT_EQ(work.nodes, 0);
    EXPECT_EQ(work.leaves, 0);
  }
}

}  // namespace
}  // namespace boxtree::cooker
