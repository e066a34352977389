// SPDX-License-Identifier: MIT
#include "tests/unit/c/subjects.h"

#include <ostream>
#include <stdexcept>
#include <utility>

#include "cooker/import/mesh_arrays.h"
#include "format/codec.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"

namespace boxtree::test {
namespace {

void require_ok(bxt_status status, const bxt_error& error) {
  if (status != BXT_OK) throw std::runtime_error(error.message);
}

// A mesh with faces that coincide, of which visitors hear.
SourceMesh with_copies() {
  SourceMesh mesh = city(3, 5);
  const std::size_t count = mesh.faces.size();
  for (std::size_t i = 0; i < count; i += 7) mesh.faces.push_back(mesh.faces[i]);
  return mesh;
}

std::vector<FaceRun> runs(std::uint32_t count, std::uint32_t step, std::uint32_t largest) {
  std::vector<FaceRun> all;
  for (std::uint32_t face = 0; face < count; face += step) {
    all.push_back({face, (face / step * 7 + 1) % largest});
  }
  return all;
}

void show(const std::vector<std::byte>& bytes, const char* what,
          const std::function<void(const Tree&, const bxt_tree*)>& body,
          const BindOptions& bind = {}) {
  SCOPED_TRACE(what);
  const File file = require(File::open(Bytes(bytes)));
  const Tree tree = require(Tree::bind(file, bind));
  const CFile c_file = open_c(bytes);
  bxt_tree_options options = {};
  options.struct_size = sizeof options;
  bxt_mesh mesh;
  if (bind.mesh) {
    mesh = mesh_of(*bind.mesh);
    options.mesh = &mesh;
    options.verify_mesh = true;
  }
  const CTree c_tree = bind_c(c_file, BXT_ONLY_TREE, &options);
  body(tree, c_tree.get());
}

}  // namespace

bxt_mesh mesh_of(const MeshArrays& arrays) {
  bxt_mesh mesh = {};
  mesh.struct_size = sizeof mesh;
  mesh.vertex_count = arrays.vertex_count;
  mesh.positions = arrays.positions;
  mesh.position_stride = arrays.position_stride;
  mesh.corners = arrays.corners;
  mesh.face_count = arrays.face_count;
  mesh.corner_bytes = arrays.corner_bytes;
  mesh.corners_per_face = arrays.corners_per_face;
  mesh.positions_are_double = arrays.positions_f64;
  return mesh;
}

void PrintTo(const Answer& answer, std::ostream* stream) {
  *stream << "status " << answer.status << " \"" << answer.message << "\", " << answer.found.size()
          << " found";
  for (const Numbers& numbers : answer.found) *stream << "\n  " << testing::PrintToString(numbers);
}

CFile open_c(const std::vector<std::byte>& bytes) {
  bxt_error error = {};
  error.struct_size = sizeof error;
  bxt_file* file = nullptr;
  require_ok(bxt_file_open_memory(bytes.data(), bytes.size(), nullptr, &file, &error), error);
  return CFile(file);
}

CTree bind_c(const CFile& file, std::uint32_t number, const bxt_tree_options* options) {
  bxt_error error = {};
  error.struct_size = sizeof error;
  bxt_tree* tree = nullptr;
  require_ok(bxt_tree_bind(file.get(), number, options, &tree, &error), error);
  return CTree(tree);
}

CScene bind_scene_c(const CFile& file) {
  bxt_error error = {};
  error.struct_size = sizeof error;
  bxt_scene* scene = nullptr;
  require_ok(bxt_scene_bind(file.get(), nullptr, &scene, &error), error);
  return CScene(scene);
}

void for_each_tree(const std::function<void(const Tree&, const bxt_tree*)>& body) {
  for (const CodecId codec : {CodecId::kWide8, CodecId::kWide4}) {
    for (const GeometryId geometry : {GeometryId::kExact, GeometryId::kGrid, GeometryId::kArrays}) {
      if (codec == CodecId::kWide4 && geometry == GeometryId::kArrays) continue;
      for (const SourceMesh& mesh : {torus(14, 10), city(4, 2)}) {
        cooker::CookOptions options;
        options.geometry = geometry;
        options.grid.bits = 16;
        const std::string name = mesh.name + " in " + std::string(codec_name(codec)) + ", " +
                                 std::string(geometry_name(geometry));
        show(cook_bytes(mesh, codec, options), name.c_str(), body);
      }
    }
  }
  const SourceMesh mesh = with_copies();
  const auto faces = static_cast<std::uint32_t>(mesh.faces.size());
  show(cook_bytes(mesh, {{"stone", "", "wood"}, runs(faces, 5, 3)}, CodecId::kWide8), "materials",
       body);
  show(cook_bytes(mesh, runs(faces, 3, 0xffffffffu), CodecId::kWide8), "user data", body);
  cooker::CookOptions options;
  options.active_edges = 5.0;
  options.face_ids = false;
  const std::vector<std::byte> bytes = cook_bytes(mesh, CodecId::kWide8, options);
  show(bytes, "active edges, no ids", body);
  show(bytes, "without duplicates", [&](const Tree& tree, const bxt_tree* c_tree) {
    bxt_tree* copy = nullptr;
    ASSERT_EQ(bxt_tree_copy_without_duplicates(c_tree, nullptr, &copy, nullptr), BXT_OK);
    body(tree.without_duplicates(), CTree(copy).get());
  });
  cooker::CookOptions outside;
  outside.geometry = GeometryId::kExternal;
  BindOptions bind;
  bind.mesh = cooker::arrays_of(mesh);
  bind.verify_mesh = true;
  show(cook_bytes(mesh, CodecId::kWide8, outside), "external geometry", body, bind);
}

namespace {

// Some instances move, and some are disabled, in both.
void change(Scene& scene, bxt_scene* c_scene) {
  std::mt19937_64 random(3);
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    const Pose pose = random_pose(random, 4, i % 3 == 0);
    const bxt_pose c_pose = pose_of(pose);
    const Status moved = scene.update(i, pose);
    ASSERT_EQ(bxt_scene_update(c_scene, i, &c_pose, nullptr),
              static_cast<bxt_status>(moved.code()));
    if (i % 5 != 4) continue;
    ASSERT_TRUE(scene.set_enabled(i, false).ok());
    ASSERT_EQ(bxt_scene_set_enabled(c_scene, i, false, nullptr), BXT_OK);
  }
}

void for_each_bound_scene(const std::function<void(const Scene&, const bxt_scene*)>& body) {
  for (const CodecId codec : {CodecId::kWide8, CodecId::kWide4}) {
    SCOPED_TRACE("bound");
    cooker::CookOptions options;
    options.active_edges = 5.0;
    const CookedScene cooked =
        cook_scene({torus(10, 8), city(3, 1)}, random_parts(30, 2, 4, 2, 1), {codec}, options);
    Scene scene = require(Scene::bind(cooked.file));
    const CFile c_file = open_c(cooked.bytes);
    const CScene c_scene = bind_scene_c(c_file);
    body(scene, c_scene.get());
    change(scene, c_scene.get());
    body(scene, c_scene.get());
  }
}

void for_each_assembled_scene(const std::function<void(const Scene&, const bxt_scene*)>& body) {
  SCOPED_TRACE("assembled");
  const SourceMesh mesh = city(3, 1);
  const auto faces = static_cast<std::uint32_t>(mesh.faces.size());
  const std::vector<std::byte> first =
      cook_bytes(mesh, {{"stone", "wood"}, runs(faces, 5, 2)}, CodecId::kWide8);
  const std::vector<std::byte> second = cook_bytes(torus(10, 8), CodecId::kWide4);
  const File files[] = {require(File::open(Bytes(first))), require(File::open(Bytes(second)))};
  const std::vector<Tree> trees = {require(Tree::bind(files[0])), require(Tree::bind(files[1]))};
  const CFile c_files[] = {open_c(first), open_c(second)};
  std::vector<PlacedTree> placed;
  std::vector<bxt_placed_tree> c_placed;
  std::mt19937_64 random(11);
  for (std::uint32_t i = 0; i < 24; ++i) {
    const char* const name = i % 3 == 0 ? nullptr : i % 2 == 0 ? "even" : "odd";
    PlacedTree instance{.tree = i % 2,
                        .pose = random_pose(random, 4, i % 4 == 0),
                        .layer = i % 3,
                        .moves = i % 4 == 1,
                        .user_data = i * 1000ull};
    if (name != nullptr) instance.name = name;
    placed.push_back(instance);
    bxt_placed_tree c_instance = {};
    c_instance.struct_size = sizeof c_instance;
    c_instance.tree = instance.tree;
    c_instance.pose = pose_of(instance.pose);
    c_instance.layer = instance.layer;
    c_instance.moves = instance.moves;
    c_instance.user_data = instance.user_data;
    c_instance.name = name;
    c_placed.push_back(c_instance);
  }
  const std::vector<SceneLayer> layers = {
      {.name = "ground"}, {.name = "things", .collides_with = 5, .queries = kAllQueries}};
  std::vector<bxt_scene_layer> c_layers(2);
  c_layers[0] = {sizeof(bxt_scene_layer), BXT_ALL_LAYERS, BXT_ALL_QUERIES, 0, "ground"};
  c_layers[1] = {sizeof(bxt_scene_layer), 5, BXT_ALL_QUERIES, 0, "things"};
  Scene scene = require(Scene::assemble(trees, placed, layers));
  bxt_scene* assembled = nullptr;
  {
    const CTree c_trees[] = {bind_c(c_files[0]), bind_c(c_files[1])};
    const bxt_tree* const given[] = {c_trees[0].get(), c_trees[1].get()};
    ASSERT_EQ(bxt_scene_assemble(given, 2, c_placed.data(), c_placed.size(), c_layers.data(),
                                 c_layers.size(), nullptr, &assembled, nullptr),
              BXT_OK);
  }
  const CScene c_scene(assembled);
  body(scene, c_scene.get());
  change(scene, c_scene.get());
  body(scene, c_scene.get());
}

}  // namespace

void for_each_scene(const std::function<void(const Scene&, const bxt_scene*)>& body) {
  for_each_bound_scene(body);
  for_each_assembled_scene(body);
}

}  // namespace boxtree::test
