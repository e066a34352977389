// SPDX-License-Identifier: MIT
// Literal meshes in another order, and trees whose faces have the numbers of such a mesh.
// tests/reorder reads generated ones back.
#include "cooker/reorder/reordered_mesh.h"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/import/mesh_arrays.h"
#include "cooker/shell/cook_job.h"
#include "format/tree_record.h"
#include "runtime/file/open_file.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;
using test::require;

constexpr std::array<std::uint32_t, 4> kTriangle = {0, 1, 2, kNoCorner};
constexpr std::array<std::uint32_t, 4> kQuad = {0, 1, 2, 3};

// What is written of `text`; its errors are thrown.
std::string reordered(const std::string& name, const std::string& text,
                      const std::vector<SourceCorners>& faces, const std::string& folder = "") {
  const test::TempFolder temp;
  const fs::path source = temp.write(name, text);
  const fs::path target = temp.path() / folder / ("to-" + name);
  fs::create_directories(target.parent_path());
  AtomicFile file = require(write_reordered(source, faces, target));
  EXPECT_FALSE(fs::exists(target)) << "before it is committed";
  EXPECT_TRUE(file.commit().ok());
  return test::read_text(target);
}

TEST(ReorderedObj, RepeatsWhatChangesFromFaceToFace) {
  const std::string source =
      "# two rooms\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1 2 3\n"
      "g room\nusemtl red\nv 5 0 0\nf -3//-1 -2 -1 1  # a quad\nl 1 2\ng hall\nf 2 3 4";
  EXPECT_EQ(reordered("a.obj", source, {{2, kTriangle}, {1, kQuad}, {0, kTriangle}}),
            "# two rooms\nmtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nv 5 0 0\n"
            "g hall\nusemtl red\nf 2 3 4\n"
            "g room\nf 2//1 3 4 1\n"
            "g default\nusemtl DefaultMaterial\nf 1 2 3\n"
            "g room\nusemtl red\nl 1 2\n");
}

TEST(ReorderedObj, PartsOfAPolygonHaveItsCorners) {
  EXPECT_EQ(reordered("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 5\nf 1/1 2/2 \\\n 3/3 4/4\n",
                      {{0, {2, 3, 0, kNoCorner}}, {0, kTriangle}}),
            "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 5\nf 3/3 4/4 1/1\nf 1/1 2/2 3/3\n");
}

TEST(ReorderedObj, ReferencesLeadFromAnotherFolder) {
  const std::string source = "mtllib a.mtl /b.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(reordered("a.obj", source, {{0, kTriangle}}, "x/y"),
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib ../../a.mtl\nmtllib /b.mtl\nf 1 2 3\n");
}

TEST(ReorderedPly, RecordsMove) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
      "property float z\nproperty uchar red\n";
  const std::string vertices = "0 0 0 9\n1 0 0 8\n1 1 0 7\n0 1 5 6\n";
  const std::string faces =
      "property list uchar int vertex_indices\nproperty int material\nend_header\n";
  EXPECT_EQ(
      reordered("a.ply",
                head + "element face 3\n" + faces + vertices + "3 0 1 2 10\n2 0 1 20\n4 0 1 2 3 30",
                {{1, {2, 3, 0, kNoCorner}}, {0, kTriangle}, {1, kTriangle}}),
      head + "element face 4\n" + faces + vertices +
          "3 2 3 0 30\n3 0 1 2 10\n3 0 1 2 30\n2 0 1 20\n");
}

TEST(ReorderedMesh, ASourceThatHasChangedIsAnError) {
  const test::TempFolder folder;
  const fs::path obj = folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const fs::path target = folder.path() / "b.obj";
  const std::vector<SourceCorners> more_faces = {{1, kTriangle}};
  const std::vector<SourceCorners> more_corners = {{0, kQuad}};
  EXPECT_EQ(write_reordered(obj, more_faces, target).code(), Errc::kImportFailed);
  EXPECT_EQ(write_reordered(obj, more_corners, target).code(), Errc::kImportFailed);
  EXPECT_FALSE(fs::exists(target));
}

TEST(ReorderedMesh, NamesHaveOneEnding) {
  EXPECT_TRUE(check_reordered_names("a.OBJ", "b.obj").ok());
  EXPECT_TRUE(check_reordered_names("a.glb", "b.glb").ok());
  for (const auto& [source, target] : {std::pair("a.obj", "b.ply"), std::pair("a.stl", "b.stl"),
                                       std::pair("a.gltf", "b.glb"), std::pair("a.obj", "b")}) {
    EXPECT_EQ(check_reordered_names(source, target).code(), Errc::kMeshUnsupported) << target;
  }
}

// Triangles and quads, two of them copies, and a quad that is not planar.
std::string mesh_of_all_kinds() {
  std::string text;
  for (int i = 0; i < 30; ++i) {
    for (const char* corner : {"0 0", "1 0", "1 1", "0 1"}) {
      text += "v " + std::to_string(2 * i) + "." + corner +
              (i % 3 == 2 && corner[0] == '0' ? " 0.5\n" : " 0\n");
    }
    text += i % 3 == 0 ? "f -4 -3 -2\n" : "f -4 -3 -2 -1\n";
  }
  return text + "f 1 2 3\nf 5 6 7 8\n";
}

class NumberedByTree : public testing::TestWithParam<CodecId> {};

TEST_P(NumberedByTree, IdsAreNumbersInTheWrittenMesh) {
  const test::TempFolder folder;
  CookJob job;
  job.inputs = {folder.write("a.obj", mesh_of_all_kinds())};
  job.output = folder.path() / "a.bxt";
  job.reordered = folder.path() / "b.obj";
  job.options.codec = GetParam();
  ASSERT_TRUE(cook_job(job).ok());
  const File file = require(File::open(job.output.string()));
  const Tree tree = require(Tree::bind(file));
  EXPECT_TRUE(tree.has_face_ids());
  EXPECT_TRUE(OpenFile::of(file).section(SectionKind::kFaceIds, 0).empty());
  EXPECT_EQ(BoundTree::of(tree).duplicate_count(), 2u);

  const SourceMesh written = require(import_mesh(job.reordered)).mesh;
  ASSERT_EQ(written.faces.size(), tree.face_count());
  EXPECT_TRUE(written.face_ids.empty()) << "no face of it is split again";
  EXPECT_EQ(OpenFile::of(file).tree_record(0).geometry_hash, hash_of(written));
  std::vector<bool> is_found(tree.face_count());
  const auto all = [](const auto&) { return true; };
  const auto visited = traverse(tree, all, [&](const LeafTriangle& leaf) {
    EXPECT_EQ(leaf.face.id, leaf.face.index);
    const Face& face = written.faces[leaf.face.id];
    for (const Eigen::Vector3d& corner : leaf.triangle.corner) {
      bool is_of_face = false;
      for (std::size_t i = 0; i < (face.is_quad() ? 4u : 3u); ++i) {
        is_of_face |= written.positions[face.corner[i]] == corner;
      }
      EXPECT_TRUE(is_of_face) << leaf.face.id;
    }
    is_found[leaf.face.id] = true;
    return true;
  });
  ASSERT_TRUE(visited.ok());
  EXPECT_EQ(std::count(is_found.begin(), is_found.end(), false), 2);
}

INSTANTIATE_TEST_SUITE_P(Codecs, NumberedByTree,
                         testing::Values(CodecId::kPlainF32, CodecId::kPackedF16, CodecId::kDedup,
                                         CodecId::kWide8, CodecId::kWide4),
                         test::test_name);

TEST(NumberedByTreeOnly, OneTree) {
  const test::TempFolder folder;
  const fs::path mesh = folder.write("a.obj", mesh_of_all_kinds());
  CookJob job{.inputs = {mesh, mesh}, .output = folder.path() / "a.bxt"};
  job.reordered = folder.path() / "b.obj";
  EXPECT_EQ(cook_job(job).code(), Errc::kMeshUnsupported);
  job.inputs = {mesh};
  job.as_scene = true;
  EXPECT_EQ(cook_job(job).code(), Errc::kMeshUnsupported);
  EXPECT_FALSE(fs::exists(job.output) || fs::exists(job.reordered));
}

TEST(NumberedByTreeOnly, TheMeshIsNoInputOrOutput) {
  const test::TempFolder folder;
  CookJob job{.inputs = {folder.write("a.obj", mesh_of_all_kinds())}};
  job.output = job.reordered = folder.path() / "b.obj";
  EXPECT_EQ(cook_job(job).code(), Errc::kWriteFailed);
  job.output = folder.path() / "a.bxt";
  job.reordered = job.inputs.front();
  EXPECT_EQ(cook_job(job).code(), Errc::kWriteFailed);
  EXPECT_EQ(test::read_text(job.inputs.front()), mesh_of_all_kinds());
}

}  // namespace
}  // namespace boxtree::cooker
