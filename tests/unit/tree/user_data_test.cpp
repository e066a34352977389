// SPDX-License-Identifier: MIT
// User data of faces: end to end for each encoding, with and without face ids; what is stored, in
// how many bits; bytes that are corrupt.
#include <algorithm>
#include <map>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/import/mesh_arrays.h"
#include "cooker/proof/proof.h"
#include "cooker/shell/cook_job.h"
#include "format/face_numbers.h"
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

using cooker::SourceMesh;
using test::require;

using Numbers = std::vector<std::uint32_t>;  // by source face

// Runs of `length` faces on average, of numbers up to `largest`, which some face has.
Numbers random_numbers(const SourceMesh& mesh, std::uint32_t largest, double length) {
  std::mt19937 random(largest);
  std::uniform_real_distribution<double> uniform(0, 1);
  Numbers numbers;
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const bool goes_on = face > 0 && uniform(random) > 1 / length;
    const auto other = static_cast<std::uint32_t>(uniform(random) * largest);
    numbers.push_back(goes_on ? numbers.back() : other);
  }
  numbers[numbers.size() / 2] = largest;
  return numbers;
}

std::vector<FaceRun> runs_of(const Numbers& numbers) {
  std::vector<FaceRun> runs;
  for (std::uint32_t face = 0; face < numbers.size(); ++face) {
    if (face == 0 || numbers[face] != numbers[face - 1]) runs.push_back({face, numbers[face]});
  }
  return runs;
}

class UserDataOf : public testing::TestWithParam<test::FaceNumberCase> {};

TEST_P(UserDataOf, EachFaceIsThatOfTheSource) {
  const auto& [codec, geometry, face_ids] = GetParam();
  const SourceMesh mesh = test::terrain(12, 3);
  for (const double length : {1e9, 100.0, 2.0}) {
    std::uint32_t bytes_a_face = 1;
    for (const std::uint32_t largest : {0xffu, 0x100u, 0xffffu, 0x10000u, 0xffffffffu}) {
      if (largest == 0x100u) bytes_a_face = 2;
      if (largest == 0x10000u) bytes_a_face = 4;
      const Numbers numbers = random_numbers(mesh, largest, length);
      const std::vector<FaceRun> runs = runs_of(numbers);
      cooker::CookOptions options;
      options.geometry = geometry;
      options.face_ids = face_ids;
      const std::vector<std::byte> bytes = test::cook_bytes(mesh, runs, codec, options);
      const File file = require(File::open(Bytes(bytes)));
      EXPECT_TRUE(cooker::verify_file(file).empty());
      BindOptions bind;
      if (geometry == GeometryId::kExternal) bind.mesh = cooker::arrays_of(mesh);
      bind.require_user_data = true;
      const Tree tree = require(Tree::bind(file, bind));
      EXPECT_TRUE(tree.has_user_data());
      test::for_each_source_face(mesh, tree, [&](const FaceRef& face, std::uint32_t source) {
        EXPECT_EQ(tree.user_data(face), numbers[source]);
        EXPECT_EQ(tree.user_data({kNoFaceId, face.index}), numbers[source]) << "counted";
      });
      // The smaller of both forms; runs take the ids of faces.
      const std::size_t by_runs = runs.size() * sizeof(FaceRun);
      const std::size_t by_face = mesh.faces.size() * bytes_a_face;
      const bool has_ids = face_ids || geometry == GeometryId::kExternal;
      const bool is_by_runs = has_ids && by_runs <= by_face;
      EXPECT_EQ(test::section_bytes(file, SectionKind::kUserDataRuns), is_by_runs ? by_runs : 0);
      EXPECT_EQ(test::section_bytes(file, SectionKind::kFaceUserData), is_by_runs ? 0 : by_face);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, UserDataOf, testing::ValuesIn(test::face_number_cases()),
                         test::name_of_case);

TEST(UserData, OfOneNumberIsOneRunThatNeedsNoIds) {
  cooker::CookOptions options;
  options.face_ids = false;
  const auto bytes = test::cook_bytes(test::terrain(4, 3), std::vector<FaceRun>{{0, 70000}},
                                      CodecId::kWide8, options);
  const File file = require(File::open(Bytes(bytes)));
  EXPECT_EQ(test::section_bytes(file, SectionKind::kUserDataRuns), sizeof(FaceRun));
  const Tree tree = require(Tree::bind(file));
  EXPECT_EQ(tree.user_data({kNoFaceId, 3}), 70000u);
}

TEST(UserData, IsNoneWhereItWasLeftOut) {
  const test::CookedTree cooked = test::cook_tree(test::terrain(4, 3), CodecId::kWide8);
  EXPECT_FALSE(cooked.tree.has_user_data());
  EXPECT_EQ(cooked.tree.user_data({0, 0}), std::nullopt);
  BindOptions options;
  options.require_user_data = true;
  const Result<Tree> refused = Tree::bind(cooked.file, options);
  EXPECT_EQ(refused.code(), Errc::kPartLeftOut);
  EXPECT_EQ(refused.error().detail,
            "tree 0: it was cooked without --user-data, or user_data of a profile");
}

TEST(UserData, OfAFaceThatIsNotThereIsNone) {
  const SourceMesh mesh = test::terrain(4, 3);
  const auto bytes = test::cook_bytes(mesh, runs_of(random_numbers(mesh, 9, 1)), CodecId::kWide8);
  const File file = require(File::open(Bytes(bytes)));
  const Tree tree = require(Tree::bind(file));
  ASSERT_GT(test::section_bytes(file, SectionKind::kFaceUserData), 0u);
  EXPECT_NE(tree.user_data({kNoFaceId, tree.face_count() - 1}), std::nullopt);
  EXPECT_EQ(tree.user_data({0, tree.face_count()}), std::nullopt);
  EXPECT_EQ(tree.user_data({}), std::nullopt);
}

TEST(UserData, CorruptBytesAreFoundAndReadInside) {
  const SourceMesh mesh = test::terrain(6, 3);
  for (const double length : {20.0, 1.5}) {
    const std::vector<std::byte> whole =
        test::cook_bytes(mesh, runs_of(random_numbers(mesh, 300, length)), CodecId::kWide8);
    const SectionKind kind = length > 2 ? SectionKind::kUserDataRuns : SectionKind::kFaceUserData;
    const SectionEntry entry = test::entry_of(whole, kind);
    EXPECT_FALSE(entry.is_required);
    for (std::size_t bit = 0; bit < entry.size * 8; ++bit) {
      std::vector<std::byte> bytes = whole;
      bytes[entry.offset + bit / 8] ^= std::byte{1} << (bit % 8);
      test::repair_checksums(bytes);
      const File file = require(File::open(Bytes(bytes)));
      const Tree tree = require(Tree::bind(file));
      for (std::uint32_t face = 0; face <= tree.face_count(); ++face) {
        static_cast<void>(tree.user_data({face, face}));
      }
      const bool is_high = bit / 8 % 8 == 3 && kind == SectionKind::kUserDataRuns && bit < 64;
      EXPECT_TRUE(!is_high || !cooker::verify_file(file).empty()) << bit;
    }
  }
}

TEST(UserData, AsManyAsFacesAreExpected) {
  cooker::EncodedTree tree = require(cooker::cook_as(test::terrain(6, 3), CodecId::kWide8));
  for (const std::size_t width : {1u, 2u, 4u}) {
    for (const int more : {-1, 0, 1}) {
      tree.user_data.faces.assign(tree.face_count * width + static_cast<std::size_t>(more),
                                  std::byte{});
      const std::vector<std::byte> bytes = cooker::serialize(std::span(&tree, 1));
      const File file = require(File::open(Bytes(bytes)));
      EXPECT_EQ(Tree::bind(file).code(), more == 0 ? Errc::kOk : Errc::kSectionSize);
    }
  }
  tree.user_data.faces.clear();
  tree.user_data.runs.assign((tree.face_count + 1) * sizeof(FaceRun), std::byte{});
  const std::vector<std::byte> bytes = cooker::serialize(std::span(&tree, 1));
  const File file = require(File::open(Bytes(bytes)));
  EXPECT_EQ(Tree::bind(file).code(), Errc::kSectionSize);
}

TEST(UserData, VerifySaysWhatIsWrong) {
  const SourceMesh mesh = test::terrain(6, 3);
  const std::vector<std::byte> whole =
      test::cook_bytes(mesh, std::vector<FaceRun>{{0, 5}, {9, 6}, {20, 5}}, CodecId::kWide8);
  const auto finding_after = [&](std::uint32_t first_face) {
    std::vector<std::byte> bytes = whole;
    test::edit_records<FaceRun>(bytes, SectionKind::kUserDataRuns,
                                [&](FaceRun& run, std::uint32_t i, std::uint32_t) {
                                  if (i == 1) run.first_face = first_face;
                                });
    const File file = require(File::open(Bytes(bytes)));
    const cooker::Findings findings = cooker::verify_file(file);
    return findings.empty() ? std::string() : findings.front().detail;
  };
  EXPECT_EQ(finding_after(9), "");
  EXPECT_EQ(finding_after(0), "user data of tree 0: run 1");
  EXPECT_EQ(finding_after(20), "user data of tree 0: run 2");
  cooker::EncodedTree both = require(cooker::cook_as(mesh, CodecId::kWide8));
  both.user_data.faces.assign(both.face_count, std::byte{});
  both.user_data.runs.assign(sizeof(FaceRun), std::byte{});
  const std::vector<std::byte> bytes = cooker::serialize(std::span(&both, 1));
  const File file = require(File::open(Bytes(bytes)));
  ASSERT_FALSE(cooker::verify_file(file).empty());
  EXPECT_EQ(cooker::verify_file(file).front().detail,
            "user data of tree 0: both runs and faces have some");
}

// Two rows of triangles, each in two groups; one face has a vertex that is not finite.
constexpr const char* kGroups =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nv nan 0 0\nv 0 2 0\nv 1 2 0\n"
    "g lower\nf 1 2 3\ng gone\nf 1 2 5\ng upper\nf 3 4 6\ng lower\nf 2 4 3\ng top\nf 4 7 6\n";

// By the ids of faces.
std::map<std::uint32_t, std::optional<std::uint32_t>> numbers_by_id(const Tree& tree) {
  std::map<std::uint32_t, std::optional<std::uint32_t>> numbers;
  static_cast<void>(require(overlap_box(tree, tree.bounds(), [&](const FaceRef& face) {
    numbers[face.id] = tree.user_data(face);
    return true;
  })));
  return numbers;
}

const std::map<std::uint32_t, std::optional<std::uint32_t>> kWanted = {
    {0, 0}, {2, 2}, {3, 0}, {4, 3}};

TEST(UserData, OfFacesThatAreLeftIsTheirOwn) {
  test::TempFolder folder;
  cooker::CookJob job;
  job.inputs = {folder.write("a.obj", kGroups)};
  job.output = folder.path() / "out.bxt";
  job.options.import.skip_bad = true;
  job.options.import.user_data = "groups";
  for (const bool as_scene : {false, true}) {
    job.as_scene = as_scene;
    static_cast<void>(require(cooker::cook_job(job)));
    const File file = require(File::open(job.output.string()));
    EXPECT_EQ(numbers_by_id(require(Tree::bind(file, 0))), kWanted);
  }
}

TEST(UserData, OfAMeshThatIsWrittenInTheOrderOfTheTreeIsThatOfItsFaces) {
  test::TempFolder folder;
  std::string text;
  for (int i = 0; i < 30; ++i) {
    const std::string x = std::to_string(i * 7 % 30);
    text += "v " + x + " 0 0\nv " + x + " 1 0\nv " + x + " 0 1\n";
  }
  for (int i = 0; i < 30; ++i) {
    text += "g group" + std::to_string(i / 10) + "\nf " + std::to_string(3 * i + 1) + " " +
            std::to_string(3 * i + 2) + " " + std::to_string(3 * i + 3) + "\n";
  }
  cooker::CookJob job;
  job.inputs = {folder.write("a.obj", text)};
  job.output = folder.path() / "out.bxt";
  job.reordered = folder.path() / "b.obj";
  job.options.import.user_data = "groups";
  static_cast<void>(require(cooker::cook_job(job)));
  const File file = require(File::open(job.output.string()));
  const auto numbers = numbers_by_id(require(Tree::bind(file)));
  ASSERT_EQ(numbers.size(), 30u);
  // A face of the new order is told by its x.
  const cooker::Imported written = require(cooker::import_mesh(job.reordered));
  for (std::uint32_t face = 0; face < 30; ++face) {
    const double x = written.mesh.positions[written.mesh.faces[face].corner[0]].x();
    for (std::uint32_t i = 0; i < 30; ++i) {
      if (i * 7 % 30 == x) {
        EXPECT_EQ(numbers.at(face), i / 10) << face;
      }
    }
  }
}

TEST(UserData, OfASceneIsRequestedByItsProfile) {
  test::TempFolder folder;
  folder.write("a.obj", kGroups);
  folder.write("hidden.txt", "3\n");
  for (const std::string ids : {"true", "false"}) {
    cooker::CookJob job;
    job.profile = folder.write(
        "scene.toml", "[scene]\nsource = \"a.obj\"\nuser_data = \"groups\"\nface_ids = " + ids +
                          "\n[[mesh]]\nname = \"a\"\nhidden_faces = \"hidden.txt\"\n");
    job.output = folder.path() / "out.bxt";
    job.options.import.skip_bad = true;
    const cooker::Summary summary = require(cooker::cook_job(job));
    const auto line = std::find_if(summary.why.begin(), summary.why.end(), [](const auto& each) {
      return each.part.find("user_data") < 6;
    });
    ASSERT_NE(line, summary.why.end());
    EXPECT_EQ(line->part, "face_user_data");
    EXPECT_EQ(line->bytes, 3u);
    EXPECT_EQ(line->line, "scene.toml:3: user_data = \"groups\"");
    const File file = require(File::open(job.output.string()));
    const Scene scene = require(Scene::bind(file));
    const auto at = [&](double x, double y) {
      const auto hit = require(closest_hit(scene, {{x, y, 1}, {0, 0, -1}}));
      return hit ? scene.trees()[0].user_data(hit->face) : std::nullopt;
    };
    EXPECT_EQ(at(0.2, 0.2), 0u);
    EXPECT_EQ(at(0.2, 1.2), 2u);
    EXPECT_EQ(at(0.9, 1.9), 3u);
    EXPECT_EQ(at(0.9, 0.9), std::nullopt);  // hidden
  }
}

}  // namespace
}  // namespace boxtree
