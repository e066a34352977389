// SPDX-License-Identifier: MIT
// Files to scenes: answers against brute force over all placed triangles of the source, what
// leaving out does not change, and the account of the bytes.
#include <algorithm>
#include <cmath>
#include <random>
#include <set>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/cook.h"
#include "cooker/import/mesh_arrays.h"
#include "cooker/proof/proof.h"
#include "cooker/shell/cook_job.h"
#include "format/tree_record.h"
#include "runtime/file/open_file.h"
#include "runtime/primitive/predicates.h"
#include "runtime/primitive/vector3.h"
#include "runtime/scene/bound_scene.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/float_state.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;
using test::require;

struct PlacedFace {
  std::uint32_t id;  // of the instance
  std::uint32_t face;
  Triangle triangle;
};

std::vector<PlacedFace> placed_faces(const SourceScene& scene) {
  std::vector<PlacedFace> faces;
  for (const SceneInstance& instance : scene.instances) {
    const SourceMesh& mesh = scene.meshes[instance.mesh].mesh;
    const auto placed = [&](std::uint32_t vertex) {
      return test::placed(instance.pose, mesh.positions[vertex]);
    };
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      const auto& corner = mesh.faces[f].corner;
      const auto a = placed(corner[0]), b = placed(corner[1]), c = placed(corner[2]);
      faces.push_back({instance.id, mesh.face_id(f), {{a, b, c}}});
      if (mesh.faces[f].is_quad()) {
        faces.push_back({instance.id, mesh.face_id(f), {{a, c, placed(corner[3])}}});
      }
    }
  }
  return faces;
}

CookOptions exact_options() {
  CookOptions options;
  options.geometry = GeometryId::kExact;
  return options;
}

CookJob scene_job(std::vector<fs::path> inputs, const fs::path& output,
                  const fs::path& profile = {}) {
  return {.inputs = std::move(inputs), .output = output, .profile = profile, .as_scene = true};
}

class CookedFileOf {
 public:
  // Without a source where the profile names it.
  CookedFileOf(const fs::path& source, const CookOptions& options, const fs::path& profile = {})
      : summary(require(cook_job(job(source, options, profile)))),
        file(require(File::open((folder_.path() / "scene.bxt").string()))),
        scene(require(Scene::bind(file))) {}

 private:
  [[nodiscard]] CookJob job(const fs::path& source, const CookOptions& options,
                            const fs::path& profile) const {
    CookJob job = scene_job({}, folder_.path() / "scene.bxt", profile);
    if (!source.empty()) job.inputs.push_back(source);
    job.options = options;
    return job;
  }

  test::TempFolder folder_;

 public:
  Summary summary;
  File file;
  Scene scene;
};

// Compares rays, boxes, spheres and closest points with brute force over the source; counts in
// `hits` the rays that hit.
void expect_brute_force(const fs::path& source, const Scene& scene, int queries,
                        std::size_t& hits) {
  const SourceScene from = require(import_scene(source));
  const std::vector<PlacedFace> faces = placed_faces(from);
  ASSERT_EQ(scene.instance_count(), from.instances.size());
  Eigen::AlignedBox3d bounds;
  for (const PlacedFace& face : faces) {
    for (const Eigen::Vector3d& corner : face.triangle.corner) bounds.extend(corner);
  }
  std::mt19937_64 random(17);
  const auto point = [&](double spread) {
    Eigen::Vector3d p;
    for (Eigen::Index k = 0; k < 3; ++k) {
      const double share = std::uniform_real_distribution<double>(-spread, 1 + spread)(random);
      p[k] = bounds.min()[k] + share * bounds.sizes()[k];
    }
    return p;
  };
  const auto id_of = [&](std::uint32_t instance) { return require(scene.info(instance)).id; };
  for (int i = 0; i < queries; ++i) {
    const Eigen::Vector3d from_point = point(1);
    const Ray ray{from_point, point(0) - from_point};
    const RayShear shear(ray.origin, ray.direction);
    double best = std::numeric_limits<double>::infinity();
    for (const PlacedFace& face : faces) {
      const auto hit = intersect_ray_triangle(shear, face.triangle);
      if (hit && hit->t >= 0) best = std::min(best, hit->t);
    }
    const auto hit = require(closest_hit(scene, ray));
    ASSERT_EQ(hit.has_value(), std::isfinite(best)) << i;
    if (hit) {
      ++hits;
      ASSERT_NEAR(hit->t, best, 1e-9 * (1 + best));
    }
    const Eigen::Vector3d half = 0.03 * bounds.sizes();
    const Eigen::Vector3d middle = point(0);
    const Eigen::AlignedBox3d box(middle - half, middle + half);
    const double radius = 0.03 * bounds.diagonal().norm();
    std::set<std::pair<std::uint32_t, std::uint32_t>> in_box, in_sphere, found_box, found_sphere;
    double nearest = std::numeric_limits<double>::infinity();
    for (const PlacedFace& face : faces) {
      if (triangle_intersects_box(face.triangle, box.min(), box.max())) {
        in_box.insert({face.id, face.face});
      }
      const double squared =
          squared_length(closest_point_on_triangle(middle, face.triangle) - middle);
      if (squared <= radius * radius) in_sphere.insert({face.id, face.face});
      nearest = std::min(nearest, squared);
    }
    static_cast<void>(require(overlap_box(scene, box, [&](const SceneFace& face) {
      found_box.insert({id_of(face.instance), face.face.id});  // parts of a polygon share it
      return true;
    })));
    static_cast<void>(require(overlap_sphere(scene, middle, radius, [&](const SceneFace& face) {
      found_sphere.insert({id_of(face.instance), face.face.id});  // parts of a polygon share it
      return true;
    })));
    ASSERT_EQ(found_box, in_box);
    ASSERT_EQ(found_sphere, in_sphere);
    ASSERT_EQ(require(closest_point(scene, middle))->distance, std::sqrt(nearest));
  }
}

std::uint64_t kept_bytes(const Summary& summary) {
  std::uint64_t sum = 0;
  for (const WhyLine& line : summary.why) sum += line.kept ? line.bytes : 0;
  return sum;
}

const fs::path kLevel = fs::path(BOXTREE_SOURCE_FOLDER) / "samples/level/level.gltf";

TEST(CookScene, TheSampleLevelEqualsBruteForce) {
  const CookedFileOf cooked(kLevel, exact_options());
  EXPECT_EQ(cooked.summary.scene->instances, 53u);
  EXPECT_EQ(cooked.summary.trees.size(), 8u);
  EXPECT_TRUE(verify_file(cooked.file).empty());
  std::size_t hits = 0;
  expect_brute_force(kLevel, cooked.scene, 150, hits);
  EXPECT_GT(hits, 20u);
}

TEST(CookScene, RealFilesEqualBruteForce) {
  const fs::path folder = "/usr/share/assimp/models";
  if (!fs::exists(folder)) GTEST_SKIP() << "package assimp-testmodels is not installed";
  std::vector<fs::path> models;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const Result<ImportedFile> file = import_file(entry.path());
    if (file && std::holds_alternative<SourceScene>(*file)) models.push_back(entry.path());
  }
  // Two engines, a truck, a house, insects, mirrored cubes; among them those that the design names.
  EXPECT_GT(models.size(), 50u);
  for (const char* name : {"2CylinderEngine.glb", "CesiumMilkTruck.gltf"}) {
    EXPECT_EQ(
        std::count_if(models.begin(), models.end(),
                      [name](const fs::path& model) { return model.filename() == fs::path(name); }),
        1);
  }
  std::size_t hits = 0;
  for (const fs::path& model : models) {
    SCOPED_TRACE(model.string());
    const CookedFileOf cooked(model, exact_options());
    EXPECT_TRUE(verify_file(cooked.file).empty());
    EXPECT_EQ(kept_bytes(cooked.summary), cooked.file.bytes().size());
    ASSERT_NO_FATAL_FAILURE(expect_brute_force(model, cooked.scene, 20, hits));
  }
  EXPECT_GT(hits, 10 * models.size());
}

// Strips the digits of positions, too: answers are those of the rounded triangles, the same for all
// that is kept.
TEST(CookScene, LeavingOutChangesNoAnswerToWhatIsKept) {
  test::TempFolder folder;
  const fs::path text = folder.write("scene.toml", R"([scene]
queries = ["ray", "pair"]
face_ids = false
materials = false
names = false
exact = true
[[object]]
name = "crate"
match = ["Crate"]
motion = "moving"
)");
  const CookedFileOf whole(kLevel, exact_options());
  const CookedFileOf stripped(kLevel, CookOptions(), text);
  EXPECT_LT(stripped.summary.file_bytes, whole.summary.file_bytes);
  EXPECT_EQ(kept_bytes(stripped.summary), stripped.summary.file_bytes);
  EXPECT_EQ(BoundScene::of(stripped.scene).moving().size(), 1u);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> unit(-1, 1);
  for (int i = 0; i < 2000; ++i) {
    const Ray ray{{12 * unit(random), 5 + 4 * unit(random), 12 * unit(random)},
                  {unit(random), unit(random) - 0.5, unit(random)}};
    const auto a = require(closest_hit(whole.scene, ray));
    const auto b = require(closest_hit(stripped.scene, ray));
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    ASSERT_EQ(a->t, b->t);
    ASSERT_EQ(require(whole.scene.info(a->instance)).id,
              require(stripped.scene.info(b->instance)).id);
    ASSERT_EQ(b->face.id, kNoFaceId);
    ASSERT_EQ(stripped.scene.material({b->instance, b->face}), kNoMaterial);
  }
  const auto refusal = [&](const SceneOptions& options) {
    const Result<Scene> refused = Scene::bind(stripped.file, options);
    return refused.ok() ? "bound" : refused.error().detail;
  };
  SceneOptions options;
  options.require_face_ids = true;
  EXPECT_EQ(refusal(options), "tree 0: face ids were left out by scene.toml:3: face_ids = false");
  options = {};
  options.queries = kBoxQueries;
  EXPECT_EQ(refusal(options),
            "the scene: box queries were left out by scene.toml:2: queries = [\"ray\", \"pair\"]");
  options = {};
  options.require_materials = true;
  EXPECT_EQ(refusal(options),
            "the scene: materials were left out by scene.toml:4: materials = false");
  options = {};
  options.require_names = true;
  EXPECT_EQ(refusal(options), "the scene: names were left out by scene.toml:5: names = false");
}

// Materials without face ids are told face by face.
// A green and a red cube of one shape: one tree where no object needs materials.
TEST(CookScene, ShapesWithoutTheirMaterialsAreStoredOnce) {
  const fs::path cubes = "/usr/share/assimp/models/FBX/cubes_with_mirroring_and_pivot.fbx";
  if (!fs::exists(cubes)) GTEST_SKIP() << "package assimp-testmodels is not installed";
  test::TempFolder folder;
  const fs::path text = folder.write("scene.toml", "[scene]\nmaterials = false\nexact = true\n");
  const CookedFileOf whole(cubes, exact_options());
  const CookedFileOf plain(cubes, CookOptions(), text);
  EXPECT_EQ(whole.scene.trees().size(), 3u);
  EXPECT_EQ(plain.scene.trees().size(), 2u);
  EXPECT_TRUE(verify_file(plain.file).empty());
  EXPECT_EQ(kept_bytes(plain.summary), plain.file.bytes().size());
  std::size_t hits = 0;
  expect_brute_force(cubes, plain.scene, 100, hits);
  EXPECT_GT(hits, 20u);
}

TEST(CookScene, MaterialsSurviveWithoutFaceIds) {
  test::TempFolder folder;
  const fs::path text = folder.write("scene.toml", "[scene]\nface_ids = false\nexact = true\n");
  const CookedFileOf whole(kLevel, exact_options());
  const CookedFileOf stripped(kLevel, CookOptions(), text);
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> unit(-12, 12);
  std::set<std::string> seen;
  for (int i = 0; i < 3000; ++i) {
    const Ray ray{{unit(random), 8, unit(random)}, {0.01, -1, 0.02}};
    const auto a = require(closest_hit(whole.scene, ray));
    const auto b = require(closest_hit(stripped.scene, ray));
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) continue;
    const std::string name(whole.scene.material_name(whole.scene.material({a->instance, a->face})));
    ASSERT_EQ(name, stripped.scene.material_name(stripped.scene.material({b->instance, b->face})));
    seen.insert(name);
  }
  EXPECT_TRUE(seen.contains("stone") && seen.contains("grass") && seen.contains("wood"));
}

TEST(CookScene, ABudgetOfBytesIsKeptOrRefusedWithTheNearest) {
  test::TempFolder folder;
  const auto cook = [&](const std::string& bytes) {
    const fs::path text =
        folder.write("scene.toml", "[scene]\nfor = \"speed\"\n[budget]\nbytes = " + bytes + "\n");
    CookJob job = scene_job({kLevel}, folder.path() / "out.bxt", text);
    job.options.may_use_arrays = true;
    return cook_job(job);
  };
  const Result<Summary> free = cook("1000000");
  ASSERT_TRUE(free.ok()) << free.error().message();
  const std::uint64_t limit = free->file_bytes * 9 / 10;
  const Result<Summary> tight = cook(std::to_string(limit));
  ASSERT_TRUE(tight.ok()) << tight.error().message();
  EXPECT_LE(tight->file_bytes, limit);
  const fs::path out = folder.path() / "out.bxt";
  const std::string before = test::read_text(out);
  const Result<Summary> refused = cook("1000");
  EXPECT_EQ(refused.code(), Errc::kBudgetUnreachable);
  EXPECT_NE(refused.error().detail.find("scene.toml:4"), std::string::npos);
  EXPECT_NE(refused.error().detail.find("the smallest that is possible has "), std::string::npos);
  EXPECT_NE(refused.error().detail.find("; a larger 'tolerance' allows fewer"), std::string::npos)
      << refused.error().detail;
  EXPECT_EQ(test::read_text(out), before);
  for (const std::string budget : {"bytes_per_triangle = 1", "slowdown = 0.5"}) {
    const fs::path text = folder.write("scene.toml", "[scene]\n[budget]\n" + budget + "\n");
    const Result<Summary> none = cook_job(scene_job({kLevel}, out, text));
    EXPECT_EQ(none.code(), Errc::kBudgetUnreachable);
    EXPECT_NE(none.error().detail.find("scene.toml:3: " + budget + ": "), std::string::npos)
        << none.error().detail;
  }
}

// A limit of the file's bytes has every encoding tried, and so has try_all; the grid that was tried
// then took over objects that are to be fast.
TEST(CookScene, WhatIsTriedAndDoesNotBindChangesNoChoice) {
  test::TempFolder folder;
  using Choice = std::tuple<std::string, CodecId, GeometryId>;
  const auto choices = [&](const std::string& budget, bool try_all) {
    const fs::path text = folder.write("scene.toml", "[scene]\nfor = \"balance\"\n" + budget +
                                                         "[[object]]\nname = \"hero\"\n"
                                                         "match = [\"Floor\"]\nfor = \"speed\"\n");
    CookJob job = scene_job({kLevel}, folder.path() / "out.bxt", text);
    job.options.may_use_arrays = true;
    job.options.try_all = try_all;
    const Summary summary = require(cook_job(job));
    std::vector<Choice> chosen;
    for (const CookedTree& tree : summary.trees) {
      for (const Candidate& candidate : tree.contest.candidates) {
        if (!candidate.rejected.empty()) continue;
        chosen.emplace_back(tree.tree.name, candidate.codec, candidate.geometry);
      }
    }
    return chosen;
  };
  const std::vector<Choice> free = choices("", false);
  const auto is_fast = [](const Choice& choice) {
    return std::get<GeometryId>(choice) == GeometryId::kArrays;
  };
  const auto is_small = [](const Choice& choice) {
    return std::get<GeometryId>(choice) == GeometryId::kGrid;
  };
  EXPECT_EQ(std::count_if(free.begin(), free.end(), is_fast), 1);
  EXPECT_GT(std::count_if(free.begin(), free.end(), is_small), 0);
  EXPECT_EQ(choices("", true), free);
  EXPECT_EQ(choices("[budget]\nbytes = 100000000\n", false), free);
  EXPECT_EQ(choices("[budget]\nbytes_per_triangle = 5000\n", false), free);
  EXPECT_EQ(choices("[budget]\nslowdown = 50\n", false), free);
}

// Each object has needs of its own: far scenery small, the rest fast, and the line that said so is
// told.
TEST(CookScene, EachObjectGetsItsCodecAndPrecision) {
  test::TempFolder folder;
  const fs::path text = folder.write("scene.toml", R"([scene]
for = "speed"
[[object]]
name = "scenery"
match = ["Wall*", "Pillar*"]
codec = "wide4"
tolerance = 0.01
[[object]]
name = "barrels"
match = ["Barrel*"]
leave_out = true
)");
  const CookedFileOf cooked(kLevel, CookOptions(), text);
  EXPECT_EQ(cooked.summary.scene->instances, 41u);
  EXPECT_EQ(cooked.summary.scene->instances_left_out, 12u);
  for (const Tree& tree : cooked.scene.trees()) {
    const bool is_scenery = tree.name() == "wall" || tree.name() == "pillar";
    EXPECT_NE(tree.name(), "barrel");
    if (is_scenery) {
      EXPECT_EQ(BoundTree::of(tree).codec(), CodecId::kWide4) << tree.name();
    }
  }
  const auto told = [&](const std::string& owner, const std::string& line) {
    return std::any_of(cooked.summary.why.begin(), cooked.summary.why.end(),
                       [&](const WhyLine& why) {
                         return why.owner == owner && why.line.find(line) != std::string::npos;
                       });
  };
  EXPECT_TRUE(told("mesh wall", "scene.toml:6"));
  EXPECT_TRUE(told("object barrels", "scene.toml:11"));
  EXPECT_EQ(kept_bytes(cooked.summary), cooked.summary.file_bytes);
}

// Also of how vertices are stored, be it by the goal, exactness, a codec or a budget.
TEST(CookScene, EncodingsNameTheLineThatDecidedOnThem) {
  test::TempFolder folder;
  CookOptions options;
  options.may_use_arrays = true;
  const auto line_of = [&](const std::string& text, const std::string& part) {
    const CookedFileOf cooked(kLevel, options, folder.write("scene.toml", text));
    for (const WhyLine& why : cooked.summary.why) {
      if (why.part == part && why.owner == "mesh floor") return why.line;
    }
    return std::string("no such part");
  };
  const auto expect_line = [&](const std::string& text, const std::string& nodes,
                               const std::string& vertices) {
    SCOPED_TRACE(text);
    EXPECT_EQ(line_of(text, "nodes"), nodes);
    EXPECT_EQ(line_of(text, "vertices"), vertices);
  };
  const std::string scene = "[scene]\n";
  const std::string exact = "scene.toml:2: exact = true";
  for (const std::string goal : {"for = \"speed\"", "for = \"memory\""}) {
    expect_line(scene + goal + "\n", "scene.toml:2: " + goal, "scene.toml:2: " + goal);
  }
  expect_line(scene + "exact = true\ncodec = \"wide4\"\n", "scene.toml:3: codec = \"wide4\"",
              exact);
  expect_line(scene + "tolerance = 0.0005\n", "", "scene.toml:2: tolerance = 0.0005");
  expect_line(scene + "[budget]\nslowdown = 1.05\n", "scene.toml:3: slowdown = 1.05",
              "scene.toml:3: slowdown = 1.05");
  expect_line(scene, "", "");
}

// A thousand instances of twenty props take a tenth of the bytes of cooking every one as triangles,
// and far less.
TEST(CookScene, InstancesTakeATenthOfTheirTriangles) {
  test::TempFolder folder;
  std::string text = "[scene]\nexact = true\n";
  for (unsigned i = 0; i < 20; ++i) {
    const SourceMesh mesh = i % 2 == 0 ? test::torus(12 + i, 16) : test::sphere(10 + i, 16);
    std::ostringstream obj;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const Eigen::Vector3d p = mesh.positions[v];
      obj << "v " << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
    }
    for (const Face& face : mesh.faces) {
      obj << 'f';
      for (std::size_t c = 0; c < (face.is_quad() ? 4u : 3u); ++c) obj << ' ' << face.corner[c] + 1;
      obj << '\n';
    }
    const std::string name = "prop" + std::to_string(i);
    folder.write(name + ".obj", obj.str());
    text += "[[mesh]]\nname = \"" + name + "\"\nfile = \"" + name + ".obj\"\n";
  }
  SourceMesh merged;
  merged.name = "merged";
  for (int i = 0; i < 1000; ++i) {
    text += "[[instance]]\nmesh = \"prop" + std::to_string(i % 20) + "\"\ntranslation = [" +
            std::to_string(3 * (i % 32)) + ", 0, " + std::to_string(3 * (i / 32)) +
            "]\naxis = [0, 1, 0]\ndegrees = " + std::to_string(i % 360) + "\n";
  }
  const fs::path profile = folder.write("scene.toml", text);
  const CookedFileOf cooked({}, CookOptions(), profile);
  ASSERT_EQ(cooked.summary.scene->instances, 1000u);
  ASSERT_EQ(cooked.summary.trees.size(), 20u);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const InstanceInfo info = require(cooked.scene.info(i));
    const Pose pose = require(cooked.scene.pose(i));
    const Tree& tree = cooked.scene.trees()[info.tree];
    const auto base = static_cast<std::uint32_t>(merged.positions.size());
    const SourceMesh mesh =
        require(import_mesh(folder.path() / (std::string(tree.name()) + ".obj"))).mesh;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const Eigen::Vector3d p = pose * mesh.positions[v];
      for (Eigen::Index k = 0; k < 3; ++k) merged.positions.f32.push_back(static_cast<float>(p[k]));
    }
    for (Face face : mesh.faces) {
      for (std::uint32_t& corner : face.corner) corner += corner == kNoCorner ? 0 : base;
      merged.faces.push_back(face);
    }
  }
  CookOptions options = exact_options();
  options.codec = CodecId::kWide4;
  const EncodedTree one = require(cook_as(merged, CodecId::kWide4, options));
  const std::uint64_t triangles = one.nodes.bytes.size() + one.geometry.vertices.size() +
                                  one.geometry.corners.size() + one.geometry.face_ids.size();
  EXPECT_LT(cooked.summary.file_bytes * 10, triangles)
      << cooked.summary.file_bytes << " of " << triangles;
}

// Geometry that the application shares with its render mesh: not in the file, the same answers.
TEST(CookScene, ExternalGeometryIsBoundFromTheApplication) {
  test::TempFolder folder;
  const fs::path text = folder.write("scene.toml", R"([scene]
exact = true
[[object]]
name = "shared"
match = ["Floor", "Barrel*"]
external = true
)");
  const fs::path out = folder.path() / "out.bxt";
  const Summary summary = require(cook_job(scene_job({kLevel}, out, text)));
  EXPECT_EQ(kept_bytes(summary), summary.file_bytes);
  const File file = require(File::open(out.string()));
  EXPECT_TRUE(verify_file(file).empty());
  EXPECT_EQ(Scene::bind(file).code(), Errc::kExternalMeshNeeded);
  const SourceScene source = require(import_scene(kLevel));
  std::vector<SceneMeshArrays> arrays;
  for (std::uint32_t tree = 0; tree < file.tree_count(); ++tree) {
    if (OpenFile::of(file).tree_record(tree).geometry != GeometryId::kExternal) continue;
    for (const SceneMesh& mesh : source.meshes) {
      if (mesh.mesh.name == file.tree_name(tree)) arrays.push_back({tree, arrays_of(mesh.mesh)});
    }
  }
  ASSERT_EQ(arrays.size(), 2u);
  SceneOptions options;
  options.meshes = arrays;
  const Scene scene = require(Scene::bind(file, options));
  std::size_t hits = 0;
  expect_brute_force(kLevel, scene, 60, hits);
  EXPECT_GT(hits, 10u);
}

// Only faces of the user's own list are ever dropped, and they are counted.
TEST(CookScene, HiddenFacesAreThoseOfTheList) {
  test::TempFolder folder;
  folder.write("hidden.txt", "# the bottom of the crate\n0\n3-4\n");
  const fs::path text = folder.write("scene.toml", R"([scene]
exact = true
[[mesh]]
name = "crate"
hidden_faces = "hidden.txt"
)");
  const CookedFileOf cooked(kLevel, CookOptions(), text);
  for (const Tree& tree : cooked.scene.trees()) {
    if (tree.name() != "crate") continue;
    ASSERT_EQ(tree.face_count(), 9u);
    std::set<std::uint32_t> ids;
    for (std::uint32_t face = 0; face < 9; ++face) ids.insert(BoundTree::of(tree).face_id(face));
    EXPECT_EQ(ids, (std::set<std::uint32_t>{1, 2, 5, 6, 7, 8, 9, 10, 11}));
  }
  const auto dropped = std::ranges::find_if(cooked.summary.why, [](const WhyLine& line) {
    return !line.kept && line.part == "hidden faces";
  });
  ASSERT_NE(dropped, cooked.summary.why.end());
  EXPECT_NE(dropped->reason.find('3'), std::string::npos) << dropped->reason;
  folder.write("hidden.txt", "0-11\n");
  EXPECT_EQ(cook_job(scene_job({kLevel}, folder.path() / "out.bxt", text)).code(),
            Errc::kProfileInvalid);
}

TEST(CookScene, OneFileIsCookedAsWhatItIs) {
  test::TempFolder folder;
  const fs::path obj = fs::path(BOXTREE_SOURCE_FOLDER) / "samples/meshes/crate.obj";
  const Summary mesh = require(cook_job({{obj}, folder.path() / "mesh.bxt"}));
  EXPECT_FALSE(mesh.scene.has_value());
  const File without = require(File::open((folder.path() / "mesh.bxt").string()));
  EXPECT_EQ(Scene::bind(without).code(), Errc::kNoScene);
  const Summary scene = require(cook_job({{kLevel}, folder.path() / "scene.bxt"}));
  EXPECT_TRUE(scene.scene.has_value());
  const File with = require(File::open((folder.path() / "scene.bxt").string()));
  EXPECT_TRUE(Scene::bind(with).ok());
}

// A tile whose left and right border are alike, side by side with itself on the grid: the points of
// the border are the same bits in the world from both sides.
TEST(CookScene, NeighboursStayTogetherOnTheGrid) {
  test::TempFolder folder;
  constexpr int kCells = 20;
  std::ostringstream obj;
  for (int z = 0; z <= kCells; ++z) {
    for (int x = 0; x <= kCells; ++x) {
      const double along = 6.283185307179586 * (x % kCells) / kCells;
      obj << "v " << double(x) / kCells << ' ' << 0.1 * std::sin(along + z) << ' ' << 0.0517 * z
          << '\n';
    }
  }
  for (int z = 0; z < kCells; ++z) {
    for (int x = 0; x < kCells; ++x) {
      const int a = z * (kCells + 1) + x + 1, b = a + kCells + 1;
      obj << "f " << a << ' ' << a + 1 << ' ' << b << "\nf " << a + 1 << ' ' << b + 1 << ' ' << b
          << '\n';
    }
  }
  folder.write("tile.obj", obj.str());
  const fs::path text = folder.write("scene.toml", R"([scene]
tolerance = 0.0005
for = "memory"
[[mesh]]
name = "tile"
file = "tile.obj"
[[instance]]
mesh = "tile"
[[instance]]
mesh = "tile"
translation = [1, 0, 0]
)");
  const CookedFileOf cooked({}, CookOptions(), text);
  ASSERT_EQ(cooked.scene.trees().size(), 1u);
  const Tree& tree = cooked.scene.trees()[0];
  ASSERT_EQ(BoundTree::of(tree).geometry(), GeometryId::kGrid);
  std::set<std::array<double, 3>> border[2];
  for (std::uint32_t i = 0; i < 2; ++i) {
    const Pose pose = require(cooked.scene.pose(i));
    const auto placed = Placement::make(BoundTree::of(tree), pose);
    const double side = pose.translation()[0] == 0 ? 1 : 0;  // of the tile, where they meet
    for (const Triangle& triangle : test::all_triangles(tree)) {
      for (const Eigen::Vector3d& corner : triangle.corner) {
        if (BoundTree::of(tree).frame().to_object(corner)[0] != side) continue;
        const Eigen::Vector3d world = placed->to_world().apply(corner);
        border[i].insert({world[0], world[1], world[2]});
      }
    }
  }
  EXPECT_EQ(border[0].size(), kCells + 1u);
  EXPECT_EQ(border[0], border[1]);
}

// 24 bits over the extent, tried by default, are fewer than f64 has.
TEST(CookScene, F64KeepsEveryDigitWhereAProfileStatesNoTolerance) {
  test::TempFolder folder;
  folder.write("tilted.obj", "v 0.1 0 0\nv 1 0.2 0\nv 0 1 0.3\nf 1 2 3\n");
  CookOptions options;
  options.import.precision = Precision::kF64;
  const auto error_with = [&](const char* needs) {
    const CookedFileOf cooked(
        {}, options,
        folder.write("scene.toml", std::string("[scene]\nsource = \"tilted.obj\"\n"
                                               "for = \"memory\"\n") +
                                       needs));
    return cooked.summary.trees.at(0).tree.geometry.max_vertex_error;
  };
  EXPECT_EQ(error_with(""), 0);
  EXPECT_GT(error_with("tolerance = 0.001\n"), 0);
}

// What f32 took is part of what a tolerance allows, and of what the file says.
TEST(CookScene, ToleranceCountsWhatF32Moved) {
  test::TempFolder folder;
  folder.write("far.obj",
               "v 459123.4321 5412345.6789 0\nv 459123.5321 5412345.6789 0\n"
               "v 459123.4321 5412345.7789 0\nf 1 2 3\n");
  const CookedFileOf cooked({}, CookOptions(),
                            folder.write("scene.toml",
                                         "[scene]\nsource = \"far.obj\"\ntolerance = 0.25\n"
                                         "for = \"memory\"\n"));
  const double moved = cooked.summary.imports.at(0).moved_by_f32;
  EXPECT_GT(moved, 0.2);
  const double error = OpenFile::of(cooked.file).tree_record(0).max_vertex_error;
  EXPECT_GE(error, moved);
  EXPECT_LE(error, 0.25);
}

// One mesh alone would allow for a grid of whole numbers.
TEST(CookScene, ToleranceIsMeasuredOnAllMeshesTogether) {
  test::TempFolder folder;
  folder.write("whole.obj", "v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n");
  folder.write("eighths.obj", "v 0 0 0\nv 9.125 9.125 9.125\nv 0 9 0\nf 1 2 3\n");
  const char* const one = R"([scene]
tolerance = 0.2
for = "memory"
[[mesh]]
name = "whole"
file = "whole.obj"
[[instance]]
mesh = "whole"
)";
  const char* const other = R"([[mesh]]
name = "eighths"
file = "eighths.obj"
[[instance]]
mesh = "eighths"
)";
  const auto steps_of = [&](const std::string& profile) {
    std::vector<int> steps;
    const CookedFileOf cooked({}, CookOptions(), folder.write("scene.toml", profile));
    for (const CookedTree& each : cooked.summary.trees) {
      EXPECT_EQ(each.tree.geometry.geometry, GeometryId::kGrid) << each.tree.name;
      steps.push_back(each.tree.geometry.grid_exponent);
    }
    return steps;
  };
  EXPECT_EQ(steps_of(one), (std::vector{0}));
  EXPECT_EQ(steps_of(std::string(one) + other), (std::vector{-3, -3}));
}

// The materials of each instance's faces, by id.
std::vector<std::vector<std::string>> materials_of_faces(const Scene& scene) {
  std::vector<std::vector<std::string>> names(scene.instance_count());
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    const InstanceInfo info = require(scene.info(i));
    const Tree& tree = scene.trees()[info.tree];
    std::vector<std::string>& of_faces = names[info.id];
    of_faces.resize(tree.face_count());
    for (std::uint32_t face = 0; face < of_faces.size(); ++face) {
      const std::uint32_t id = BoundTree::of(tree).face_id(face);
      of_faces[id] = scene.material_name(scene.material({i, {id, face}}));
    }
  }
  return names;
}

// Two files of one content are one tree placed twice; a material of one name is one.
TEST(CookScene, WhatSeveralFilesShareIsThereOnce) {
  test::TempFolder folder;
  const std::string wood = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl wood\nf 1 2 3\n";
  const std::string stone = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl stone\nf 1 2 3\n";
  const std::string both =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl stone\nf 1 2 3\nusemtl wood\nf 1 2 4\n";
  const std::vector<fs::path> inputs{folder.write("a.obj", wood), folder.write("b.obj", wood),
                                     folder.write("c.obj", stone), folder.write("d.obj", both)};
  const fs::path out = folder.path() / "out.bxt";
  const Summary summary = require(cook_job(scene_job(inputs, out)));
  EXPECT_EQ(summary.scene->meshes, 3u);
  const File file = require(File::open(out.string()));
  const Scene scene = require(Scene::bind(file));
  EXPECT_EQ(scene.instance_count(), 4u);
  EXPECT_EQ(scene.trees().size(), 3u);
  EXPECT_EQ(scene.material_count(), 2u);
  const std::vector<std::vector<std::string>> expected{
      {"wood"}, {"wood"}, {"stone"}, {"stone", "wood"}};
  EXPECT_EQ(materials_of_faces(scene), expected);
}

TEST(CookScene, MeshesThatAProfileListsHaveTheirMaterials) {
  test::TempFolder folder;
  folder.write("a.obj",
               "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nusemtl stone\nf 1 2 3\nusemtl wood\nf 1 2 4\n");
  folder.write("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl wood\nf 1 2 3\n");
  folder.write("c.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  std::string text;
  for (const std::string file : {"b.obj", "a.obj", "c.off"}) {
    text += "[[mesh]]\nname = \"" + file + "\"\nfile = \"" + file + "\"\n[[instance]]\nmesh = \"" +
            file + "\"\n";
  }
  const CookedFileOf cooked({}, CookOptions(), folder.write("scene.toml", text));
  EXPECT_EQ(cooked.scene.material_count(), 2u);
  const std::vector<std::vector<std::string>> expected{{"wood"}, {"stone", "wood"}, {""}};
  EXPECT_EQ(materials_of_faces(cooked.scene), expected);
}

TEST(CookScene, InvalidScenesAreRefused) {
  test::TempFolder folder;
  const fs::path out = folder.path() / "out.bxt";
  EXPECT_EQ(cook_job(scene_job({}, out)).code(), Errc::kProfileInvalid);
  const fs::path text = folder.write("scene.toml", "[scene]\nsource = \"absent.gltf\"\n");
  EXPECT_EQ(cook_job(scene_job({}, out, text)).code(), Errc::kFileNotFound);
  EXPECT_EQ(cook_job(scene_job({kLevel}, out, text)).code(), Errc::kProfileInvalid);
  EXPECT_FALSE(fs::exists(out));
}

TEST(CookScene, WithoutATopLevelEachMeshIsATree) {
  const std::vector<SourceMesh> meshes{test::torus(20, 12), test::soup(50, 1)};
  CookInput input;
  input.has_top_level = false;
  std::vector<EncodedTree> expected;
  CookOptions options;
  options.cook_record = false;
  for (const SourceMesh& mesh : meshes) {
    input.scene.meshes.push_back({mesh, {}});
    expected.push_back(require(cook_mesh(mesh, options)).tree);
  }
  const CookedFile file = require(cook(std::move(input), {}, options));
  EXPECT_FALSE(file.scene.has_value());
  EXPECT_FALSE(file.summary.scene.has_value());
  EXPECT_EQ(file.summary.trees.size(), meshes.size());
  EXPECT_EQ(require(serialize(file.parts())), serialize(expected));
}

// In memory, too, where no cook_job() has seen to it.
TEST(CookScene, TheCallersFloatingPointStateChangesNoByte) {
  const Profile no_profile;
  const auto loaded = [&] {
    return require(load_scene(std::vector<fs::path>{kLevel}, no_profile, {}));
  };
  const auto cooked = [&](CookInput scene) {
    CookOptions options;
    options.may_use_grid = true;
    const CookedFile file = require(cook(std::move(scene), no_profile, options));
    return require(serialize(file.parts()));
  };
  const std::vector<std::byte> expected = cooked(loaded());
  CookInput scene = loaded();
  const test::RoundingMode<FE_UPWARD> upward;
  EXPECT_EQ(cooked(std::move(scene)), expected);
}

}  // namespace
}  // namespace boxtree::cooker
