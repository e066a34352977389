// SPDX-License-Identifier: MIT
// What every function does with its arguments: structs of other sizes, as of other versions of the
// interface, members that mean nothing, and NULL.
#include <array>
#include <boxtree_c.h>
#include <cmath>
#include <cstring>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"
#include "tests/unit/c/subjects.h"

namespace boxtree {
namespace {

constexpr std::uint32_t kMostGrowth = 1024;  // what a later version may add to a struct

// A struct with what a later version has behind it.
template <class T>
struct Padded {
  T known;
  unsigned char later[64];
};

class CArguments : public testing::Test {
 protected:
  test::CookedScene cooked_ =
      test::cook_scene({test::torus(8, 6), test::city(2, 1)}, test::random_parts(8, 2, 3, 1, 1));
  std::vector<std::byte> bytes_ = test::cook_bytes(test::torus(8, 6), CodecId::kWide8);
  test::CFile file_ = test::open_c(bytes_), scene_file_ = test::open_c(cooked_.bytes);
  test::CTree tree_ = test::bind_c(file_);
  test::CScene scene_ = test::bind_scene_c(scene_file_);

  const bxt_ray ray_ = {{0, 0, 9}, {0.01, 0.02, -1}, 0, INFINITY};
  const bxt_vec3 point_ = {0, 0, 0}, min_ = {-9, -9, -9}, max_ = {9, 9, 9};
};

template <class T, class Call>
void expect_input(const char* name, const T& valid, const Call& call) {
  SCOPED_TRACE(name);
  Padded<T> given{valid, {}};
  constexpr auto kSize = static_cast<std::uint32_t>(sizeof(T));
  constexpr auto kOdd = static_cast<std::uint32_t>(alignof(T) / 2);  // which no struct has more
  ASSERT_EQ(given.known.struct_size, kSize);
  EXPECT_EQ(call(&given.known), BXT_OK);
  for (const std::uint32_t size : {0u, 4u, kSize - 8, kSize + kOdd, kSize + kMostGrowth + 8, ~0u}) {
    given.known.struct_size = size;
    EXPECT_EQ(call(&given.known), BXT_INVALID_QUERY) << size;
  }
  for (const std::uint32_t more : {8u, 64u}) {
    given.known.struct_size = kSize + more;
    EXPECT_EQ(call(&given.known), BXT_OK) << more;
    given.later[more - 1] = 1;
    EXPECT_EQ(call(&given.known), BXT_INVALID_QUERY) << more;
    given.later[more - 1] = 0;
  }
}

template <class T>
T sized() {
  T value = {};
  value.struct_size = sizeof(T);
  return value;
}

TEST_F(CArguments, StructsThatAreReadMayBeLonger) {
  const auto hit_with = [&](const bxt_face_options* options) {
    auto hit = sized<bxt_ray_hit>();
    return bxt_tree_closest_hit(tree_.get(), &ray_, options, &hit, nullptr);
  };
  const auto visit = [](void*, const bxt_face*) { return true; };
  expect_input("bxt_face_options", bxt_default_face_options(), hit_with);
  expect_input("bxt_limits", bxt_default_limits(), [&](const bxt_limits* limits) {
    return bxt_scene_overlap_box(scene_.get(), &min_, &max_, visit, nullptr, limits, nullptr);
  });
  expect_input(
      "bxt_approximation", bxt_default_approximation(), [&](const bxt_approximation* options) {
        auto answer = sized<bxt_closest_point>();
        return bxt_tree_closest_point_within(tree_.get(), &point_, options, &answer, nullptr);
      });
  expect_input("bxt_shape", bxt_sphere(point_, 1), [&](const bxt_shape* shape) {
    return bxt_scene_overlap(scene_.get(), shape, visit, nullptr, nullptr, nullptr);
  });
  expect_input("bxt_motion", bxt_motion_along(max_), [&](const bxt_motion* motion) {
    const bxt_shape shape = bxt_sphere(point_, 1);
    auto hit = sized<bxt_cast_hit>();
    return bxt_scene_cast_any(scene_.get(), &shape, motion, nullptr, &hit, nullptr);
  });
  expect_input("bxt_file_options", sized<bxt_file_options>(), [&](const bxt_file_options* options) {
    bxt_file* file = nullptr;
    const bxt_status status =
        bxt_file_open_memory(bytes_.data(), bytes_.size(), options, &file, nullptr);
    bxt_file_close(file);
    return status;
  });
  const auto bind = [&](const bxt_tree_options* options) {
    bxt_tree* tree = nullptr;
    const bxt_status status = bxt_tree_bind(file_.get(), 0, options, &tree, nullptr);
    bxt_tree_release(tree);
    return status;
  };
  expect_input("bxt_tree_options", sized<bxt_tree_options>(), bind);
  expect_input("bxt_mesh", sized<bxt_mesh>(), [&](const bxt_mesh* mesh) {
    auto options = sized<bxt_tree_options>();
    options.mesh = mesh;  // which this tree does not need
    return bind(&options);
  });
  const auto bind_scene = [&](const bxt_scene_options* options) {
    bxt_scene* scene = nullptr;
    const bxt_status status = bxt_scene_bind(scene_file_.get(), options, &scene, nullptr);
    bxt_scene_release(scene);
    return status;
  };
  expect_input("bxt_scene_options", sized<bxt_scene_options>(), bind_scene);
  const auto mesh = sized<bxt_mesh>();
  auto scene_mesh = sized<bxt_scene_mesh>();
  scene_mesh.mesh = &mesh;
  expect_input("bxt_scene_mesh", scene_mesh, [&](const bxt_scene_mesh* given) {
    auto options = sized<bxt_scene_options>();
    options.meshes = given;
    options.mesh_count = 1;
    return bind_scene(&options);
  });
  const auto assemble = [&](const bxt_placed_tree* placed, const bxt_scene_layer* layer) {
    const bxt_tree* const trees[] = {tree_.get()};
    bxt_scene* scene = nullptr;
    const bxt_status status = bxt_scene_assemble(trees, 1, placed, placed != nullptr, layer,
                                                 layer != nullptr, nullptr, &scene, nullptr);
    bxt_scene_release(scene);
    return status;
  };
  auto placed = sized<bxt_placed_tree>();
  placed.pose = bxt_identity();
  expect_input("bxt_placed_tree", placed,
               [&](const bxt_placed_tree* given) { return assemble(given, nullptr); });
  expect_input("bxt_scene_layer", sized<bxt_scene_layer>(),
               [&](const bxt_scene_layer* given) { return assemble(nullptr, given); });
  auto allocator = sized<bxt_allocator>();
  allocator.allocate = [](void*, std::size_t size, std::size_t) { return std::malloc(size); };
  allocator.release = [](void*, void* memory, std::size_t, std::size_t) { std::free(memory); };
  expect_input("bxt_allocator", allocator, [&](const bxt_allocator* given) {
    bxt_tree* tree = nullptr;
    const bxt_status status = bxt_tree_copy_without_duplicates(tree_.get(), given, &tree, nullptr);
    bxt_tree_release(tree);
    return status;
  });
}

template <class T, class Call>
void expect_output(const char* name, const Call& call) {
  SCOPED_TRACE(name);
  Padded<T> given;
  constexpr auto kSize = static_cast<std::uint32_t>(sizeof(T));
  constexpr auto kOdd = static_cast<std::uint32_t>(alignof(T) / 2);  // which no struct has more
  for (const std::uint32_t size : {kSize, kSize + 8, kSize + 64}) {
    std::memset(&given, 0xab, sizeof given);
    given.known.struct_size = size;
    EXPECT_EQ(call(&given.known), BXT_OK) << size;
    EXPECT_EQ(given.known.struct_size, size);
    for (const unsigned char byte : given.later) EXPECT_EQ(byte, 0xab);
  }
  for (const std::uint32_t size : {0u, 4u, kSize - 8, kSize + kOdd, kSize + kMostGrowth + 8, ~0u}) {
    std::memset(&given, 0xab, sizeof given);
    given.known.struct_size = size;
    Padded<T> before;
    std::memcpy(&before, &given, sizeof before);
    EXPECT_EQ(call(&given.known), BXT_INVALID_QUERY) << size;
    EXPECT_EQ(std::memcmp(&before, &given, sizeof before), 0);
  }
}

TEST_F(CArguments, StructsThatAreWrittenMayBeLonger) {
  const bxt_shape shape = bxt_sphere(point_, 1);
  const bxt_motion motion = bxt_motion_along(max_);
  const bxt_tree* const tree = tree_.get();
  const bxt_scene* const scene = scene_.get();
  expect_output<bxt_ray_hit>("closest_hit", [&](bxt_ray_hit* hit) {
    return bxt_tree_closest_hit(tree, &ray_, nullptr, hit, nullptr);
  });
  expect_output<bxt_ray_hit>("any_hit of a scene", [&](bxt_ray_hit* hit) {
    return bxt_scene_any_hit(scene, &ray_, nullptr, hit, nullptr);
  });
  expect_output<bxt_ray_hit>("nearest_hits", [&](bxt_ray_hit* hit) {
    std::size_t count;
    return bxt_tree_nearest_hits(tree, &ray_, hit, 1, &count, nullptr, nullptr);
  });
  expect_output<bxt_ray_hit>("closest_hits", [&](bxt_ray_hit* hit) {
    return bxt_tree_closest_hits(tree, &ray_, 1, hit, nullptr, nullptr, nullptr);
  });
  expect_output<bxt_cast_hit>("cast_closest", [&](bxt_cast_hit* hit) {
    return bxt_tree_cast_closest(tree, &shape, &motion, nullptr, hit, nullptr);
  });
  expect_output<bxt_cast_hit>("cast_any of a scene", [&](bxt_cast_hit* hit) {
    return bxt_scene_cast_any(scene, &shape, &motion, nullptr, hit, nullptr);
  });
  expect_output<bxt_closest_point>("closest_point", [&](bxt_closest_point* answer) {
    return bxt_tree_closest_point(tree, &point_, INFINITY, nullptr, answer, nullptr);
  });
  expect_output<bxt_closest_point>("closest_points", [&](bxt_closest_point* answer) {
    return bxt_tree_closest_points(tree, &point_, 1, INFINITY, nullptr, answer, nullptr, nullptr);
  });
  expect_output<bxt_closest_point>("closest_points of a scene", [&](bxt_closest_point* answer) {
    return bxt_scene_closest_points(scene, &point_, 1, INFINITY, nullptr, answer, nullptr, nullptr);
  });
  expect_output<bxt_closest_point>("closest_point_within", [&](bxt_closest_point* answer) {
    return bxt_tree_closest_point_within(tree, &point_, nullptr, answer, nullptr);
  });
  expect_output<bxt_closest_point>("closest_point of a scene", [&](bxt_closest_point* answer) {
    return bxt_scene_closest_point(scene, &point_, INFINITY, nullptr, answer, nullptr);
  });
  expect_output<bxt_overlap_answer>("overlap_box_within", [&](bxt_overlap_answer* answer) {
    return bxt_tree_overlap_box_within(tree, &min_, &max_, 0, BXT_UNLIMITED, answer, nullptr);
  });
  expect_output<bxt_overlap_answer>("overlap_within", [&](bxt_overlap_answer* answer) {
    return bxt_tree_overlap_within(tree, nullptr, tree, nullptr, 0, BXT_UNLIMITED, answer, nullptr);
  });
  expect_output<bxt_overlap_answer>("first_contact", [&](bxt_overlap_answer* answer) {
    return bxt_tree_first_contact(tree, nullptr, tree, nullptr, nullptr, answer, nullptr);
  });
  expect_output<bxt_distance>("distance", [&](bxt_distance* distance) {
    return bxt_tree_distance(tree, nullptr, tree, nullptr, nullptr, distance, nullptr);
  });
  expect_output<bxt_distance>("scene distance", [&](bxt_distance* distance) {
    return bxt_scene_distance(scene, tree, nullptr, BXT_ALL_LAYERS, nullptr, distance, nullptr);
  });
  expect_output<bxt_distance>("scene distance_of", [&](bxt_distance* distance) {
    return bxt_scene_distance_of(scene, 0, nullptr, distance, nullptr);
  });
  expect_output<bxt_instance>("scene_instance", [&](bxt_instance* instance) {
    return bxt_scene_instance(scene, 0, instance, nullptr);
  });
}

TEST_F(CArguments, ThatMeanNothingAreRefused) {
  const auto hit_with = [&](const bxt_face_options& options) {
    auto hit = sized<bxt_ray_hit>();
    return bxt_scene_closest_hit(scene_.get(), &ray_, &options, &hit, nullptr);
  };
  bxt_face_options options = bxt_default_face_options();
  EXPECT_EQ(hit_with(options), BXT_OK);
  options.back_faces = 3;
  EXPECT_EQ(hit_with(options), BXT_INVALID_QUERY);
  options = bxt_default_face_options();
  options.reserved = 1;
  EXPECT_EQ(hit_with(options), BXT_INVALID_QUERY);
  options = bxt_default_face_options();
  options.instance_filter = [](void*, std::uint32_t) { return true; };
  EXPECT_EQ(hit_with(options), BXT_OK);
  auto hit = sized<bxt_ray_hit>();
  EXPECT_EQ(bxt_tree_closest_hit(tree_.get(), &ray_, &options, &hit, nullptr), BXT_INVALID_QUERY);

  bxt_approximation approximation = bxt_default_approximation();
  approximation.reserved = 1;
  auto closest = sized<bxt_closest_point>();
  EXPECT_EQ(bxt_tree_closest_point_within(tree_.get(), &point_, &approximation, &closest, nullptr),
            BXT_INVALID_QUERY);

  const auto overlap = [&](const bxt_shape& shape) {
    const auto visit = [](void*, const bxt_face*) { return true; };
    return bxt_tree_overlap(tree_.get(), &shape, visit, nullptr, nullptr, nullptr);
  };
  bxt_shape shape = bxt_sphere(point_, 1);
  for (const std::uint32_t kind : {0u, 5u, ~0u}) {
    shape.kind = kind;
    EXPECT_EQ(overlap(shape), BXT_INVALID_QUERY);
  }
  const std::vector<bxt_vec3> points(BXT_MAX_HULL_POINTS + 1, point_);
  const auto hull = [&](std::uint64_t count) {
    return bxt_convex_hull(points.data(), count, point_, bxt_no_rotation());
  };
  EXPECT_EQ(overlap(hull(1)), BXT_OK);
  EXPECT_EQ(overlap(hull(BXT_MAX_HULL_POINTS)), BXT_OK);
  for (const std::uint64_t count : {std::uint64_t{0}, std::uint64_t{BXT_MAX_HULL_POINTS} + 1,
                                    std::uint64_t{1} << 32, UINT64_MAX}) {
    EXPECT_EQ(overlap(hull(count)), BXT_INVALID_QUERY);
  }
  EXPECT_EQ(overlap(bxt_convex_hull(nullptr, 3, point_, bxt_no_rotation())), BXT_INVALID_QUERY);

  bxt_motion motion = bxt_motion_along(max_);
  motion.reserved = 1;
  auto cast = sized<bxt_cast_hit>();
  shape = bxt_sphere(point_, 1);
  EXPECT_EQ(bxt_tree_cast_any(tree_.get(), &shape, &motion, nullptr, &cast, nullptr),
            BXT_INVALID_QUERY);

  auto scene_options = sized<bxt_scene_options>();
  scene_options.queries = 16;
  bxt_scene* scene = nullptr;
  EXPECT_EQ(bxt_scene_bind(scene_file_.get(), &scene_options, &scene, nullptr), BXT_INVALID_QUERY);
  scene_options = sized<bxt_scene_options>();
  scene_options.moving_count = 1;
  EXPECT_EQ(bxt_scene_bind(scene_file_.get(), &scene_options, &scene, nullptr), BXT_INVALID_QUERY);
  scene_options = sized<bxt_scene_options>();
  scene_options.mesh_count = 1;
  EXPECT_EQ(bxt_scene_bind(scene_file_.get(), &scene_options, &scene, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(scene, nullptr);

  auto allocator = sized<bxt_allocator>();
  bxt_tree* tree = nullptr;
  EXPECT_EQ(bxt_tree_copy_without_duplicates(tree_.get(), &allocator, &tree, nullptr),
            BXT_INVALID_QUERY);
  EXPECT_EQ(tree, nullptr);
}

// More moving instances than an array can have.
TEST_F(CArguments, CountsBeyondMemoryAreRefused) {
  auto options = sized<bxt_scene_options>();
  const std::uint32_t moving = 0;
  options.moving = &moving;
  options.moving_count = UINT64_MAX / 4;
  bxt_scene* scene = nullptr;
  EXPECT_EQ(bxt_scene_bind(scene_file_.get(), &options, &scene, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(scene, nullptr);
}

using NamedArguments = std::vector<std::pair<std::size_t, std::string>>;

template <class Argument>
void set_null(Argument& argument) {
  if constexpr (std::is_pointer_v<Argument>) argument = nullptr;
}

// `function` of what is given and an error, but with argument number `which` NULL.
template <class... Parameters, class... Given>
void expect_refused_null(std::size_t which, const std::string& name,
                         bxt_status (*function)(Parameters...), const Given&... given) {
  std::tuple<Parameters...> arguments(given..., nullptr);
  [&]<std::size_t... i>(std::index_sequence<i...>) {
    ((i == which ? set_null(std::get<i>(arguments)) : void()), ...);
  }
  (std::index_sequence_for<Parameters...>());
  auto error = sized<bxt_error>();
  std::get<sizeof...(Parameters) - 1>(arguments) = &error;
  EXPECT_EQ(std::apply(function, arguments), BXT_INVALID_QUERY);
  EXPECT_EQ(std::string(error.message).find("invalid_query: "), 0u) << error.message;
  EXPECT_NE(std::string(error.message).find(name), std::string::npos) << error.message;
}

// Calls a function, which must succeed, and then with each of the named arguments NULL, which must
// be refused and named.
#define EXPECT_NAMES_NULL(NAMES, FUNCTION, ...)                   \
  do {                                                            \
    SCOPED_TRACE(#FUNCTION);                                      \
    EXPECT_EQ(FUNCTION(__VA_ARGS__, nullptr), BXT_OK);            \
    for (const auto& [number_, name_] : NamedArguments NAMES)     \
      expect_refused_null(number_, name_, FUNCTION, __VA_ARGS__); \
  } while (false)
#define LIST(...) \
  { __VA_ARGS__ }

TEST_F(CArguments, ThatAreNullAreRefused) {
  const auto face_visitor = [](void*, const bxt_face*) { return true; };
  const auto batch_visitor = [](void*, std::size_t, const bxt_face*) { return true; };
  const double radius = 1;
  const auto pair_visitor = [](void*, const bxt_face*, const bxt_face*) { return true; };
  const auto pair_contact_visitor = [](void*, const bxt_pair_contact*) { return true; };
  const auto contact_visitor = [](void*, const bxt_contact*) { return true; };
  const auto ray_visitor = [](void*, const bxt_ray_hit*) { return 1e9; };
  const auto cast_visitor = [](void*, const bxt_cast_hit*) { return 1e9; };
  const auto box_test = [](void*, const bxt_vec3*, const bxt_vec3*) { return true; };
  const auto triangle_visitor = [](void*, const bxt_triangle*, const bxt_face*, std::uint32_t) {
    return true;
  };
  const auto instance_visitor = [](void*, std::uint32_t) { return true; };
  const bxt_tree* const tree = tree_.get();
  const bxt_scene* const scene = scene_.get();
  const bxt_shape shape = bxt_sphere(point_, 1);
  const bxt_motion motion = bxt_motion_along(max_);
  const bxt_pose pose = bxt_identity();
  bxt_plane planes[6] = {};
  auto hit = sized<bxt_ray_hit>();
  auto cast = sized<bxt_cast_hit>();
  auto point = sized<bxt_closest_point>();
  auto overlap = sized<bxt_overlap_answer>();
  auto distance = sized<bxt_distance>();
  auto instance = sized<bxt_instance>();
  auto contact = sized<bxt_contact>();
  bxt_triangle triangle;
  bxt_pose told_pose;
  std::uint32_t number;
  std::size_t count;
  const bxt_face face = {0, 0, 0};
  const char* const name = "instance 1";

  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "ray"}, {3, "hit"}), bxt_tree_closest_hit, tree, &ray_,
                    nullptr, &hit);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "ray"}, {3, "hit"}), bxt_tree_any_hit, tree, &ray_,
                    nullptr, &hit);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "ray"}, {2, "visitor"}), bxt_tree_all_hits, tree, &ray_,
                    ray_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "ray"}, {2, "hits"}, {4, "count"}), bxt_tree_nearest_hits,
                    tree, &ray_, &hit, 1, &count, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "rays"}, {3, "hits"}), bxt_tree_closest_hits, tree, &ray_,
                    1, &hit, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "rays"}, {3, "hits"}), bxt_tree_any_hits, tree, &ray_, 1,
                    &hit, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "min"}, {2, "max"}, {3, "visitor"}), bxt_tree_overlap_box,
                    tree, &min_, &max_, face_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "mins"}, {2, "maxs"}, {4, "visitor"}),
                    bxt_tree_overlap_boxes, tree, &min_, &max_, 1, batch_visitor, nullptr, nullptr,
                    nullptr);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "centers"}, {2, "radii"}, {4, "visitor"}),
                    bxt_tree_overlap_spheres, tree, &min_, &radius, 1, batch_visitor, nullptr,
                    nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "shape"}, {2, "visitor"}), bxt_tree_overlap, tree, &shape,
                    face_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "planes"}, {2, "visitor"}), bxt_tree_overlap_frustum,
                    tree, planes, face_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "min"}, {2, "max"}, {5, "answer"}),
                    bxt_tree_overlap_box_within, tree, &min_, &max_, 0, 9, &overlap);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "point"}, {4, "answer"}), bxt_tree_closest_point, tree,
                    &point_, 9, nullptr, &point);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "points"}, {5, "answers"}), bxt_tree_closest_points, tree,
                    &point_, 1, INFINITY, nullptr, &point, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "point"}, {3, "answer"}), bxt_tree_closest_point_within,
                    tree, &point_, nullptr, &point);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "shape"}, {2, "motion"}, {4, "hit"}),
                    bxt_tree_cast_closest, tree, &shape, &motion, nullptr, &cast);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "shape"}, {2, "motion"}, {4, "hit"}), bxt_tree_cast_any,
                    tree, &shape, &motion, nullptr, &cast);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "shape"}, {2, "motion"}, {3, "visitor"}),
                    bxt_tree_cast_all, tree, &shape, &motion, cast_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "shape"}, {2, "visitor"}), bxt_tree_collide, tree, &shape,
                    contact_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "contacts"}, {4, "kept"}), bxt_merge_contacts, &contact, 1, 0, 0,
                    &count);
  EXPECT_NAMES_NULL(LIST({0, "first"}, {2, "second"}, {4, "visitor"}), bxt_tree_overlap_pairs, tree,
                    nullptr, tree, nullptr, pair_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "first"}, {2, "second"}, {4, "visitor"}), bxt_tree_pair_contacts, tree,
                    nullptr, tree, nullptr, pair_contact_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "first"}, {2, "second"}, {5, "answer"}), bxt_tree_first_contact, tree,
                    nullptr, tree, nullptr, nullptr, &overlap);
  EXPECT_NAMES_NULL(LIST({0, "first"}, {2, "second"}, {6, "answer"}), bxt_tree_overlap_within, tree,
                    nullptr, tree, nullptr, 0, 9, &overlap);
  EXPECT_NAMES_NULL(LIST({0, "first"}, {2, "second"}, {5, "distance"}), bxt_tree_distance, tree,
                    nullptr, tree, nullptr, nullptr, &distance);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "test"}, {2, "visitor"}), bxt_tree_traverse, tree,
                    box_test, triangle_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "face"}, {3, "triangle"}), bxt_tree_triangle, tree, &face,
                    0, &triangle);
  EXPECT_NAMES_NULL(LIST({0, "tree"}, {1, "face"}, {3, "edges"}), bxt_tree_active_edges, tree,
                    &face, 0, &number);

  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "ray"}, {3, "hit"}), bxt_scene_closest_hit, scene, &ray_,
                    nullptr, &hit);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "ray"}, {3, "hit"}), bxt_scene_any_hit, scene, &ray_,
                    nullptr, &hit);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "ray"}, {2, "visitor"}), bxt_scene_all_hits, scene,
                    &ray_, ray_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "ray"}, {2, "hits"}, {4, "count"}),
                    bxt_scene_nearest_hits, scene, &ray_, &hit, 1, &count, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "rays"}, {3, "hits"}), bxt_scene_closest_hits, scene,
                    &ray_, 1, &hit, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "rays"}, {3, "hits"}), bxt_scene_any_hits, scene, &ray_,
                    1, &hit, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "min"}, {2, "max"}, {3, "visitor"}),
                    bxt_scene_overlap_box, scene, &min_, &max_, face_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "mins"}, {2, "maxs"}, {4, "visitor"}),
                    bxt_scene_overlap_boxes, scene, &min_, &max_, 1, batch_visitor, nullptr,
                    nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "centers"}, {2, "radii"}, {4, "visitor"}),
                    bxt_scene_overlap_spheres, scene, &min_, &radius, 1, batch_visitor, nullptr,
                    nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "shape"}, {2, "visitor"}), bxt_scene_overlap, scene,
                    &shape, face_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "planes"}, {2, "visitor"}), bxt_scene_overlap_frustum,
                    scene, planes, face_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "planes"}, {2, "visitor"}),
                    bxt_scene_instances_in_frustum, scene, planes, instance_visitor, nullptr,
                    nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "points"}, {5, "answers"}), bxt_scene_closest_points,
                    scene, &point_, 1, INFINITY, nullptr, &point, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "point"}, {4, "answer"}), bxt_scene_closest_point, scene,
                    &point_, 9, nullptr, &point);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "shape"}, {2, "motion"}, {4, "hit"}),
                    bxt_scene_cast_closest, scene, &shape, &motion, nullptr, &cast);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "shape"}, {2, "motion"}, {4, "hit"}), bxt_scene_cast_any,
                    scene, &shape, &motion, nullptr, &cast);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "shape"}, {2, "motion"}, {3, "visitor"}),
                    bxt_scene_cast_all, scene, &shape, &motion, cast_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "shape"}, {2, "visitor"}), bxt_scene_collide, scene,
                    &shape, contact_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "visitor"}), bxt_scene_contacts, scene, pair_visitor,
                    nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {2, "visitor"}), bxt_scene_contacts_of, scene, 0,
                    pair_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "tree"}, {3, "visitor"}), bxt_scene_overlap_pairs, scene,
                    tree, nullptr, pair_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "visitor"}), bxt_scene_pair_contacts, scene,
                    pair_contact_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {2, "visitor"}), bxt_scene_pair_contacts_of, scene, 0,
                    pair_contact_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "tree"}, {3, "visitor"}), bxt_scene_pair_contacts_with,
                    scene, tree, nullptr, pair_contact_visitor, nullptr, nullptr);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "tree"}, {5, "distance"}), bxt_scene_distance, scene,
                    tree, nullptr, BXT_ALL_LAYERS, nullptr, &distance);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {3, "distance"}), bxt_scene_distance_of, scene, 0, nullptr,
                    &distance);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {2, "instance"}), bxt_scene_instance, scene, 0, &instance);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "name"}, {2, "number"}), bxt_scene_find_instance, scene,
                    name, &number);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {2, "pose"}), bxt_scene_pose, scene, 0, &told_pose);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "face"}, {3, "triangle"}), bxt_scene_triangle, scene,
                    &face, 0, &triangle);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {1, "face"}, {3, "edges"}), bxt_scene_active_edges, scene,
                    &face, 0, &number);
  bxt_scene* const changed = scene_.get();
  EXPECT_NAMES_NULL(LIST({0, "scene"}), bxt_scene_set_enabled, changed, 0, true);
  EXPECT_NAMES_NULL(LIST({0, "scene"}), bxt_scene_set_user_data, changed, 0, 1);
  EXPECT_NAMES_NULL(LIST({0, "scene"}), bxt_scene_make_movable, changed, 0);
  EXPECT_NAMES_NULL(LIST({0, "scene"}, {2, "pose"}), bxt_scene_update, changed, 0, &pose);
  EXPECT_NAMES_NULL(LIST({0, "scene"}), bxt_scene_rebuild, changed);
  EXPECT_NAMES_NULL(LIST({0, "file"}), bxt_file_verify_checksums, file_.get());

  // Functions that make a handle.
  bxt_file* file = nullptr;
  bxt_tree* bound = nullptr;
  bxt_scene* made = nullptr;
  EXPECT_EQ(bxt_file_open(nullptr, nullptr, &file, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_file_open("x", nullptr, nullptr, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_file_open_memory(nullptr, 9, nullptr, &file, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_file_open_memory(bytes_.data(), 9, nullptr, nullptr, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_file_find_tree(nullptr, "x", &number, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_file_find_tree(file_.get(), nullptr, &number, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_file_find_tree(file_.get(), "x", nullptr, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_tree_bind(nullptr, 0, nullptr, &bound, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_tree_bind(file_.get(), 0, nullptr, nullptr, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_tree_copy_without_duplicates(nullptr, nullptr, &bound, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_tree_copy_without_duplicates(tree, nullptr, nullptr, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_scene_bind(nullptr, nullptr, &made, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_scene_bind(scene_file_.get(), nullptr, nullptr, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_scene_copy_tree(nullptr, 0, nullptr, &bound, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_scene_copy_tree(scene, 0, nullptr, nullptr, nullptr), BXT_INVALID_QUERY);
  const bxt_tree* const trees[] = {nullptr};
  const auto placed = sized<bxt_placed_tree>();
  EXPECT_EQ(bxt_scene_assemble(nullptr, 1, nullptr, 0, nullptr, 0, nullptr, &made, nullptr),
            BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_scene_assemble(trees, 1, nullptr, 0, nullptr, 0, nullptr, &made, nullptr),
            BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_scene_assemble(trees, 0, nullptr, 1, nullptr, 0, nullptr, &made, nullptr),
            BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_scene_assemble(trees, 0, &placed, 0, nullptr, 1, nullptr, &made, nullptr),
            BXT_INVALID_QUERY);
  EXPECT_EQ(bxt_scene_assemble(trees, 0, &placed, 0, nullptr, 0, nullptr, nullptr, nullptr),
            BXT_INVALID_QUERY);
  bxt_file_close(nullptr);
  bxt_tree_release(nullptr);
  bxt_scene_release(nullptr);
}

}  // namespace
}  // namespace boxtree
