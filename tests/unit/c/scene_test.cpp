// SPDX-License-Identifier: MIT
// Scenes by the C interface: made, looked at and changed as by the C++ interface.
#include <boxtree_c.h>
#include <cstring>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/import/mesh_arrays.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"
#include "tests/unit/c/copied_text.h"
#include "tests/unit/c/subjects.h"

namespace boxtree {
namespace {

using test::Answer;
using test::answer_of_c;
using test::Numbers;
using test::numbers_of;

// The answer of a function that returns a status alone.
template <class Call>
Answer status_of_c(const Call& call) {
  return answer_of_c([&](bxt_error* error, std::vector<Numbers>&) { return call(error); });
}
template <class Outcome>
Answer status_of(const Outcome& outcome) {
  Answer answer;
  note_error(outcome, answer);
  return answer;
}

TEST(CScenes, AreWhatCppSays) {
  std::size_t triangles = 0, materials = 0, names = 0, edges_found = 0;
  test::for_each_scene([&](const Scene& scene, const bxt_scene* c_scene) {
    ASSERT_EQ(bxt_scene_instance_count(c_scene), scene.instance_count());
    ASSERT_EQ(bxt_scene_tree_count(c_scene), scene.trees().size());
    EXPECT_EQ(bxt_scene_query_kinds(c_scene), scene.query_kinds());
    ASSERT_EQ(bxt_scene_layer_count(c_scene), scene.layer_count());
    for (std::uint32_t i = 0; i <= scene.layer_count(); ++i) {
      EXPECT_EQ(test::copied_text(
                    [&](char* b, std::size_t n) { return bxt_scene_layer_name(c_scene, i, b, n); }),
                scene.layer_name(i));
    }
    ASSERT_EQ(bxt_scene_material_count(c_scene), scene.material_count());
    for (std::uint32_t i = 0; i <= scene.material_count(); ++i) {
      EXPECT_EQ(test::copied_text([&](char* b, std::size_t n) {
                  return bxt_scene_material_name(c_scene, i, b, n);
                }),
                scene.material_name(i));
    }
    for (std::uint32_t i = 0; i <= scene.instance_count(); ++i) {
      SCOPED_TRACE(i);
      const Result<InstanceInfo> info = scene.info(i);
      Answer expected = status_of(info);
      if (info)
        expected.found.push_back(Numbers() << info->tree << info->id << info->layer << info->moves);
      ASSERT_EQ(answer_of_c([&](bxt_error* error, std::vector<Numbers>& found) {
                  bxt_instance told = {};
                  told.struct_size = sizeof told;
                  const bxt_status status = bxt_scene_instance(c_scene, i, &told, error);
                  if (status == BXT_OK) {
                    found.push_back(Numbers() << told.tree << told.id << told.layer << told.moves);
                  }
                  return status;
                }),
                expected);
      const std::string name = test::copied_text(
          [&](char* b, std::size_t n) { return bxt_scene_instance_name(c_scene, i, b, n); });
      EXPECT_EQ(name, info ? info->name : "");
      names += !name.empty();
      const Result<Pose> pose = scene.pose(i);
      bxt_pose c_pose = {};
      EXPECT_EQ(
          status_of_c([&](bxt_error* error) { return bxt_scene_pose(c_scene, i, &c_pose, error); }),
          status_of(pose));
      const bxt_pose expected_pose = pose ? test::pose_of(*pose) : bxt_pose{};
      EXPECT_EQ(std::memcmp(&c_pose, &expected_pose, sizeof c_pose), 0);
      EXPECT_EQ(bxt_scene_is_enabled(c_scene, i), scene.is_enabled(i));
      EXPECT_EQ(bxt_scene_user_data(c_scene, i), scene.user_data(i));
      for (std::uint32_t f = 0; f < 40; ++f) {
        const SceneFace face{i, {f + 3, f}};
        const bxt_face c_face = {f + 3, f, i};
        if (info) {
          EXPECT_EQ(bxt_scene_material(c_scene, &c_face), scene.material(face));
          materials += scene.material(face) != kNoMaterial;
        }
        const std::uint32_t half = f % 3;
        const Result<Triangle> triangle = scene.triangle(face, half);
        Answer expected_triangle = status_of(triangle);
        triangles += triangle.ok();
        if (triangle) expected_triangle.found.push_back(numbers_of(*triangle));
        ASSERT_EQ(answer_of_c([&](bxt_error* error, std::vector<Numbers>& found) {
                    bxt_triangle told;
                    const bxt_status status =
                        bxt_scene_triangle(c_scene, &c_face, half, &told, error);
                    if (status == BXT_OK) found.push_back(numbers_of(told));
                    return status;
                  }),
                  expected_triangle);
        const Result<std::uint32_t> edges = active_edges(scene, face, half);
        std::uint32_t told = 99;
        ASSERT_EQ(status_of_c([&](bxt_error* error) {
                    return bxt_scene_active_edges(c_scene, &c_face, half, &told, error);
                  }),
                  status_of(edges));
        ASSERT_EQ(told, edges.ok() ? *edges : 99);
        edges_found += edges.ok() && *edges != 7;
      }
    }
    for (const char* name : {"instance 3", "even", "odd", "none"}) {
      const Result<std::uint32_t> found = scene.find_instance(name);
      std::uint32_t number = 9999;
      EXPECT_EQ(status_of_c([&](bxt_error* error) {
                  return bxt_scene_find_instance(c_scene, name, &number, error);
                }),
                status_of(found));
      EXPECT_EQ(number, found.ok() ? *found : 9999);
    }
    for (std::uint32_t i = 0; i <= scene.trees().size(); ++i) {
      bxt_tree* tree = nullptr;
      const bxt_status status = bxt_scene_copy_tree(c_scene, i, nullptr, &tree, nullptr);
      EXPECT_EQ(status, i < scene.trees().size() ? BXT_OK : BXT_TREE_INDEX);
      const test::CTree owned(tree);
      if (tree != nullptr) {
        EXPECT_EQ(bxt_tree_face_count(tree), scene.trees()[i].face_count());
      }
    }
  });
  EXPECT_GT(triangles, 500u);
  EXPECT_GT(materials, 100u);
  EXPECT_GT(names, 50u);
  EXPECT_GT(edges_found, 50u);
}

TEST(CScenes, AreChangedAsByCpp) {
  const test::CookedScene cooked =
      test::cook_scene({test::torus(8, 6)}, test::random_parts(12, 1, 3, 1, 1));
  Scene scene = test::require(Scene::bind(cooked.file));
  const test::CFile file = test::open_c(cooked.bytes);
  const test::CScene c_scene = test::bind_scene_c(file);
  std::size_t moved = 0;
  for (int round = 0; round < 2; ++round) {
    for (std::uint32_t i = 0; i <= scene.instance_count(); ++i) {
      Pose pose = Pose::Identity();
      pose.translation().x() = i + 20.0 * round;
      if (i == 4) pose.linear().setZero();
      const bxt_pose c_pose = test::pose_of(pose);
      const Status updated = scene.update(i, pose);
      moved += updated.ok();
      EXPECT_EQ(status_of_c([&](bxt_error* error) {
                  return bxt_scene_update(c_scene.get(), i, &c_pose, error);
                }),
                status_of(updated));
      EXPECT_EQ(status_of_c([&](bxt_error* error) {
                  return bxt_scene_set_enabled(c_scene.get(), i, i % 2 == 0, error);
                }),
                status_of(scene.set_enabled(i, i % 2 == 0)));
      EXPECT_EQ(bxt_scene_is_enabled(c_scene.get(), i), i % 2 == 0 && i < scene.instance_count());
      EXPECT_EQ(status_of_c([&](bxt_error* error) {
                  return bxt_scene_set_user_data(c_scene.get(), i, 7 + i, error);
                }),
                status_of(scene.set_user_data(i, 7 + i)));
      EXPECT_EQ(bxt_scene_user_data(c_scene.get(), i), i < scene.instance_count() ? 7 + i : 0);
      if (round == 0) {
        EXPECT_EQ(status_of_c([&](bxt_error* error) {
                    return bxt_scene_make_movable(c_scene.get(), i, error);
                  }),
                  status_of(scene.make_movable(i)));
      }
    }
    scene.rebuild();
    EXPECT_EQ(bxt_scene_rebuild(c_scene.get(), nullptr), BXT_OK);
    std::vector<Numbers> found, expected;
    const auto visit = [&](const SceneFace& face) {
      expected.push_back(numbers_of(face));
      return true;
    };
    const Eigen::AlignedBox3d box(Eigen::Vector3d(-9, -9, -9), Eigen::Vector3d(60, 9, 9));
    ASSERT_TRUE(overlap_box(scene, box, visit).ok());
    const bxt_vec3 min = test::vec3(box.min()), max = test::vec3(box.max());
    ASSERT_EQ(bxt_scene_overlap_box(c_scene.get(), &min, &max, test::keep<bxt_face>, &found,
                                    nullptr, nullptr),
              BXT_OK);
    EXPECT_EQ(found, expected);
    EXPECT_FALSE(found.empty());
  }
  EXPECT_GT(moved, 12u);
}

TEST(CScenes, AreBoundAsByCpp) {
  cooker::SceneParts parts = test::random_parts(6, 1, 3, 1, 1);
  parts.queries = kRayQueries | kBoxQueries;
  for (auto& instance : parts.instances) instance.name.clear();
  const test::CookedScene cooked = test::cook_scene({test::torus(8, 6)}, parts);
  const std::vector<std::byte> single = test::cook_bytes(test::torus(8, 6), CodecId::kWide8);
  const File without = test::require(File::open(Bytes(single)));
  const test::CFile c_file = test::open_c(cooked.bytes), c_without = test::open_c(single);
  const std::vector<std::uint32_t> moving = {1, 2}, none = {1, 77};
  std::size_t refused = 0;
  for (int way = 0; way < 10; ++way) {
    SCOPED_TRACE(way);
    SceneOptions options;
    bxt_scene_options c = {};
    c.struct_size = sizeof c;
    if (way == 1) c.queries = options.queries = kPointQueries;
    if (way == 2) c.queries = options.queries = kRayQueries;
    c.require_face_ids = options.require_face_ids = way == 3;
    c.require_active_edges = options.require_active_edges = way == 4;
    c.require_materials = options.require_materials = way == 5;
    c.require_user_data = options.require_user_data = way == 6;
    c.require_names = options.require_names = way == 7;
    if (way >= 8) {
      options.moving = way == 8 ? moving : none;
      c.moving = options.moving.data();
      c.moving_count = options.moving.size();
    }
    const auto bind = [&](const test::CFile& file, bxt_error* error) {
      bxt_scene* scene = nullptr;
      const bxt_status status = bxt_scene_bind(file.get(), way == 0 ? nullptr : &c, &scene, error);
      EXPECT_EQ(scene != nullptr, status == BXT_OK);
      if (scene != nullptr && way == 8) {
        const bxt_pose pose = bxt_identity();
        EXPECT_EQ(bxt_scene_update(scene, 2, &pose, nullptr), BXT_OK);
      }
      bxt_scene_release(scene);
      return status;
    };
    const Result<Scene> bound = Scene::bind(cooked.file, options);
    refused += !bound.ok();
    EXPECT_EQ(status_of_c([&](bxt_error* error) { return bind(c_file, error); }), status_of(bound));
    EXPECT_EQ(status_of_c([&](bxt_error* error) { return bind(c_without, error); }),
              status_of(Scene::bind(without, options)));
  }
  EXPECT_GE(refused, 5u);
}

// Of a later version, whose structs are longer, with arrays of the application's.
TEST(CScenes, WithExternalMeshesAnswerAsByCpp) {
  const std::vector<test::SourceMesh> meshes = {test::torus(8, 6), test::city(2, 1)};
  cooker::CookOptions options;
  options.geometry = GeometryId::kExternal;
  const test::CookedScene cooked =
      test::cook_scene(meshes, test::random_parts(6, 2, 3, 1, 1), {CodecId::kWide8}, options);
  struct Longer {
    bxt_scene_mesh known = {};
    std::uint64_t later = 0;
  };
  std::vector<bxt_mesh> arrays(2);
  std::vector<Longer> given(2);
  std::vector<SceneMeshArrays> expected_given;
  for (std::uint32_t i = 0; i < 2; ++i) {
    const MeshArrays own = cooker::arrays_of(cooked.meshes[i]);
    expected_given.push_back({i, own});
    arrays[i] = test::mesh_of(own);
    given[i].known.tree = i;
    given[i].known.mesh = &arrays[i];
  }
  given[0].known.struct_size = sizeof(Longer);
  bxt_scene_options c = {};
  c.struct_size = sizeof c;
  c.meshes = &given[0].known;
  c.mesh_count = 2;
  const Scene scene = test::require(Scene::bind(cooked.file, {.meshes = expected_given}));
  const test::CFile file = test::open_c(cooked.bytes);
  bxt_scene* bound = nullptr;
  ASSERT_EQ(bxt_scene_bind(file.get(), &c, &bound, nullptr), BXT_OK);
  const test::CScene c_scene(bound);
  test::Randoms randoms(scene);
  for (int i = 0; i < 100; ++i) {
    const Ray ray = randoms.ray();
    const bxt_ray c_ray = test::ray_of(ray);
    bxt_ray_hit hit = {};
    hit.struct_size = sizeof hit;
    ASSERT_EQ(bxt_scene_closest_hit(c_scene.get(), &c_ray, nullptr, &hit, nullptr), BXT_OK);
    const SceneRayResult expected = closest_hit(scene, ray);
    ASSERT_EQ(numbers_of(hit), numbers_of(*expected, expected.has_value()));
  }
  given[1].later = 1;
  bound = nullptr;
  EXPECT_EQ(bxt_scene_bind(file.get(), &c, &bound, nullptr), BXT_INVALID_QUERY);
  c.mesh_count = 1;
  EXPECT_EQ(bxt_scene_bind(file.get(), &c, &bound, nullptr), BXT_EXTERNAL_MESH_NEEDED);
  EXPECT_EQ(bound, nullptr);
}

TEST(CScenes, AreAssembledAsByCpp) {
  const test::CookedTree cooked = test::cook_tree(test::torus(8, 6), CodecId::kWide8);
  const test::CFile file = test::open_c(cooked.bytes);
  const test::CTree tree = test::bind_c(file);
  const bxt_tree* const trees[] = {tree.get()};
  const std::string long_name(70000, 'n');
  for (int way = 0; way < 5; ++way) {
    SCOPED_TRACE(way);
    PlacedTree placed{.tree = way == 1 ? 1u : 0u, .layer = way == 2 ? 32u : 0u};
    if (way == 3) placed.pose.linear().setZero();
    if (way == 4) placed.name = long_name;
    bxt_placed_tree c_placed = {};
    c_placed.struct_size = sizeof c_placed;
    c_placed.tree = placed.tree;
    c_placed.pose = test::pose_of(placed.pose);
    c_placed.layer = placed.layer;
    c_placed.name = way == 4 ? long_name.c_str() : nullptr;
    EXPECT_EQ(status_of_c([&](bxt_error* error) {
                bxt_scene* scene = nullptr;
                const bxt_status status =
                    bxt_scene_assemble(trees, 1, &c_placed, 1, nullptr, 0, nullptr, &scene, error);
                EXPECT_EQ(scene != nullptr, status == BXT_OK);
                bxt_scene_release(scene);
                return status;
              }),
              status_of(Scene::assemble({&cooked.tree, 1}, {&placed, 1})));
  }
  bxt_scene* scene = nullptr;
  ASSERT_EQ(bxt_scene_assemble(nullptr, 0, nullptr, 0, nullptr, 0, nullptr, &scene, nullptr),
            BXT_OK);
  EXPECT_EQ(bxt_scene_instance_count(scene), 0u);
  bxt_scene_release(scene);
}

// The size of the first element is that of all, and what they hold in members of later versions is
// seen.
TEST(CScenes, AreAssembledOfLongerStructs) {
  const test::CookedTree cooked = test::cook_tree(test::torus(8, 6), CodecId::kWide8);
  const test::CFile file = test::open_c(cooked.bytes);
  const test::CTree tree = test::bind_c(file);
  const bxt_tree* const trees[] = {tree.get()};
  struct LongerTree {
    bxt_placed_tree known = {};
    std::uint64_t later = 0;
  } placed[3];
  struct LongerLayer {
    bxt_scene_layer known = {};
    std::uint64_t later = 0;
  } layers[2];
  for (std::uint32_t i = 0; i < 3; ++i) {
    placed[i].known.pose = bxt_translation(10.0 * i, 0, 0);
    placed[i].known.user_data = i;
  }
  placed[0].known.struct_size = sizeof(LongerTree);
  layers[0].known.struct_size = sizeof(LongerLayer);
  layers[1].known.name = "second";
  layers[1].known.queries = BXT_ALL_QUERIES;
  const auto assemble = [&](bxt_scene** scene) {
    return bxt_scene_assemble(trees, 1, &placed[0].known, 3, &layers[0].known, 2, nullptr, scene,
                              nullptr);
  };
  bxt_scene* scene = nullptr;
  ASSERT_EQ(assemble(&scene), BXT_OK);
  EXPECT_EQ(bxt_scene_instance_count(scene), 3u);
  EXPECT_EQ(bxt_scene_user_data(scene, 2), 2u);
  char name[8];
  bxt_scene_layer_name(scene, 1, name, sizeof name);
  EXPECT_STREQ(name, "second");
  bxt_scene_release(scene);
  scene = nullptr;
  placed[2].later = 1;
  EXPECT_EQ(assemble(&scene), BXT_INVALID_QUERY);
  placed[2].later = 0;
  layers[1].later = 1;
  EXPECT_EQ(assemble(&scene), BXT_INVALID_QUERY);
  layers[1].later = 0;
  layers[1].known.reserved = 1;
  EXPECT_EQ(assemble(&scene), BXT_INVALID_QUERY);
  layers[1].known.reserved = 0;
  layers[1].known.queries = 16;
  EXPECT_EQ(assemble(&scene), BXT_INVALID_QUERY);
  EXPECT_EQ(scene, nullptr);
}

}  // namespace
}  // namespace boxtree
