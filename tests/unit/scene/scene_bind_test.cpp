// SPDX-License-Identifier: MIT
// Binding scenes: what the file says, what was left out, what cannot move; and damaged bytes.
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "cooker/encode/face_numbers.h"
#include "cooker/proof/proof.h"
#include "format/container.h"
#include "runtime/file/open_file.h"
#include "runtime/scene/bound_scene.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"

namespace boxtree {
namespace {

using cooker::LeftOutPart;
using test::CookedScene;
using test::require;

cooker::SceneParts named_parts() {
  cooker::SceneParts parts = test::random_parts(9, 2, 4, 2, 1);
  parts.materials = {"wood", "stone"};
  parts.tree_materials.resize(2);
  parts.tree_materials[0].runs = {{0, 1}, {10, 0}};
  return parts;
}

// Three named instances at rest, of two trees.
cooker::SceneParts random_parts() {
  return test::random_parts(3, 2, 0, 1, 1);
}

CookedScene cook(const cooker::SceneParts& parts) {
  return test::cook_scene({test::sphere(6, 8), test::torus(6, 8)}, parts);
}

TEST(SceneBind, TellsWhatWasCooked) {
  const cooker::SceneParts parts = named_parts();
  const CookedScene cooked = cook(parts);
  EXPECT_TRUE(cooker::verify_file(cooked.file).empty());
  SceneOptions options;
  options.queries = kAllQueries;
  options.require_face_ids = options.require_materials = options.require_names = true;
  const Scene scene = require(Scene::bind(cooked.file, options));
  ASSERT_EQ(scene.instance_count(), 9u);
  EXPECT_EQ(scene.layer_count(), 2u);
  EXPECT_EQ(scene.layer_name(1), "layer 1");
  EXPECT_EQ(scene.material_name(0), "wood");
  EXPECT_EQ(scene.material_name(2), "");
  std::set<std::uint32_t> ids;
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    const InstanceInfo info = require(scene.info(i));
    const cooker::PlacedTree& source = parts.instances[info.id];
    ids.insert(info.id);
    EXPECT_EQ(info.name, source.name);
    EXPECT_EQ(info.tree, source.tree);
    EXPECT_EQ(info.layer, source.layer);
    EXPECT_EQ(info.moves, source.moves);
    EXPECT_EQ(require(scene.pose(i)).matrix(), source.pose.matrix());
    EXPECT_EQ(require(scene.find_instance(source.name)), i);
    EXPECT_EQ(scene.material({i, {9, 0}}), info.tree == 0 ? 1 : kNoMaterial);
    EXPECT_EQ(scene.material({i, {10, 0}}), info.tree == 0 ? 0 : kNoMaterial);
  }
  EXPECT_EQ(ids.size(), 9u);
  EXPECT_EQ(scene.info(9).error().message(),
            "instance_index: there is no instance 9; expected 0 to 8");
  EXPECT_EQ(scene.find_instance("nobody").code(), Errc::kInstanceIndex);
}

TEST(SceneBind, PosesTakeF32WhereThatLosesNothing) {
  cooker::SceneParts parts = test::random_parts(3, 1, 0, 1, 1);
  EXPECT_EQ(OpenFile::of(cook(parts).file).section(SectionKind::kPoses).size(),
            3 * 12 * sizeof(double));
  for (cooker::PlacedTree& placed : parts.instances) {
    placed.pose.matrix() = placed.pose.matrix().cast<float>().cast<double>();
  }
  const CookedScene cooked = cook(parts);
  EXPECT_EQ(OpenFile::of(cooked.file).section(SectionKind::kPoses).size(), 3 * 12 * sizeof(float));
  const Scene scene = require(Scene::bind(cooked.file));
  for (std::uint32_t i = 0; i < 3; ++i) {
    EXPECT_EQ(require(scene.pose(i)).matrix(),
              parts.instances[require(scene.info(i)).id].pose.matrix());
  }
}

TEST(SceneBind, NamesTheLineThatLeftAPartOut) {
  cooker::SceneParts parts = test::random_parts(3, 1, 0, 1, 1);
  parts.queries = kRayQueries;
  parts.left_out.push_back({Part::kPairs, kNoOwner, 12, "scene.toml:12: queries = [\"ray\"]"});
  const CookedScene cooked = cook(parts);
  EXPECT_TRUE(cooker::verify_file(cooked.file).empty());
  SceneOptions options;
  options.queries = kRayQueries;
  const Scene scene = require(Scene::bind(cooked.file, options));
  options.queries = kPairQueries;
  const Result<Scene> refused = Scene::bind(cooked.file, options);
  EXPECT_EQ(refused.code(), Errc::kPartLeftOut);
  EXPECT_EQ(refused.error().detail,
            "the scene: pair queries were left out by scene.toml:12: queries = [\"ray\"]");
  EXPECT_EQ(contacts(scene, [](const ScenePair&) { return true; }).code(), Errc::kPartLeftOut);
  // A query allocates no text: it says where the line is told.
  EXPECT_EQ(closest_point(scene, {0, 0, 0}).error().message(),
            "part_left_out: a needed part was left out; require it when the file is bound, "
            "which tells the line");
  options = {};
  options.require_materials = true;
  EXPECT_EQ(Scene::bind(cooked.file, options).error().detail,
            "the scene: materials were left out when it was cooked, by materials = false of its "
            "profile, or its source has none");
}

// With no more than one kind in the file, queries of the others are refused, each of them.
TEST(SceneBind, QueriesOfKindsThatWereLeftOutAreRefused) {
  const CookedScene whole = cook(random_parts());
  const Tree tree = require(Tree::bind(whole.file, 0));
  for (const QueryKinds kept : {kRayQueries, kBoxQueries, kPointQueries, kPairQueries}) {
    SCOPED_TRACE(int{kept});
    cooker::SceneParts parts = random_parts();
    parts.queries = kept;
    const CookedScene cooked = cook(parts);
    const Scene scene = require(Scene::bind(cooked.file));
    const auto expected = [kept](QueryKinds kind) {
      return kind == kept ? Errc::kOk : Errc::kPartLeftOut;
    };
    for (const QueryKinds kind : {kRayQueries, kBoxQueries, kPointQueries, kPairQueries}) {
      SceneOptions options;
      options.queries = kind;
      EXPECT_EQ(Scene::bind(cooked.file, options).code(), expected(kind)) << int{kind};
    }
    const auto all = [](const auto&) { return true; };
    const Ray ray{{-9, 0.1, 0.2}, {1, 0.01, 0.02}};
    const Eigen::AlignedBox3d box(Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1));
    EXPECT_EQ(closest_hit(scene, ray).code(), expected(kRayQueries));
    EXPECT_EQ(any_hit(scene, ray).code(), expected(kRayQueries));
    EXPECT_EQ(overlap_box(scene, box, all).code(), expected(kBoxQueries));
    EXPECT_EQ(overlap_sphere(scene, {0, 0, 0}, 1, all).code(), expected(kBoxQueries));
    EXPECT_EQ(closest_point(scene, {0, 0, 0}).code(), expected(kPointQueries));
    EXPECT_EQ(contacts(scene, all).code(), expected(kPairQueries));
    EXPECT_EQ(contacts_of(scene, 0, all).code(), expected(kPairQueries));
    EXPECT_EQ(overlap_pairs(scene, tree, Pose::Identity(), all).code(), expected(kPairQueries));
  }
}

// Of several lines that left materials out, that of the whole scene is named rather than that of a
// tree; but one of a tree rather than none, and never that of another part.
TEST(SceneBind, NamesTheLineThatFitsBest) {
  const LeftOutPart of_tree{Part::kMaterials, 1, 7, "line 7"};
  const LeftOutPart of_scene{Part::kMaterials, kNoOwner, 8, "line 8"};
  const LeftOutPart of_names{Part::kNames, kNoOwner, 9, "line 9"};
  const auto refusal = [](std::vector<LeftOutPart> left_out) {
    cooker::SceneParts parts = random_parts();
    parts.left_out = std::move(left_out);
    const CookedScene cooked = cook(parts);
    SceneOptions options;
    options.require_materials = true;
    return Scene::bind(cooked.file, options).error().detail;
  };
  const std::string materials = "the scene: materials were left out ";
  EXPECT_EQ(refusal({of_names, of_tree}), materials + "by line 7");
  EXPECT_EQ(refusal({of_tree, of_scene}), materials + "by line 8");
  EXPECT_EQ(refusal({of_scene, of_tree}), materials + "by line 8");
  EXPECT_EQ(refusal({of_names}),
            materials +
                "when it was cooked, by materials = false of its profile, or its "
                "source has none");
}

// The reason for a tree is that of this tree, else that of the scene, else that of any tree.
TEST(SceneBind, NamesTheLineThatLeftFaceIdsOfATreeOut) {
  const LeftOutPart of_tree{Part::kFaceIds, 1, 7, "line 7"};
  const LeftOutPart of_scene{Part::kFaceIds, kNoOwner, 8, "line 8"};
  const LeftOutPart of_other{Part::kFaceIds, 0, 9, "line 9"};
  cooker::CookOptions without_ids;
  without_ids.codec = CodecId::kWide8;
  without_ids.face_ids = false;
  cooker::CookOptions with_ids = without_ids;
  with_ids.face_ids = true;
  const std::vector<cooker::EncodedTree> trees = {
      require(cooker::cook_mesh(test::sphere(6, 8), with_ids)).tree,
      require(cooker::cook_mesh(test::torus(6, 8), without_ids)).tree};
  const auto refusal = [&trees](std::vector<LeftOutPart> left_out) {
    cooker::SceneParts parts = random_parts();
    parts.left_out = std::move(left_out);
    const std::vector<std::byte> bytes = require(cooker::serialize({trees, {}, &parts}));
    const File file = require(File::open(bytes));
    SceneOptions options;
    options.require_face_ids = true;
    return Scene::bind(file, options).error().detail;
  };
  const std::string ids = "tree 1: face ids were left out by ";
  EXPECT_EQ(refusal({of_other, of_scene, of_tree}), ids + "line 7");
  EXPECT_EQ(refusal({of_tree, of_scene, of_other}), ids + "line 7");
  EXPECT_EQ(refusal({of_other, of_scene}), ids + "line 8");
  EXPECT_EQ(refusal({of_scene, of_other}), ids + "line 8");
  EXPECT_EQ(refusal({of_other}), ids + "line 9");
}

// Of the last tree as of the first: each must have them.
TEST(SceneBind, EveryTreeHasTheActiveEdgesAndUserDataThatAreRequired) {
  const auto tree_with = [](bool edges, bool numbers) {
    cooker::CookOptions options;
    options.codec = CodecId::kWide8;
    if (edges) options.active_edges = 5;
    cooker::EncodedTree tree = require(cooker::cook_mesh(test::sphere(6, 8), options)).tree;
    if (numbers) tree.user_data = cooker::encode_face_numbers({{{0, 7}}, {}}, 1);
    return tree;
  };
  for (const std::size_t lacking : {0u, 1u}) {
    std::vector<cooker::EncodedTree> trees(2);
    const cooker::SceneParts parts = random_parts();
    const auto refusal = [&](bool edges, bool numbers) {
      trees[1 - lacking] = tree_with(true, true);
      trees[lacking] = tree_with(edges, numbers);
      const std::vector<std::byte> bytes = require(cooker::serialize({trees, {}, &parts}));
      const File file = require(File::open(bytes));
      EXPECT_TRUE(Scene::bind(file).ok());
      const Result<Scene> bound =
          Scene::bind(file, {.require_active_edges = true, .require_user_data = true});
      return bound.ok() ? "bound" : bound.error().message();
    };
    const std::string without =
        "part_left_out: tree " + std::to_string(lacking) + ": it was cooked without ";
    EXPECT_EQ(refusal(true, true), "bound");
    EXPECT_EQ(refusal(false, true), without + "--active-edges, or active_edges of a profile");
    EXPECT_EQ(refusal(true, false), without + "--user-data, or user_data of a profile");
  }
}

// One name is enough; a scene of nobody has all the names that there are.
TEST(SceneBind, NamesAreMissedWhereNoInstanceHasOne) {
  SceneOptions options;
  options.require_names = true;
  cooker::SceneParts parts = random_parts();
  for (cooker::PlacedTree& placed : parts.instances) placed.name.clear();
  const CookedScene unnamed = cook(parts);
  EXPECT_TRUE(Scene::bind(unnamed.file).ok());
  const Result<Scene> refused = Scene::bind(unnamed.file, options);
  EXPECT_EQ(refused.code(), Errc::kPartLeftOut);
  EXPECT_EQ(
      refused.error().detail,
      "the scene: names were left out when it was cooked, by names = false of its profile, or "
      "its source has none");
  for (std::size_t named = 0; named < parts.instances.size(); ++named) {
    cooker::SceneParts one = parts;
    one.instances[named].name = "door";
    const CookedScene with_name = cook(one);
    EXPECT_TRUE(Scene::bind(with_name.file, options).ok()) << named;
  }
  parts.instances.clear();
  const CookedScene nobody = cook(parts);
  EXPECT_TRUE(Scene::bind(nobody.file, options).ok());
}

// A scene of a temporary file would point into memory that is gone, and so would a copy into its
// original.
template <class F>
concept BindsScene = requires(F&& file) {
  Scene::bind(std::forward<F>(file));
};
static_assert(BindsScene<File&> && BindsScene<const File&>);
static_assert(!BindsScene<File> && !BindsScene<const File>);
static_assert(!std::is_copy_constructible_v<Scene> && !std::is_copy_assignable_v<Scene>);
static_assert(std::is_nothrow_move_constructible_v<Scene>);

TEST(SceneBind, MovedScenesAnswerAsBefore) {
  const CookedScene cooked = cook(named_parts());
  Scene scene = require(Scene::bind(cooked.file));
  const auto all_contacts = [](const Scene& of) {
    std::vector<std::uint32_t> found;
    EXPECT_TRUE(contacts(of, [&](const ScenePair& pair) {
                  found.insert(found.end(), {pair.first.instance, pair.first.face.id,
                                             pair.second.instance, pair.second.face.id});
                  return true;
                }).ok());
    return found;
  };
  const std::vector<std::uint32_t> before = all_contacts(scene);
  Scene moved = std::move(scene);
  EXPECT_EQ(all_contacts(moved), before);
  ASSERT_TRUE(moved.update(BoundScene::of(moved).moving().front().instance, Pose::Identity()).ok());
  const std::vector<std::uint32_t> updated = all_contacts(moved);
  scene = std::move(moved);
  EXPECT_EQ(all_contacts(scene), updated);
}

// An instance that is named after binding moves as one that was named in SceneOptions.
TEST(SceneBind, InstancesCanBeMadeMovableLater) {
  const CookedScene cooked = cook(named_parts());
  Scene later = require(Scene::bind(cooked.file));
  const std::uint32_t number = 0;
  ASSERT_FALSE(require(later.info(number)).moves);
  Pose away = Pose::Identity();
  away.translation() = Eigen::Vector3d(3, -2, 40);
  EXPECT_EQ(later.update(number, away).error().message(),
            "instance_static: instance 0 was bound as static; make_movable() lets it move");
  EXPECT_EQ(later.update(later.instance_count(), away).code(), Errc::kInstanceIndex);
  EXPECT_EQ(later.make_movable(later.instance_count()).code(), Errc::kInstanceIndex);
  ASSERT_TRUE(later.make_movable(number).ok());
  ASSERT_TRUE(later.make_movable(number).ok());
  EXPECT_TRUE(require(later.info(number)).moves);
  ASSERT_TRUE(later.update(number, away).ok());

  SceneOptions options;
  options.moving = std::span(&number, 1);
  Scene named = require(Scene::bind(cooked.file, options));
  ASSERT_TRUE(named.update(number, away).ok());
  int hits = 0;
  for (int x = -20; x <= 20; ++x) {
    const Ray ray{{0.3 * x, 0.1, 100}, {0, -0.02, -1}};
    const auto a = require(closest_hit(later, ray)), b = require(closest_hit(named, ray));
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    ++hits;
    EXPECT_EQ(a->t, b->t);
    EXPECT_EQ(a->instance, b->instance);
    EXPECT_EQ(a->normal, b->normal);
  }
  EXPECT_GT(hits, 0);
}

// Rays are widened by the worst map of all: one that was once hard to undo does not count for ever.
TEST(SceneBind, TheConditionIsThatOfTheInstancesAsTheyAre) {
  const CookedScene cooked = cook(named_parts());
  Scene scene = require(Scene::bind(cooked.file));
  ASSERT_GE(BoundScene::of(scene).moving().size(), 2u);
  const std::uint32_t first = BoundScene::of(scene).moving()[0].instance,
                      second = BoundScene::of(scene).moving()[1].instance;
  ASSERT_TRUE(scene.update(first, Pose::Identity()).ok());
  ASSERT_TRUE(scene.update(second, Pose::Identity()).ok());
  const double usual = BoundScene::of(scene).condition();
  const auto sheared = [](double by) {
    Pose pose = Pose::Identity();
    pose.linear()(0, 1) = by;
    return pose;
  };
  ASSERT_TRUE(scene.update(first, sheared(1e4)).ok());
  const double larger = BoundScene::of(scene).condition();
  EXPECT_GT(larger, 1e4);
  ASSERT_TRUE(scene.update(second, sheared(1e5)).ok());
  EXPECT_GT(BoundScene::of(scene).condition(), larger);
  ASSERT_TRUE(scene.update(second, Pose::Identity()).ok());
  EXPECT_EQ(BoundScene::of(scene).condition(), larger);
  ASSERT_TRUE(scene.update(first, Pose::Identity()).ok());
  EXPECT_EQ(BoundScene::of(scene).condition(), usual);
}

TEST(SceneBind, OnlyWhatMovesIsMoved) {
  const CookedScene cooked = cook(named_parts());
  Scene scene = require(Scene::bind(cooked.file));
  const std::vector<std::byte> before = cooked.bytes;
  EXPECT_EQ(scene.update(0, Pose::Identity()).code(), Errc::kInstanceStatic);
  EXPECT_EQ(scene.update(9, Pose::Identity()).code(), Errc::kInstanceIndex);
  Pose flat = Pose::Identity();
  flat.linear()(0, 0) = 0;
  const std::uint32_t moving = BoundScene::of(scene).moving().front().instance;
  const Pose kept = require(scene.pose(moving));
  EXPECT_EQ(scene.update(moving, flat).code(), Errc::kInvalidPose);
  EXPECT_EQ(require(scene.pose(moving)).matrix(), kept.matrix());
  EXPECT_TRUE(scene.update(moving, Pose::Identity()).ok());
  EXPECT_EQ(require(scene.pose(moving)).matrix(), Pose::Identity().matrix());
  EXPECT_EQ(cooked.bytes, before);
}

// A static instance that is bound as moving answers from where it was moved to, and only there.
TEST(SceneBind, StaticInstancesCanBeDetached) {
  cooker::SceneParts parts;
  for (std::uint32_t i = 0; i < 2; ++i) {
    cooker::PlacedTree placed;
    placed.id = i;
    placed.pose.translation() = Eigen::Vector3d(10.0 * i, 0, 0);
    parts.instances.push_back(placed);
  }
  const CookedScene cooked = test::cook_scene({test::sphere(6, 8)}, parts);
  const Scene resting = require(Scene::bind(cooked.file));
  const Ray ray{{10, 0, 50}, {0, 0.01, -1}};
  const auto hit = require(closest_hit(resting, ray));
  ASSERT_TRUE(hit.has_value());
  const std::uint32_t door = hit->instance;
  SceneOptions options;
  options.moving = std::span(&door, 1);
  Scene scene = require(Scene::bind(cooked.file, options));
  EXPECT_EQ(require(closest_hit(scene, ray))->t, hit->t);
  Pose away = Pose::Identity();
  away.translation() = Eigen::Vector3d(0, 30, 0);
  ASSERT_TRUE(scene.update(door, away).ok());
  EXPECT_FALSE(require(closest_hit(scene, ray)).has_value());
  EXPECT_EQ(require(closest_hit(scene, {{0, 30, 50}, {0.01, 0, -1}}))->instance, door);
  const std::uint32_t nobody = 2;
  options.moving = std::span(&nobody, 1);
  EXPECT_EQ(Scene::bind(cooked.file, options).code(), Errc::kInstanceIndex);
}

TEST(SceneBind, ScenesWithoutAnythingAtRestOrWithoutSceneAreTold) {
  const CookedScene cooked = cook(test::random_parts(5, 2, 1, 1, 2));
  const Scene scene = require(Scene::bind(cooked.file));
  EXPECT_EQ(BoundScene::of(scene).record().static_count, 0u);
  EXPECT_EQ(BoundScene::of(scene).moving().size(), 5u);
  const std::vector<std::byte> bytes = test::cook_bytes(test::sphere(4, 4), CodecId::kWide8);
  const File plain = require(File::open(bytes));
  EXPECT_EQ(Scene::bind(plain).error().message(),
            "no_scene: the file holds trees but no scene; bind one of its trees");
}

// Each byte of the scene's sections changed, with checksums made right again: refused, found by the
// proof, or harmless; never a crash, never a walk without end.
TEST(SceneBind, DamagedBytesAreRefusedOrAnswered) {
  const CookedScene cooked = cook(named_parts());
  std::size_t refused = 0, found = 0;
  for (const SectionEntry& entry : OpenFile::of(cooked.file).container().sections) {
    if (entry.kind < SectionKind::kScene || entry.kind > SectionKind::kLeftOut) continue;
    for (std::uint64_t i = 0; i < entry.size; ++i) {
      for (const std::byte change : {std::byte{1}, std::byte{0x80}, std::byte{0xff}}) {
        std::vector<std::byte> bytes = cooked.bytes;
        bytes[entry.offset + i] ^= change;
        test::repair_checksums(bytes);
        const Result<File> file = File::open(bytes);
        ASSERT_TRUE(file.ok());
        found += cooker::verify_file(*file).empty() ? 0u : 1u;
        Result<Scene> scene = Scene::bind(*file);
        if (!scene) {
          ++refused;
          continue;
        }
        static_cast<void>(closest_hit(*scene, {{-9, 0.1, 0.2}, {1, 0.01, 0.02}}));
        static_cast<void>(closest_point(*scene, {0.5, 0.5, 0.5}));
        static_cast<void>(overlap_box(*scene,
                                      {Eigen::Vector3d::Constant(-1), Eigen::Vector3d::Constant(1)},
                                      [&](const SceneFace& face) {
                                        static_cast<void>(scene->material(face));
                                        return true;
                                      }));
        static_cast<void>(contacts(*scene, [](const ScenePair&) { return true; }));
      }
    }
  }
  EXPECT_GT(refused, 100u);
  EXPECT_GT(found, refused);
}

}  // namespace
}  // namespace boxtree
