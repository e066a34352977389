// SPDX-License-Identifier: MIT
// What import makes of a file with a node graph: instances, poses, meshes once, materials.
#include <cmath>
#include <limits>

#include "cooker/import/source_scene.h"
#include "gltf_text.h"
#include "placed_triangles.h"
#include "runtime/query/relative_pose.h"
#include "temp_files.h"
#include "tests/support/cooked.h"

namespace boxtree::cooker {
namespace {

using SceneCorners = std::array<std::uint32_t, 4>;
using Rows = std::array<double, 12>;
using Runs = std::vector<std::array<std::uint32_t, 2>>;

const std::vector<float> kPositions = {0, 0, 0, 1, 0, 0, 0, 1, 0};
const std::vector<float> kOther = {0, 0, 0, 3, 0, 0, 0, 0, 3, 3, 0, 0, 3, 0, 3, 0, 0, 3};
const std::vector<float> kSecondBad = {
    0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 0, std::numeric_limits<float>::quiet_NaN(), 0, 0, 0, 1, 0};

class ImportSceneTest : public ImportTest {
 protected:
  SourceScene scene(const std::string& name, std::string_view bytes,
                    const ImportOptions& options = {}) const {
    Result<SourceScene> result = import_scene(write(name, bytes), options);
    EXPECT_TRUE(result.ok()) << result.error().message();
    return result.ok() ? std::move(result).value() : SourceScene();
  }
  Error fail_scene(std::string_view bytes, const ImportOptions& options = {}) const {
    const std::filesystem::path path = write("bad.gltf", bytes);
    const Result<SourceScene> result = import_scene(path, options);
    EXPECT_FALSE(result.ok());
    if (result.ok()) return {};
    EXPECT_TRUE(has(result.error().detail, path.string()));
    return result.error();
  }
  // Every triangle of the scene is where import_mesh puts it, and has the material that it has
  // there.
  void expect_places_like_mesh(const std::string& name, const SourceScene& scene) const {
    ImportOptions options;
    options.materials = true;
    const Result<Imported> flat = import_mesh(folder_ / name, options);
    ASSERT_TRUE(flat.ok()) << flat.error().message();
    EXPECT_EQ(placed_triangles(scene), placed_triangles(flat->mesh));
    std::vector<std::string> materials;
    for (const SceneInstance& instance : scene.instances) {
      const SceneMesh& mesh = scene.meshes[instance.mesh];
      add_materials(mesh.materials, mesh.source_faces, scene.materials, materials);
    }
    const auto faces = static_cast<std::uint32_t>(flat->report.source_faces);
    std::vector<std::string> of_mesh;
    add_materials(flat->materials.runs, faces, flat->materials.names, of_mesh);
    EXPECT_EQ(of_mesh, materials);
  }

  // The name of each face's material.
  static void add_materials(const std::vector<FaceRun>& runs, std::uint32_t faces,
                            const std::vector<std::string>& names, std::vector<std::string>& out) {
    std::size_t run = 0;
    for (std::uint32_t face = 0; face < faces; ++face) {
      if (run + 1 < runs.size() && runs[run + 1].first_face == face) ++run;
      out.push_back(runs.empty() ? "" : names[runs[run].number]);
    }
  }
};

Rows rows_of(const Pose& pose) {
  Rows rows{};
  for (int i = 0; i < 12; ++i) rows[static_cast<std::size_t>(i)] = pose(i / 4, i % 4);
  return rows;
}

Runs runs_of(const SceneMesh& mesh) {
  Runs runs;
  for (const FaceRun& run : mesh.materials) runs.push_back({run.first_face, run.number});
  return runs;
}

std::vector<std::string> names_of(const SourceScene& scene) {
  std::vector<std::string> names;
  for (const SceneInstance& instance : scene.instances) names.push_back(instance.name);
  return names;
}

std::vector<std::uint32_t> meshes_of(const SourceScene& scene) {
  std::vector<std::uint32_t> meshes;
  for (const SceneInstance& instance : scene.instances) meshes.push_back(instance.mesh);
  return meshes;
}

TEST_F(ImportSceneTest, PosesAreProductsFromTheRootDown) {
  GltfText gltf;
  gltf.add_mesh("tri", {{kPositions}});
  const SourceScene got =
      scene("yard.gltf",
            gltf.text(R"({"children":[1,2,3,4],"translation":[10,0,0]},)"
                      R"({"name":"a","mesh":0,"scale":[2,3,4]},)"
                      R"({"name":"b","mesh":0,"rotation":[0.5,0.5,0.5,0.5],"translation":[0,5,0]},)"
                      R"({"name":"c","mesh":0,"scale":[1,1,-1]},)"
                      R"({"name":"d","scale":[2,2,2],"children":[5]},)"
                      R"({"name":"e","mesh":0,"rotation":[0,0,1,0],"translation":[1,2,3]})"));
  EXPECT_EQ(got.name, "yard");
  EXPECT_EQ(names_of(got), (std::vector<std::string>{"a", "b", "c", "e"}));
  ASSERT_EQ(got.instances.size(), 4u);
  EXPECT_EQ(rows_of(got.instances[0].pose), (Rows{2, 0, 0, 10, 0, 3, 0, 0, 0, 0, 4, 0}));
  EXPECT_EQ(rows_of(got.instances[1].pose), (Rows{0, 0, 1, 10, 1, 0, 0, 5, 0, 1, 0, 0}))
      << "x to y, y to z, z to x";
  EXPECT_EQ(rows_of(got.instances[2].pose), (Rows{1, 0, 0, 10, 0, 1, 0, 0, 0, 0, -1, 0}));
  EXPECT_EQ(rows_of(got.instances[3].pose), (Rows{-2, 0, 0, 12, 0, -2, 0, 4, 0, 0, 2, 6}));
  for (std::uint32_t id = 0; id < 4; ++id) EXPECT_EQ(got.instances[id].id, id);

  ASSERT_EQ(got.meshes.size(), 1u);
  EXPECT_EQ(got.meshes[0].mesh.name, "tri");
  EXPECT_EQ(got.meshes[0].mesh.positions.f32, kPositions) << "in its own space";
  EXPECT_EQ(got.meshes[0].mesh.faces[0].corner, (SceneCorners{0, 1, 2, kNoCorner}));
  EXPECT_EQ(got.report.meshes, 1u);
  EXPECT_EQ(got.report.source_faces, 1u) << "counted once";
  EXPECT_NE(got.report.content_hash, 0u);
  ASSERT_EQ(got.report.files_read.size(), 1u);
  expect_places_like_mesh("yard.gltf", got);
}

TEST_F(ImportSceneTest, PosesAreInDoubleInBothPrecisions) {
  GltfText gltf;
  gltf.add_mesh("tri", {{kPositions}});
  // 1 + 2^24 needs 25 bits.
  const std::string text = gltf.text(R"({"translation":[16777216,0,0],"children":[1,2]},)"
                                     R"({"mesh":0,"translation":[1,0,0]},{"mesh":0})");
  const SourceScene narrow = scene("a.gltf", text);
  ASSERT_EQ(narrow.instances.size(), 2u);
  EXPECT_EQ(narrow.instances[0].pose.translation().x(), 16777217.0);
  const SourceScene wide = scene("a.gltf", text, {.precision = Precision::kF64});
  ASSERT_EQ(wide.meshes.size(), 1u);
  EXPECT_EQ(wide.instances[0].pose.translation().x(), 16777217.0);
  EXPECT_EQ(wide.meshes[0].mesh.positions.f64,
            (std::vector<double>(kPositions.begin(), kPositions.end())));
  EXPECT_TRUE(wide.meshes[0].mesh.positions.f32.empty());
}

TEST_F(ImportSceneTest, EqualContentIsStoredOnce) {
  std::vector<float> turned = kPositions, minus_zero = kPositions;
  std::rotate(turned.begin(), turned.begin() + 3, turned.end());
  minus_zero[0] = -0.0f;
  GltfText gltf;
  gltf.add_mesh("first", {{kPositions}});
  gltf.add_mesh("other", {{kOther}});
  gltf.add_mesh("again", {{kPositions}});
  gltf.add_mesh("turned", {{turned}});
  gltf.add_mesh("minus zero", {{minus_zero}});
  const SourceScene got =
      scene("a.gltf", gltf.text(R"({"children":[1,2,3,4,5,6,7]},{"mesh":0},{"mesh":1},{"mesh":2},)"
                                R"({"mesh":3},{"mesh":1},{"mesh":4},{"mesh":2})"));
  EXPECT_EQ(meshes_of(got), (std::vector<std::uint32_t>{0, 1, 0, 2, 1, 3, 0}));
  ASSERT_EQ(got.meshes.size(), 4u);
  EXPECT_EQ(got.meshes[0].mesh.name, "first");
  EXPECT_EQ(got.meshes[1].mesh.name, "other");
  EXPECT_EQ(got.meshes[2].mesh.name, "turned");
  EXPECT_EQ(got.meshes[3].mesh.name, "minus zero");
  EXPECT_EQ(got.report.meshes, 5u);
  EXPECT_EQ(got.report.source_faces, 6u) << "equal meshes count each, instances do not";
  expect_places_like_mesh("a.gltf", got);
}

TEST_F(ImportSceneTest, PrimitivesAreRunsOfMaterials) {
  GltfText gltf;
  gltf.add_mesh("car", {{kOther, 2}, {kPositions, 0}, {kPositions, 0}, {kOther, -1}});
  gltf.add_mesh("lamp", {{kPositions, 1}});
  gltf.add_mesh("lamp of other material", {{kPositions, 0}});
  gltf.add_mesh("lamp again", {{kPositions, 1}});
  const SourceScene got = scene(
      "a.gltf", gltf.text(R"({"children":[1,2,3,4]},{"mesh":0},{"mesh":1},{"mesh":2},{"mesh":3})",
                          R"({"name":"steel"},{},{"name":"paint"},{"name":"nowhere"})"));
  // In order of first use; what no face has is not there. Faces without a material have the third.
  EXPECT_EQ(got.materials,
            (std::vector<std::string>{"paint", "steel", "material 2", "material 3"}));
  ASSERT_EQ(got.meshes.size(), 3u) << "meshes of other materials differ";
  EXPECT_EQ(got.meshes[0].mesh.name, "car");
  EXPECT_EQ(got.meshes[0].source_faces, 6u);
  EXPECT_EQ(runs_of(got.meshes[0]), (Runs{{0, 0}, {2, 1}, {4, 2}}));
  EXPECT_EQ(runs_of(got.meshes[1]), (Runs{{0, 3}}));
  EXPECT_EQ(runs_of(got.meshes[2]), (Runs{{0, 1}}));
  EXPECT_EQ(meshes_of(got), (std::vector<std::uint32_t>{0, 1, 2, 1}));
  // All primitives of a node are one mesh: corners are shared across them.
  EXPECT_EQ(got.meshes[0].mesh.faces.size(), 6u);
  EXPECT_EQ(got.meshes[0].mesh.positions.size(), 6u);
  expect_places_like_mesh("a.gltf", got);
}

TEST_F(ImportSceneTest, MaterialsOfOneNameAreOne) {
  GltfText gltf;
  gltf.add_mesh("a", {{kPositions, 0}, {kPositions, 1}});
  gltf.add_mesh("b", {{kPositions, 1}, {kPositions, 0}});
  const SourceScene got = scene("a.gltf", gltf.text(R"({"children":[1,2]},{"mesh":0},{"mesh":1})",
                                                    R"({"name":"steel"},{"name":"steel"})"));
  EXPECT_EQ(got.materials, std::vector<std::string>{"steel"});
  ASSERT_EQ(got.meshes.size(), 1u);
  EXPECT_EQ(runs_of(got.meshes[0]), (Runs{{0, 0}}));
}

TEST_F(ImportSceneTest, NoMaterialsWhereTheFileHasNone) {
  GltfText gltf;
  gltf.add_mesh("a", {{kPositions}, {kOther}});
  const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (const SourceScene& got :
       {scene("a.gltf", gltf.text(R"({"mesh":0})")), scene("a.obj", triangle + "f 1 2 3\n")}) {
    EXPECT_TRUE(got.materials.empty());
    ASSERT_EQ(got.meshes.size(), 1u);
    EXPECT_TRUE(got.meshes[0].materials.empty());
  }
  const SourceScene one = scene("a.obj", triangle + "usemtl tin\nf 1 2 3\n");
  EXPECT_EQ(one.materials, std::vector<std::string>{"tin"});
}

TEST_F(ImportSceneTest, MaterialsWithoutNamesStayApart) {
  GltfText gltf;
  gltf.add_mesh("a", {{kPositions, 0}, {kOther, 1}});
  const SourceScene got = scene("a.gltf", gltf.text(R"({"mesh":0})", "{},{}"));
  EXPECT_EQ(got.materials, (std::vector<std::string>{"material 0", "material 1"}));
  ASSERT_EQ(got.meshes.size(), 1u);
  EXPECT_EQ(runs_of(got.meshes[0]), (Runs{{0, 0}, {1, 1}}));
}

TEST_F(ImportSceneTest, MissingNamesAreNoError) {
  GltfText gltf;
  gltf.add_mesh("", {{kPositions}});
  const SourceScene got =
      scene("a.gltf", gltf.text(R"({"children":[1,2,3]},{"mesh":0},{"mesh":0,"name":"n"},)"
                                R"({"mesh":0,"name":"n","translation":[1,0,0]})"));
  ASSERT_EQ(got.instances.size(), 3u);
  EXPECT_EQ(got.instances[0].name, "nodes[1]") << "what assimp calls it";
  EXPECT_EQ(got.instances[1].name, "n");
  EXPECT_EQ(got.meshes.size(), 1u);
}

TEST_F(ImportSceneTest, ColladaInstancesAreWhereTheFileHasThem) {
  const std::string geometry =
      R"(<geometry id="g" name="quad"><mesh><source id="p"><float_array id="f" count="12">)"
      R"(0 0 0 2 0 0 2 1 0 0 1 0</float_array><technique_common><accessor source="#f" count="4" )"
      R"(stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" )"
      R"(type="float"/></accessor></technique_common></source><vertices id="v"><input )"
      R"(semantic="POSITION" source="#p"/></vertices><polylist count="1"><input offset="0" )"
      R"(semantic="VERTEX" source="#v"/><vcount>4</vcount><p>0 1 2 3</p></polylist></mesh>)"
      R"(</geometry>)";
  const std::string node =
      R"(<node id="one" name="one"><matrix>1 0 0 7 0 1 0 8 0 0 1 9 0 0 0 1</matrix>)"
      R"(<instance_geometry url="#g"/></node><node id="two" name="two"><matrix>)"
      R"(0 -3 0 0 3 0 0 0 0 0 3 0 0 0 0 1</matrix><instance_geometry url="#g"/></node>)";
  const SourceScene got = scene(
      "a.dae",
      R"(<?xml version="1.0"?><COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" )"
      R"(version="1.4.1"><asset><unit meter="0.01"/><up_axis>Z_UP</up_axis></asset><library_geometries>)" +
          geometry +
          R"(</library_geometries><library_visual_scenes><visual_scene id="s" name="s">)" + node +
          R"(</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/>)"
          R"(</scene></COLLADA>)");
  EXPECT_EQ(names_of(got), (std::vector<std::string>{"one", "two"}));
  ASSERT_EQ(got.instances.size(), 2u);
  EXPECT_EQ(rows_of(got.instances[0].pose), (Rows{1, 0, 0, 7, 0, 1, 0, 8, 0, 0, 1, 9}));
  EXPECT_EQ(rows_of(got.instances[1].pose), (Rows{0, -3, 0, 0, 3, 0, 0, 0, 0, 0, 3, 0}));
  ASSERT_EQ(got.meshes.size(), 1u);
  EXPECT_EQ(got.meshes[0].mesh.positions.f32,
            (std::vector<float>{0, 0, 0, 2, 0, 0, 2, 1, 0, 0, 1, 0}));
  EXPECT_EQ(got.report.quads_kept, 1u);
  expect_places_like_mesh("a.dae", got);
}

TEST_F(ImportSceneTest, GroupsOfAnObjFileAreOneInstance) {
  const std::string text =
      "v 0.1 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
      "usemtl red\ng one\nf 1 2 3\nf 2 2 3\nusemtl blue\nf 1 2 4\ng two\nusemtl red\nf 2 3 4\n";
  for (const Precision precision : {Precision::kF32, Precision::kF64}) {
    const SourceScene got = scene("cart.obj", text, {.precision = precision});
    ASSERT_EQ(got.instances.size(), 1u);
    EXPECT_EQ(got.instances[0].name, "cart");
    EXPECT_EQ(rows_of(got.instances[0].pose), (Rows{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0}));
    ASSERT_EQ(got.meshes.size(), 1u);
    EXPECT_EQ(got.materials, (std::vector<std::string>{"red", "blue"}));
    EXPECT_EQ(runs_of(got.meshes[0]), (Runs{{0, 0}, {2, 1}, {3, 0}}));
    EXPECT_EQ(got.report.degenerate_faces, 1u);
    const Imported flat = load("cart.obj", text, {.precision = precision});
    EXPECT_EQ(got.meshes[0].mesh.positions.f32, flat.mesh.positions.f32);
    EXPECT_EQ(got.meshes[0].mesh.positions.f64, flat.mesh.positions.f64);
    EXPECT_EQ(got.meshes[0].source_faces, flat.report.source_faces);
    EXPECT_EQ(got.report.content_hash, flat.report.content_hash);
    if (precision == Precision::kF64) {
      EXPECT_EQ(flat.mesh.positions.f64[0], 0.1);
    }
  }
}

TEST_F(ImportSceneTest, OurOwnReadersGiveOneInstance) {
  std::string stl(80, ' ');
  const auto put = [&stl](const auto& value) {
    stl.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  put(std::uint32_t{1});
  for (int i = 0; i < 3; ++i) put(0.0f);
  for (const float coordinate : kPositions) put(coordinate);
  put(std::uint16_t{0});
  const SourceScene got = scene("bolt.stl", stl);
  EXPECT_EQ(got.name, "bolt");
  EXPECT_EQ(names_of(got), std::vector<std::string>{"bolt"});
  ASSERT_EQ(got.meshes.size(), 1u);
  EXPECT_EQ(got.meshes[0].mesh.positions.f32, kPositions);
  EXPECT_EQ(got.meshes[0].mesh.name, "bolt");
  EXPECT_EQ(got.meshes[0].source_faces, 1u);
  EXPECT_TRUE(got.materials.empty());
}

TEST_F(ImportSceneTest, NodesWithoutFacesAreLeftOut) {
  GltfText gltf;
  gltf.add_mesh("points", {{kPositions, -1, 0}});
  gltf.add_mesh("tri", {{kPositions}});
  const SourceScene got =
      scene("a.gltf", gltf.text(R"({"children":[1,2,3]},{"mesh":0,"scale":[0,0,0]},)"
                                R"({"mesh":1,"name":"n"},{"name":"empty"})"));
  EXPECT_EQ(names_of(got), std::vector<std::string>{"n"});
  EXPECT_EQ(got.instances[0].id, 0u);
  EXPECT_EQ(got.meshes.size(), 1u);
  EXPECT_EQ(got.report.points_skipped, 3u);
  EXPECT_EQ(fail_scene(gltf.text(R"({"mesh":0})")).code, Errc::kNoFaces);
}

TEST_F(ImportSceneTest, BadFacesNameTheirMesh) {
  GltfText gltf;
  gltf.add_mesh("good", {{kPositions}});
  gltf.add_mesh("half", {{kSecondBad}});
  gltf.add_mesh("half again", {{kSecondBad}});
  gltf.add_mesh("lost", {{{kSecondBad.begin() + 9, kSecondBad.end()}}});
  const std::string text = gltf.text(
      R"({"children":[1,2,3,4,5]},{"mesh":0},{"mesh":1,"name":"door"},{"mesh":2},{"mesh":3},)"
      R"({"mesh":1})");
  const Error error = fail_scene(text);
  EXPECT_EQ(error.code, Errc::kMeshNotFinite);
  EXPECT_TRUE(has(error.detail, "'door'"));
  EXPECT_TRUE(has(error.detail, "face 1"));

  const SourceScene rest = scene("a.gltf", text, {.skip_bad = true});
  EXPECT_EQ(meshes_of(rest), (std::vector<std::uint32_t>{0, 1, 1, 1}));
  ASSERT_EQ(rest.meshes.size(), 2u);
  EXPECT_EQ(rest.meshes[1].source_faces, 2u);
  EXPECT_EQ(rest.meshes[1].mesh.faces.size(), 1u);
  ASSERT_EQ(rest.report.skipped.size(), 3u) << "a mesh of the file once, however often placed";
  EXPECT_EQ(rest.report.skipped[0].face_id, 1u);
  EXPECT_EQ(rest.report.skipped[0].mesh, 1u);
  EXPECT_EQ(rest.report.skipped[1].mesh, 1u) << "equal to the one before";
  EXPECT_EQ(rest.report.skipped[2].mesh, kNoMesh);

  GltfText lost;
  lost.add_mesh("lost", {{{kSecondBad.begin() + 9, kSecondBad.end()}}});
  const Error none = fail_scene(lost.text(R"({"mesh":0})"), {.skip_bad = true});
  EXPECT_EQ(none.code, Errc::kNoFaces);
  EXPECT_TRUE(has(none.detail, "its only face is bad"));
}

// Found by a newcomer: that a mesh has such a node was told as a mistake in the command.
TEST_F(ImportSceneTest, PosesThatCannotBeInvertedAreNamed) {
  GltfText gltf;
  gltf.add_mesh("tri", {{kPositions}});
  const auto placed = [&gltf](const std::string& how) {
    return gltf.text(R"({"children":[1,2]},{"mesh":0},{"mesh":0,"name":"wheel",)" + how + "}");
  };
  for (const char* how : {R"("scale":[1,0,1])", R"("matrix":[1,2,3,0,4,5,6,0,7,8,9,0,0,0,0,1])"}) {
    const Error error = fail_scene(placed(how));
    EXPECT_EQ(error.code, Errc::kImportFailed) << how;
    EXPECT_TRUE(has(error.detail, "'wheel'"));
    EXPECT_TRUE(has(error.detail, "not invertible"));
    EXPECT_TRUE(has(error.detail, "--flatten"));
  }
  const Error error = fail_scene(placed(R"("translation":[1e39,0,0])"));
  EXPECT_EQ(error.code, Errc::kImportFailed);
  EXPECT_TRUE(has(error.detail, "not finite"));
  EXPECT_TRUE(has(error.detail, "'wheel'"));
  // --flatten cannot place it either.
  EXPECT_FALSE(has(error.detail, "--flatten"));
  EXPECT_TRUE(has(error.detail, "in single precision, in which assimp reads it: at most 3.4e38"));
}

// Nine nodes below one another, each scaled by a power of two: from determinants below all doubles
// to some above them.
TEST_F(ImportSceneTest, AcceptsThePosesThatContactsAccept) {
  SourceMesh mesh;
  mesh.positions.f32 = kPositions;
  mesh.faces = {{{0, 1, 2, kNoCorner}}};
  const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kPlainF32);
  GltfText gltf;
  gltf.add_mesh("tri", {{kPositions}});
  constexpr int kNodes = 9;
  int accepted = 0, refused = 0;
  for (int exponent = -120; exponent <= 120; ++exponent) {
    std::string nodes;
    for (int node = 0; node < kNodes; ++node) {
      const std::string scale = fmt::format("{:.17g}", std::ldexp(1.0, exponent));
      nodes +=
          fmt::format(R"({}{{"scale":[{},{},{}],{}}})", node > 0 ? "," : "", scale, scale, scale,
                      node + 1 < kNodes ? fmt::format(R"("children":[{}])", node + 1)
                                        : std::string(R"("mesh":0)"));
    }
    const Result<SourceScene> got = import_scene(write("a.gltf", gltf.text(nodes)));
    Pose pose = Pose::Identity();
    pose.linear() *= std::ldexp(1.0, kNodes * exponent);
    const bool is_pose =
        RelativePose::make(BoundTree::of(cooked.tree), pose, BoundTree::of(cooked.tree), pose)
            .has_value();
    EXPECT_EQ(got.ok(), is_pose) << "2^" << kNodes * exponent;
    if (got.ok()) {
      EXPECT_EQ(got->instances[0].pose.matrix(), pose.matrix());
    } else {
      EXPECT_EQ(got.code(), Errc::kImportFailed);
    }
    ++(is_pose ? accepted : refused);
  }
  EXPECT_GT(accepted, 60);
  EXPECT_GT(refused, 6);
}

TEST_F(ImportSceneTest, FileIsASceneWhenItPlacesSeveral) {
  GltfText gltf;
  gltf.add_mesh("tri", {{kPositions}, {kOther}});
  gltf.add_mesh("points", {{kPositions, -1, 0}});
  const auto is_scene = [this](const std::string& name, const std::string& text) {
    const Result<ImportedFile> got = import_file(write(name, text));
    EXPECT_TRUE(got.ok()) << got.error().message();
    return got.ok() && std::holds_alternative<SourceScene>(*got);
  };
  EXPECT_TRUE(is_scene("a.gltf", gltf.text(R"({"children":[1,2]},{"mesh":0},{"mesh":0})")));
  EXPECT_FALSE(is_scene("a.gltf", gltf.text(R"({"children":[1,2]},{"mesh":0},{"mesh":1})")));
  EXPECT_FALSE(is_scene("a.gltf", gltf.text(R"({"mesh":0})")));
  EXPECT_FALSE(is_scene("a.gltf", gltf.text(R"({"mesh":0,"scale":[1,1,0]})")))
      << "one mesh may be flattened flat";
  EXPECT_FALSE(is_scene("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\ng a\nf 1 2 3\ng b\nf 1 3 2\n"));
  EXPECT_EQ(import_file(folder_ / "none.gltf").code(), Errc::kFileNotFound);
}

TEST_F(ImportSceneTest, FileOfOneInstanceHasTheBitsOfTheMesh) {
  GltfText gltf;
  gltf.add_mesh("tri", {{kOther}, {{0.1f, -0.0f, 3, 1, 2, 3, 1e-3f, 5, 6}}});
  const auto path = write("a.gltf", gltf.text(R"({"scale":[1.1,-0.3,7],"children":[1]},)"
                                              R"({"mesh":0,"rotation":[0.6,0,0,0.8]})"));
  const Result<ImportedFile> got = import_file(path);
  ASSERT_TRUE(got.ok()) << got.error().message();
  const auto* mesh = std::get_if<Imported>(&*got);
  ASSERT_NE(mesh, nullptr);
  const Result<Imported> expected = import_mesh(path);
  ASSERT_TRUE(expected.ok());
  EXPECT_EQ(mesh->mesh.name, "a");
  EXPECT_EQ(mesh->mesh.face_ids, expected->mesh.face_ids);
  ASSERT_EQ(mesh->mesh.positions.f32.size(), expected->mesh.positions.f32.size());
  EXPECT_EQ(std::memcmp(mesh->mesh.positions.f32.data(), expected->mesh.positions.f32.data(),
                        sizeof(float) * mesh->mesh.positions.f32.size()),
            0);
  ASSERT_EQ(mesh->mesh.faces.size(), expected->mesh.faces.size());
  for (std::size_t i = 0; i < mesh->mesh.faces.size(); ++i) {
    EXPECT_EQ(mesh->mesh.faces[i].corner, expected->mesh.faces[i].corner);
  }
  EXPECT_EQ(mesh->report.content_hash, expected->report.content_hash);
}

}  // namespace
}  // namespace boxtree::cooker
