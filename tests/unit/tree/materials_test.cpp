// SPDX-License-Identifier: MIT
// Materials of faces of single trees: end to end for each encoding, with and without face ids, from
// files of each kind; what is stored; bytes that are corrupt.
#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/import/mesh_arrays.h"
#include "cooker/proof/proof.h"
#include "cooker/shell/cook_job.h"
#include "format/face_numbers.h"
#include "format/scene_record.h"
#include "runtime/file/open_file.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/source_faces.h"
#include "tests/support/temp_folder.h"
#include "tests/unit/tree/face_number_cases.h"
#include "tests/unit/tree/section_bytes.h"

namespace boxtree {
namespace {

using cooker::FaceMaterials;
using cooker::SourceMesh;
using test::require;

// Runs of `length` faces on average, of `count` materials.
FaceMaterials random_materials(const SourceMesh& mesh, std::uint32_t count, double length) {
  std::mt19937 random(count);
  std::uniform_real_distribution<double> uniform(0, 1);
  FaceMaterials materials;
  for (std::uint32_t i = 0; i < count; ++i) materials.names.push_back("m" + std::to_string(i));
  for (std::uint32_t face = 0; face < mesh.faces.size(); ++face) {
    if (face > 0 && uniform(random) > 1 / length) continue;
    const auto material = static_cast<std::uint32_t>(random() % count);
    const bool differs = materials.runs.empty() || materials.runs.back().number != material;
    if (differs) materials.runs.push_back({face, material});
  }
  return materials;
}

std::string material_of(const FaceMaterials& materials, std::uint32_t id) {
  std::string name;
  for (const FaceRun& run : materials.runs) {
    if (run.first_face <= id) name = materials.names[run.number];
  }
  return name;
}

void expect_materials(const SourceMesh& mesh, const FaceMaterials& materials, const Tree& tree) {
  test::for_each_source_face(mesh, tree, [&](const FaceRef& face, std::uint32_t source) {
    EXPECT_EQ(tree.material_name(tree.material(face)), material_of(materials, source));
    EXPECT_EQ(tree.material({kNoFaceId, face.index}), tree.material(face)) << "counted";
  });
}

class MaterialsOf : public testing::TestWithParam<test::FaceNumberCase> {};

TEST_P(MaterialsOf, EachFaceAreThoseOfTheSource) {
  const auto& [codec, geometry, face_ids] = GetParam();
  const SourceMesh mesh = test::terrain(20, 3);
  for (const double length : {1e9, 100.0, 2.0}) {
    const FaceMaterials materials = random_materials(mesh, 9, length);
    cooker::CookOptions options;
    options.geometry = geometry;
    options.face_ids = face_ids;
    const std::vector<std::byte> bytes = test::cook_bytes(mesh, materials, codec, options);
    const File file = require(File::open(Bytes(bytes)));
    EXPECT_TRUE(cooker::verify_file(file).empty());
    BindOptions bind;
    if (geometry == GeometryId::kExternal) bind.mesh = cooker::arrays_of(mesh);
    bind.require_materials = true;
    const Tree tree = require(Tree::bind(file, bind));
    expect_materials(mesh, materials, tree);
    // The smaller of both forms; runs take the ids of faces, but for a single one.
    const std::size_t by_runs = materials.runs.size() * sizeof(FaceRun);
    const bool has_ids = face_ids || geometry == GeometryId::kExternal;
    const bool is_by_runs = by_runs <= mesh.faces.size() && (has_ids || materials.runs.size() == 1);
    EXPECT_EQ(test::section_bytes(file, SectionKind::kMaterialRuns), is_by_runs ? by_runs : 0);
    EXPECT_EQ(test::section_bytes(file, SectionKind::kFaceMaterials),
              is_by_runs ? 0 : mesh.faces.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, MaterialsOf, testing::ValuesIn(test::face_number_cases()),
                         test::name_of_case);

TEST(TreeMaterials, CopiesHaveTheirOwn) {
  SourceMesh mesh = test::terrain(4, 3);
  const auto count = static_cast<std::uint32_t>(mesh.faces.size());
  mesh.faces.insert(mesh.faces.end(), mesh.faces.begin(), mesh.faces.begin() + 5);
  const FaceMaterials materials{{"below", "above"}, {{0, 0}, {count, 1}}};
  for (const bool face_ids : {true, false}) {
    cooker::CookOptions options;
    options.face_ids = face_ids;
    const auto bytes = test::cook_bytes(mesh, materials, CodecId::kWide8, options);
    const File file = require(File::open(Bytes(bytes)));
    const Tree tree = require(Tree::bind(file));
    std::array<std::uint32_t, 2> found{};
    static_cast<void>(require(overlap_box(tree, tree.bounds(), [&](const FaceRef& face) {
      const std::uint32_t material = tree.material(face);
      if (face_ids) {
        EXPECT_EQ(material, face.id < count ? 0u : 1u);
      }
      if (material < 2) ++found[material];
      return true;
    })));
    EXPECT_EQ(found[0], count);
    EXPECT_EQ(found[1], 5u);
  }
}

TEST(TreeMaterials, AreNoneWhereTheyWereLeftOut) {
  const test::CookedTree cooked = test::cook_tree(test::terrain(4, 3), CodecId::kWide8);
  EXPECT_EQ(cooked.tree.material_count(), 0u);
  EXPECT_EQ(cooked.tree.material({0, 0}), kNoMaterial);
  EXPECT_EQ(cooked.tree.material_name(0), "");
  EXPECT_EQ(cooked.tree.material_name(kNoMaterial), "");
  BindOptions options;
  options.require_materials = true;
  EXPECT_EQ(Tree::bind(cooked.file, options).code(), Errc::kPartLeftOut);
}

cooker::CookJob job_of(std::vector<std::filesystem::path> inputs, std::filesystem::path output) {
  cooker::CookJob job;
  job.inputs = std::move(inputs);
  job.output = std::move(output);
  job.options.materials = true;
  return job;
}

constexpr const char* kPoints = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 9 9 9\n";

// Each face's material in the order of the ids.
std::vector<std::string> names_by_id(const Tree& tree) {
  std::map<std::uint32_t, std::string> names;
  static_cast<void>(require(overlap_box(tree, tree.bounds(), [&](const FaceRef& face) {
    names[face.id] = tree.material_name(tree.material(face));
    return true;
  })));
  std::vector<std::string> list;
  for (const auto& [id, name] : names) list.push_back(name);
  return list;
}

TEST(TreeMaterials, OfOneNameAreOneInAllTreesOfAFile) {
  test::TempFolder folder;
  const std::string points = kPoints;
  const auto a = folder.write("a.obj", points + "usemtl wood\nf 1 2 3\nusemtl tin\nf 1 2 4\n");
  const auto b = folder.write("b.obj", points + "usemtl tin\nf 1 2 3\nusemtl clay\nf 1 2 4\n");
  const auto c = folder.write("c.obj", points + "f 1 2 3\n");
  const auto out = folder.path() / "out.bxt";
  static_cast<void>(require(cooker::cook_job(job_of({a, b, c}, out))));
  const File file = require(File::open(out.string()));
  using Names = std::vector<std::string>;
  const Tree first = require(Tree::bind(file, 0));
  EXPECT_EQ(first.material_count(), 3u);
  EXPECT_EQ(names_by_id(first), (Names{"wood", "tin"}));
  EXPECT_EQ(names_by_id(require(Tree::bind(file, 1))), (Names{"tin", "clay"}));
  EXPECT_EQ(names_by_id(require(Tree::bind(file, 2))), (Names{""}));
}

// Faces that are dropped had more runs than the tree has faces, for trees and for scenes.
TEST(TreeMaterials, OfFacesThatWereSkippedAreNotStored) {
  test::TempFolder folder;
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\n";
  for (const std::string name : {"a", "b", "c", "d"}) text += "usemtl " + name + "\nf 1 2 4\n";
  text += "usemtl kept\nf 1 2 3\nusemtl e\nf 1 3 4\n";
  const auto out = folder.path() / "out.bxt";
  for (const bool as_scene : {false, true}) {
    cooker::CookJob job = job_of({folder.write("a.obj", text)}, out);
    job.as_scene = as_scene;
    job.options.import.skip_bad = true;
    static_cast<void>(require(cooker::cook_job(job)));
    const File file = require(File::open(out.string()));
    const Tree tree = require(Tree::bind(file, 0));
    EXPECT_EQ(tree.material_count(), 1u);
    EXPECT_EQ(names_by_id(tree), std::vector<std::string>{"kept"});
  }
}

TEST(TreeMaterials, OfAMeshThatIsWrittenInTheOrderOfTheTreeAreThoseOfItsFaces) {
  test::TempFolder folder;
  std::string text;
  for (int i = 0; i < 30; ++i) {
    const std::string x = std::to_string(i * 7 % 30);
    text += "v " + x + " 0 0\nv " + x + " 1 0\nv " + x + " 0 1\n";
  }
  for (int i = 0; i < 30; ++i) {
    text += "usemtl m" + std::to_string(i / 10) + "\nf " + std::to_string(3 * i + 1) + " " +
            std::to_string(3 * i + 2) + " " + std::to_string(3 * i + 3) + "\n";
  }
  const auto out = folder.path() / "out.bxt";
  cooker::CookJob job = job_of({folder.write("a.obj", text)}, out);
  job.reordered = folder.path() / "b.obj";
  static_cast<void>(require(cooker::cook_job(job)));
  const File file = require(File::open(out.string()));
  const Tree tree = require(Tree::bind(file));
  cooker::ImportOptions options;
  options.materials = true;
  const cooker::Imported written = require(cooker::import_mesh(job.reordered, options));
  const std::vector<std::string> names = names_by_id(tree);
  ASSERT_EQ(names.size(), 30u);
  for (std::uint32_t face = 0; face < 30; ++face) {
    EXPECT_EQ(names[face], material_of(written.materials, face)) << face;
  }
}

TEST(TreeMaterials, CorruptBytesAreFoundAndReadInside) {
  const SourceMesh mesh = test::terrain(6, 3);
  for (const double length : {20.0, 1.5}) {
    const FaceMaterials materials = random_materials(mesh, 3, length);
    const std::vector<std::byte> whole = test::cook_bytes(mesh, materials, CodecId::kWide8);
    const SectionKind kind = length > 2 ? SectionKind::kMaterialRuns : SectionKind::kFaceMaterials;
    const SectionEntry entry = test::entry_of(whole, kind);
    EXPECT_FALSE(entry.is_required);
    for (std::size_t bit = 0; bit < entry.size * 8; ++bit) {
      std::vector<std::byte> bytes = whole;
      bytes[entry.offset + bit / 8] ^= std::byte{1} << (bit % 8);
      test::repair_checksums(bytes);
      const File file = require(File::open(Bytes(bytes)));
      const Tree tree = require(Tree::bind(file));
      for (std::uint32_t face = 0; face <= tree.face_count(); ++face) {
        static_cast<void>(tree.material_name(tree.material({face, face})));
      }
      const bool is_high = bit % 8 > 1 && kind == SectionKind::kFaceMaterials;
      EXPECT_TRUE(!is_high || !cooker::verify_file(file).empty()) << bit;
    }
  }
}

TEST(TreeMaterials, AsManyAsFacesAreExpected) {
  const cooker::EncodedTree tree = require(cooker::cook_as(test::terrain(6, 3), CodecId::kWide8));
  const cooker::Materials two_faces{{"a"}, {{{}, {0, 0}}}};
  const auto bytes = require(cooker::serialize({std::span(&tree, 1), {}, nullptr, &two_faces}));
  const File file = require(File::open(Bytes(bytes)));
  EXPECT_EQ(Tree::bind(file).error().detail,
            "tree 0: section face_materials: 2 bytes, its record states " +
                std::to_string(tree.face_count));
  EXPECT_EQ(Tree::bind(file).code(), Errc::kSectionSize);
  const cooker::Materials many_runs{{"a"}, {{std::vector<FaceRun>(tree.face_count + 1), {}}}};
  const auto more = require(cooker::serialize({std::span(&tree, 1), {}, nullptr, &many_runs}));
  const File with_more = require(File::open(Bytes(more)));
  EXPECT_EQ(Tree::bind(with_more).code(), Errc::kSectionSize);
}

template <class Record, class Change>
std::string finding_after(std::vector<std::byte> bytes, SectionKind kind, const Change& change) {
  test::edit_records<Record>(bytes, kind, change);
  const File file = require(File::open(Bytes(bytes)));
  const cooker::Findings findings = cooker::verify_file(file);
  return findings.empty() ? "" : findings.front().detail;
}

TEST(TreeMaterials, VerifySaysWhatIsWrong) {
  const SourceMesh mesh = test::terrain(6, 3);
  const std::vector<std::byte> runs =
      test::cook_bytes(mesh, {{"a", "b"}, {{0, 0}, {9, 1}, {20, 0}}}, CodecId::kWide8);
  const auto run_after = [&](const auto& change) {
    return finding_after<FaceRun>(runs, SectionKind::kMaterialRuns,
                                  [&](FaceRun& run, std::uint32_t i, std::uint32_t) {
                                    if (i == 1) change(run);
                                  });
  };
  EXPECT_EQ(run_after([](FaceRun&) {}), "");
  EXPECT_EQ(run_after([](FaceRun& run) { run.first_face = 0; }), "materials of tree 0: run 1");
  EXPECT_EQ(run_after([](FaceRun& run) { run.first_face = 20; }), "materials of tree 0: run 2");
  EXPECT_EQ(run_after([](FaceRun& run) { run.number = 2; }), "materials of tree 0: run 1");
  EXPECT_EQ(
      finding_after<MaterialRecord>(runs, SectionKind::kMaterials,
                                    [](MaterialRecord& record, std::uint32_t i, std::uint32_t) {
                                      if (i == 1) record.name_offset = 99;
                                    }),
      "material 1: its name lies outside section names");
}

}  // namespace
}  // namespace boxtree
