// SPDX-License-Identifier: MIT
// What queries cost: limits of the caller, and the bounds that hold for any bytes.
#include <functional>
#include <set>

#include <gtest/gtest.h>

#include "format/codec_plain.h"
#include "format/codec_wide.h"
#include "format/container.h"
#include "runtime/query/pair_work.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/coincident.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"
#include "tests/support/tree_queries.h"

namespace boxtree {
namespace {

constexpr auto kGoOn = [](const auto&) { return true; };

Eigen::AlignedBox3d everywhere() {
  return {Eigen::Vector3d::Constant(-1e6), Eigen::Vector3d::Constant(1e6)};
}

using test::Outcome;

// A query under a limit.
struct LimitedQuery {
  const char* name;
  std::function<Outcome(const QueryLimits&)> run_query;
};

template <class T, class Value>
Outcome outcome(const Result<T>& result, const Value& value) {
  return result ? Outcome{Errc::kOk, value(*result)} : Outcome{result.code(), 0};
}
template <class T>
Outcome outcome_of_hit(const QueryResult<T>& result, double (*value)(const T&)) {
  return {result.code(), result.has_value() ? value(*result) : result.ok() ? -1 : 0};
}
// Of a query with a visitor: how many it was told of.
Outcome outcome_of_visit(const std::function<Result<Visit>(std::size_t& told)>& run_query) {
  std::size_t told = 0;
  const Result<Visit> visit = run_query(told);
  return outcome(visit, [&](Visit) { return static_cast<double>(told); });
}

// The least limit under which a query is answered; every larger one gives the same answer, every
// smaller one kWorkLimit.
std::uint64_t least_limit(const LimitedQuery& query) {
  const Outcome whole = query.run_query({});
  EXPECT_EQ(whole.error, Errc::kOk);
  std::uint64_t nodes = 0;
  for (; nodes < 100000; ++nodes) {
    const Outcome limited = query.run_query({nodes});
    if (limited.error == Errc::kOk) {
      EXPECT_EQ(limited.answer, whole.answer) << nodes;
      break;
    }
    EXPECT_EQ(limited.error, Errc::kWorkLimit) << nodes;
  }
  for (const std::uint64_t more : {nodes + 1, 2 * nodes + 9}) {
    const Outcome limited = query.run_query({more});
    EXPECT_EQ(limited.error, Errc::kOk) << more;
    EXPECT_EQ(limited.answer, whole.answer) << more;
  }
  return nodes;
}

test::QuerySet queries() {
  test::QuerySet queries;
  queries.ray = {{0.1, 0.2, 50}, {0.01, 0.02, -1}};
  queries.box = everywhere();
  queries.point = {1, 0.5, 0.25};
  queries.near.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  return queries;
}

class Limits : public testing::TestWithParam<CodecId> {};

std::uint64_t most_pairs_with_itself(const Tree& tree) {
  const BoundTree& bound = BoundTree::of(tree);
  return most_pairs(bound.codec(), bound.counts(), bound.codec(), bound.counts());
}

TEST_P(Limits, TellWhenTheyDoNotSuffice) {
  const test::CookedTree cooked = test::cook_tree(test::torus(12, 8), GetParam());
  const std::uint64_t nodes = BoundTree::of(cooked.tree).node_count();
  for (const test::TreeQuery& query : test::tree_queries(queries())) {
    if (!query.takes_limits) continue;
    SCOPED_TRACE(query.name);
    const std::uint64_t least =
        least_limit({query.name, [&](const QueryLimits& limits) {
                       return query.run_query(cooked.tree, cooked.tree, limits);
                     }});
    EXPECT_GT(least, 0u);
    EXPECT_LE(least, query.is_of_pairs ? most_pairs_with_itself(cooked.tree) : nodes);
    // Everything is inside the box: every node is expanded.
    if (std::string(query.name) == "overlap_box") {
      EXPECT_EQ(least, nodes);
    }
  }
}

TEST_P(Limits, WhatWasToldBeforeIsTrue) {
  const test::CookedTree cooked = test::cook_tree(test::torus(12, 8), GetParam());
  for (const std::uint64_t nodes : {0u, 1u, 2u, 5u}) {
    std::set<std::uint32_t> told;
    const Result<Visit> visit =
        overlap_box(cooked.tree, everywhere(),
                    [&](const FaceRef& face) { return told.insert(face.id).second; }, {nodes});
    if (nodes >= BoundTree::of(cooked.tree).node_count()) continue;
    EXPECT_EQ(visit.code(), Errc::kWorkLimit);
    EXPECT_LT(told.size(), BoundTree::of(cooked.tree).face_count());
    EXPECT_LE(told.size(), nodes * kWideChildren * kLeafFaces);
  }
}

INSTANTIATE_TEST_SUITE_P(Codecs, Limits, testing::ValuesIn(test::all_codecs()), test::test_name);

// Instances count one each, and what is spent in one is not there for the next.
TEST(SceneLimits, CountForAllInstancesTogether) {
  test::CookedScene cooked =
      test::cook_scene({test::torus(12, 8), test::city(4, 1)}, test::random_parts(12, 2, 3, 1, 1));
  Scene scene = test::require(Scene::bind(cooked.file));
  const Tree body = test::require(Tree::bind(cooked.file, 0));
  const Ray ray{{-200, 0.3, 0.2}, {1, 0, 0}};
  const auto counting = [](std::size_t& told) {
    return [&told](const auto&) { return ++told > 0; };
  };
  const std::vector<LimitedQuery> queries = {
      {"closest_hit",
       [&](const QueryLimits& limits) {
         return outcome_of_hit<SceneRayHit>(closest_hit(scene, ray, kAllLayers, limits),
                                            [](const SceneRayHit& hit) { return hit.t; });
       }},
      {"any_hit",
       [&](const QueryLimits& limits) {
         return outcome_of_hit<SceneRayHit>(any_hit(scene, ray, kAllLayers, limits),
                                            [](const SceneRayHit& hit) { return hit.t; });
       }},
      {"overlap_box",
       [&](const QueryLimits& limits) {
         return outcome_of_visit([&](std::size_t& told) {
           return overlap_box(scene, everywhere(), counting(told), kAllLayers, limits);
         });
       }},
      {"overlap_sphere",
       [&](const QueryLimits& limits) {
         return outcome_of_visit([&](std::size_t& told) {
           return overlap_sphere(scene, {0, 0, 0}, 1e4, counting(told), kAllLayers, limits);
         });
       }},
      {"closest_point",
       [&](const QueryLimits& limits) {
         return outcome_of_hit<SceneClosestPoint>(
             closest_point(scene, {3, 2, 1}, 1e4, kAllLayers, limits),
             [](const SceneClosestPoint& found) { return found.distance; });
       }},
      {"cast_closest",
       [&](const QueryLimits& limits) {
         SceneFaceOptions options;
         options.limits = limits;
         return outcome_of_hit<SceneCastHit>(
             cast_closest(scene, Sphere{ray.origin, 1}, {ray.direction}, options),
             [](const SceneCastHit& hit) { return hit.t; });
       }},
      {"all_hits",
       [&](const QueryLimits& limits) {
         SceneFaceOptions options;
         options.limits = limits;
         return outcome_of_visit([&](std::size_t& told) {
           return all_hits(
               scene, ray, [&](const SceneRayHit&) { return ++told, 1e9; }, options);
         });
       }},
      {"collide",
       [&](const QueryLimits& limits) {
         return outcome_of_visit([&](std::size_t& told) {
           return collide(scene, Sphere{{0, 0, 0}, 9}, counting(told), kAllLayers, limits);
         });
       }},
      {"contacts",
       [&](const QueryLimits& limits) {
         return outcome_of_visit(
             [&](std::size_t& told) { return contacts(scene, counting(told), limits); });
       }},
      {"contacts_of",
       [&](const QueryLimits& limits) {
         return outcome_of_visit(
             [&](std::size_t& told) { return contacts_of(scene, 0, counting(told), limits); });
       }},
      {"overlap_pairs",
       [&](const QueryLimits& limits) {
         return outcome_of_visit([&](std::size_t& told) {
           return overlap_pairs(scene, body, Pose::Identity(), counting(told), kAllLayers, limits);
         });
       }},
  };
  for (const LimitedQuery& query : queries) {
    SCOPED_TRACE(query.name);
    EXPECT_GT(least_limit(query), 0u);
  }
  // All is in the box: every instance and all nodes of its tree.
  std::uint64_t all = 0;
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    all += 1 + BoundTree::of(scene.trees()[test::require(scene.info(i)).tree]).node_count();
  }
  EXPECT_EQ(least_limit(queries[2]), all);
}

// The bound on the work that two trees of hostile bytes can make.
TEST(MostPairs, IsTheProductOfNodesAndLeaves) {
  constexpr CodecId kBinary = CodecId::kPlainF32;
  EXPECT_EQ(most_leaves(kBinary, {3, 4}), 4u);
  EXPECT_EQ(most_leaves(kBinary, {3, 40}), 4u);  // two children each at most
  EXPECT_EQ(most_leaves(kBinary, {0, 1}), 1u);
  EXPECT_EQ(most_leaves(CodecId::kWide8, {3, 40}), 5u);
  EXPECT_EQ(most_leaves(CodecId::kWide4, {3, 41}), 6u);
  const auto most_pairs = [](const TreeCounts& first, const TreeCounts& second) {
    return boxtree::most_pairs(kBinary, first, kBinary, second);
  };
  EXPECT_EQ(most_pairs({3, 4}, {5, 6}), 77u);
  EXPECT_EQ(most_pairs({0, 0}, {5, 6}), 0u);
  EXPECT_EQ(most_pairs({5, 6}, {0, 0}), 0u);
  const TreeCounts largest{kMaxNodes, kMaxFaces};
  const std::uint64_t size = std::uint64_t{kMaxNodes} + kMaxFaces;
  EXPECT_EQ(most_pairs(largest, largest), saturated_product(size, size));
  EXPECT_EQ(saturated_product(size, size), ~std::uint64_t{0});
  EXPECT_EQ(saturated_product(0xffffffffu, 0xffffffffu), 0xfffffffe00000001u);
}

// Nodes in levels whose nodes all have the same children; the last ones have the first leaves, so
// that the same faces are met over and over.
std::vector<std::byte> shared_leaves_binary() {
  std::vector<std::byte> bytes = test::cook_bytes(test::soup(61, 1), CodecId::kPlainF32);
  test::edit_records<PlainNodeF32>(
      bytes, SectionKind::kNodes, [](PlainNodeF32& node, std::uint32_t i, std::uint32_t) {
        constexpr std::uint32_t kLevels = 12;
        if (i < kLevels) {
          node = {plain_cutplane(0, PlainChild::kSubtree, PlainChild::kSubtree),
                  {i + 1, i + 1},
                  {0, 0}};
        } else {
          node = {plain_cutplane(0, PlainChild::kLeaf, PlainChild::kLeaf), {0, 1}, {0, 0}};
        }
      });
  return bytes;
}
std::vector<std::byte> shared_leaves_wide() {
  std::vector<std::byte> bytes = test::cook_bytes(test::soup(1200, 1), CodecId::kWide8);
  test::edit_records<Wide8Node>(bytes, SectionKind::kNodes,
                                [](Wide8Node& node, std::uint32_t i, std::uint32_t) {
                                  node = {};
                                  node.child_count = 8;
                                  if (i < 9) {
                                    node.first_node = i == 0 ? 1 : 9;
                                    node.inner_mask = 0xff;
                                  }
                                });
  return bytes;
}

TEST(HostileLeaves, ThatHoldTheSameFacesEndPairQueries) {
  for (const std::vector<std::byte>& bytes : {shared_leaves_binary(), shared_leaves_wide()}) {
    const File file = test::require(File::open(Bytes(bytes)));
    const Tree tree = test::require(Tree::bind(file));
    const std::uint64_t most = saturated_product(BoundTree::of(tree).counts().faces_in_leaves,
                                                 BoundTree::of(tree).counts().faces_in_leaves);
    std::uint64_t told = 0;
    const Pose here = Pose::Identity();
    const auto count = [&](const FacePair&) { return ++told > 0; };
    EXPECT_EQ(overlap_pairs(tree, here, tree, here, count).code(), Errc::kNodeCorrupt);
    EXPECT_LE(told, most);
    Pose apart = here;
    apart.translation() = Eigen::Vector3d(0, 0, 1e-3);
    const Result<Distance> distant = distance(tree, here, tree, apart);
    EXPECT_TRUE(distant.ok() || distant.code() == Errc::kNodeCorrupt);
    if (distant) {
      EXPECT_LE(distant->nodes_expanded, most_pairs_with_itself(tree));
    }
  }
}

// Queries on scenes of hostile trees visit each instance once.
TEST(HostileLeaves, OfATopLevelAreVisitedOnce) {
  test::CookedScene cooked =
      test::cook_scene({test::torus(12, 8)}, test::random_parts(40, 1, 0, 1, 1));
  test::edit_records<Wide8Node>(cooked.bytes, SectionKind::kSceneNodes,
                                [](Wide8Node& node, std::uint32_t i, std::uint32_t count) {
                                  ASSERT_GE(count, 6u);
                                  node = {};
                                  node.child_count = 8;
                                  node.first_node = i == 0 ? 1 : 0;
                                  node.inner_mask = i == 0 ? 0x1f : 0;
                                });
  const File file = test::require(File::open(Bytes(cooked.bytes)));
  const Scene scene = test::require(Scene::bind(file));
  std::size_t told = 0;
  const Result<Visit> visit =
      overlap_box(scene, everywhere(), [&](const SceneFace&) { return ++told > 0; });
  // Three instances at the root and eight below each of its five nodes: 43 visits of 40 instances.
  EXPECT_EQ(visit.code(), Errc::kNodeCorrupt);
  EXPECT_EQ(told, 40 * BoundTree::of(scene.trees()[0]).face_count());
}

// Copies of a face are told again each time that a leaf with it is met.
TEST(HostileLeaves, WithCopiesAreToldOnce) {
  const cooker::SourceMesh mesh = test::mixed(test::identical_faces(300), test::soup(300, 1));
  std::vector<std::byte> bytes = test::cook_bytes(mesh, CodecId::kWide8);
  std::uint32_t original = 0;
  {
    const File file = test::require(File::open(Bytes(bytes)));
    const Tree tree = test::require(Tree::bind(file));
    ASSERT_TRUE(BoundTree::of(tree).has_duplicates());
    original = BoundTree::of(tree).original_of(tree.face_count() - 1);
  }
  const std::uint32_t leaf = std::min(original / kLeafFaces, 300 / kLeafFaces - 8);
  test::edit_records<Wide8Node>(
      bytes, SectionKind::kNodes, [&](Wide8Node& node, std::uint32_t i, std::uint32_t count) {
        node = {};
        node.child_count = static_cast<std::uint8_t>(i == 0 ? std::min(count - 1, 8u) : 8);
        node.first_node = i == 0 ? 1 : 0;
        node.inner_mask = static_cast<std::uint8_t>(i == 0 ? 0xff >> (8 - node.child_count) : 0);
        node.first_leaf = leaf;
      });
  const File file = test::require(File::open(Bytes(bytes)));
  const Tree tree = test::require(Tree::bind(file));
  std::uint64_t told = 0;
  const auto count = [&](const auto&) { return ++told > 0; };
  EXPECT_EQ(overlap_box(tree, everywhere(), count).code(), Errc::kNodeCorrupt);
  EXPECT_GT(told, 299u);
  EXPECT_LE(told, 8 * 64 + 299u);
  told = 0;
  EXPECT_EQ(overlap_sphere(tree, {0, 0, 0}, 1e6, count).code(), Errc::kNodeCorrupt);
  EXPECT_LE(told, 8 * 64 + 299u);
  told = 0;
  const auto count_touch = [&](const CastHit&) { return static_cast<double>(++told); };
  EXPECT_EQ(cast_all(tree, Sphere{{0, 0, 0}, 1e6}, Motion(), count_touch).code(),
            Errc::kNodeCorrupt);
  EXPECT_GT(told, 299u);
  EXPECT_LE(told, 8 * 64 + 299u);
  told = 0;
  const Pose here = Pose::Identity();
  static_cast<void>(overlap_pairs(tree, here, tree, here, count));
  EXPECT_LE(told, std::uint64_t{599} * 599 + std::uint64_t{300} * 300);
}

}  // namespace
}  // namespace boxtree
