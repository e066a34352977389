// SPDX-License-Identifier: MIT
// The golden files: what the cooker writes for scene.obj, byte for byte, and that files of every
// released version open for ever. The .hex files are the specification in the flesh: they are
// added to, never regenerated.
#include <algorithm>
#include <cctype>
#include <optional>

#include <gtest/gtest.h>

#include "cooker/write/pack_writer.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree {
namespace {

const std::filesystem::path kFolder = BOXTREE_GOLDEN_DIR;

// A golden file: what it is called, and how it is cooked.
struct Kind {
  std::string name;
  CodecId codec;
  GeometryId geometry;
  std::optional<double> active_edges = std::nullopt;
  bool materials = false;
  bool user_data = false;
};

std::vector<Kind> kinds() {
  std::vector<Kind> kinds;
  for (const CodecId codec : test::all_codecs()) {
    kinds.push_back({std::string(codec_name(codec)), codec, GeometryId::kExact});
  }
  kinds.push_back({"plain-f16-grid", CodecId::kPlainF16, GeometryId::kGrid});
  kinds.push_back({"wide8-grid", CodecId::kWide8, GeometryId::kGrid});
  kinds.push_back({"wide8-edges", CodecId::kWide8, GeometryId::kExact, 20.0});
  kinds.push_back({"wide8-materials", CodecId::kWide8, GeometryId::kExact, std::nullopt, true});
  kinds.push_back(
      {"wide8-user-data", CodecId::kWide8, GeometryId::kExact, std::nullopt, false, true});
  return kinds;
}

std::vector<std::byte> golden_bytes(const Kind& kind) {
  const std::string text = test::read_text(kFolder / ("v1.0-" + kind.name + ".hex"));
  std::vector<std::byte> bytes;
  unsigned digits = 0;
  unsigned value = 0;
  for (const char c : text) {
    if (std::isxdigit(static_cast<unsigned char>(c)) == 0) continue;
    value = value * 16 + static_cast<unsigned>(c <= '9' ? c - '0' : c - 'a' + 10);
    if (++digits % 2 != 0) continue;
    bytes.push_back(static_cast<std::byte>(value));
    value = 0;
  }
  return bytes;
}

// The wide codecs get a scene of more than one leaf: the same one, with more faces beside it.
std::string scene_of(const Kind& kind) {
  if (kind.materials) return "scene-materials.obj";
  if (kind.user_data) return "scene-user-data.ply";
  return is_wide(kind.codec) ? "scene-wide.obj" : "scene.obj";
}

class Golden : public testing::TestWithParam<Kind> {};

TEST_P(Golden, CookingGivesTheSameBytesAsEver) {
  const std::vector<std::byte> golden = golden_bytes(GetParam());
  ASSERT_FALSE(golden.empty()) << "no golden file";
  cooker::ImportOptions import;
  import.materials = GetParam().materials;
  if (GetParam().user_data) import.user_data = "zone";
  Result<cooker::Imported> imported = cooker::import_mesh(kFolder / scene_of(GetParam()), import);
  ASSERT_TRUE(imported.ok()) << imported.error().message();
  imported->mesh.name = "scene";
  cooker::CookOptions cook;
  cook.geometry = GetParam().geometry;
  cook.grid.bits = 16;
  cook.active_edges = GetParam().active_edges;
  const std::vector<std::byte> cooked =
      GetParam().materials
          ? test::cook_bytes(imported->mesh, imported->materials, GetParam().codec, cook)
      : GetParam().user_data
          ? test::cook_bytes(imported->mesh, imported->user_data, GetParam().codec, cook)
          : test::cook_bytes(imported->mesh, GetParam().codec, cook);
  ASSERT_EQ(cooked.size(), golden.size());
  for (std::size_t i = 0; i < golden.size(); ++i) ASSERT_EQ(cooked[i], golden[i]) << "byte " << i;
}

TEST_P(Golden, FilesOfEveryVersionOpenAndAnswer) {
  const std::vector<std::byte> golden = golden_bytes(GetParam());
  OpenOptions options;
  options.verify_checksums = true;
  const Result<File> file = File::open(Bytes(golden), options);
  ASSERT_TRUE(file.ok()) << file.error().message();
  const Result<Tree> tree = Tree::bind(*file);
  ASSERT_TRUE(tree.ok()) << tree.error().message();
  EXPECT_EQ(BoundTree::of(*tree).codec(), GetParam().codec);
  EXPECT_EQ(tree->name(), "scene");
  EXPECT_EQ(tree->has_active_edges(), GetParam().active_edges.has_value());
  EXPECT_EQ(tree->material_count(), GetParam().materials ? 2u : 0u);
  const std::uint32_t more = is_wide(GetParam().codec) ? 12 : 0;
  EXPECT_EQ(BoundTree::of(*tree).face_count(), 8 + more);
  EXPECT_EQ(BoundTree::of(*tree).triangle_count(), 9 + more);

  const auto down = closest_hit(*tree, {{0.25, 0.25, 3}, {0, 0, -1}});
  ASSERT_TRUE(down.ok() && down.has_value());
  EXPECT_EQ(down->face.id, 0u);
  EXPECT_EQ(down->t, 3);
  EXPECT_EQ(tree->material_name(tree->material(down->face)), GetParam().materials ? "stone" : "");
  const bool has_user_data = GetParam().user_data;
  EXPECT_EQ(tree->user_data(down->face), has_user_data ? std::optional(7u) : std::nullopt);
  // The quad and a piece of the pentagon share the plane: the smaller face id answers.
  const auto shared = closest_hit(*tree, {{4.5, 0.5, 3}, {0, 0, -1}});
  ASSERT_TRUE(shared.ok() && shared.has_value());
  EXPECT_EQ(shared->face.id, 1u);
  EXPECT_EQ(tree->user_data(shared->face), has_user_data ? std::optional(1000u) : std::nullopt);
  EXPECT_EQ(shared->t, 2.5);
  const auto closest = closest_point(*tree, {0.4375, 9, 1});
  ASSERT_TRUE(closest.ok() && closest.has_value());
  EXPECT_EQ(closest->face.id, 4u);  // the face without area
  EXPECT_EQ(closest->distance, 2);
  std::vector<std::uint32_t> touched;
  ASSERT_TRUE(overlap_box(*tree, {Eigen::Vector3d(12.0625, 2, -1), Eigen::Vector3d(13, 4, 1)},
                          [&](const FaceRef& face) {
                            touched.push_back(face.id);
                            return true;
                          })
                  .ok());
  EXPECT_EQ(touched, std::vector<std::uint32_t>{3});
}

// The bounds hold the time at which they touch, and are as near to each other as cast.h says for
// coordinates up to 64.
void expect_cast(const CastResult& hit, std::uint32_t face, double t, Feature feature) {
  ASSERT_TRUE(hit.ok() && hit.has_value());
  EXPECT_EQ(hit->face.id, face);
  EXPECT_LE(hit->t_lower, t);
  EXPECT_GE(hit->t, t);
  EXPECT_LE(hit->t - hit->t_lower, 4 * 64 * 0x1p-46);
  EXPECT_EQ(hit->feature, feature);
  EXPECT_FALSE(hit->initially_touching);
}

TEST_P(Golden, FilesOfEveryVersionAnswerCastsAndContacts) {
  const std::vector<std::byte> golden = golden_bytes(GetParam());
  const Result<File> file = File::open(Bytes(golden));
  ASSERT_TRUE(file.ok()) << file.error().message();
  const Result<Tree> tree = Tree::bind(*file);
  ASSERT_TRUE(tree.ok()) << tree.error().message();
  const Motion down{{0, 0, -1}};

  const Sphere sphere{{0.25, 0.25, 3}, 0.5};
  const CastResult onto_face = cast_closest(*tree, sphere, down);
  expect_cast(onto_face, 0, 2.5, Feature::kFace);
  EXPECT_NEAR((onto_face->normal - Eigen::Vector3d(0, 0, 1)).norm(), 0, 1e-14);
  EXPECT_NEAR((onto_face->point - Eigen::Vector3d(0.25, 0.25, 0)).norm(), 0, 1e-12);
  // The face without area, across it.
  expect_cast(cast_closest(*tree, Capsule{{0.4375, 6, 3}, {0.4375, 8, 3}, 0.25}, down), 4, 1.75,
              Feature::kEdge);
  // The quad and a piece of the pentagon share the plane: the smaller face id answers.
  OrientedBox box;
  box.center = {4.5, 0.5, 3};
  box.half_extents = {0.25, 0.125, 0.5};
  expect_cast(cast_closest(*tree, box, down), 1, 2, Feature::kFace);
  const std::vector<Eigen::Vector3d> points = {{0, 0, 0}, {0.125, 0, 1}, {0, 0.125, 1}};
  ConvexHull hull;
  hull.points = points;
  hull.position = {12.03125, 3.25, 3};
  expect_cast(cast_closest(*tree, hull, down), 3, 2.875, Feature::kFace);
  EXPECT_FALSE(cast_closest(*tree, Sphere{{0, 20, 3}, 0.5}, down));

  std::size_t contacts = 0;
  ASSERT_TRUE(collide(*tree, Sphere{{0.25, 0.25, 0.25}, 0.5}, [&](const Contact& contact) {
                ++contacts;
                EXPECT_EQ(contact.face.id, 0u);
                EXPECT_EQ(contact.feature, Feature::kFace);
                EXPECT_EQ(contact.depth, 0.25);
                EXPECT_EQ(contact.normal, Eigen::Vector3d(0, 0, 1));
                EXPECT_EQ(contact.point, Eigen::Vector3d(0.25, 0.25, 0));
                return true;
              }).ok());
  EXPECT_EQ(contacts, 1u);
  box.center[2] = 0.75;
  std::vector<std::uint32_t> touched;
  ASSERT_TRUE(overlap_oriented_box(*tree, box, [&](const FaceRef& face) {
                touched.push_back(face.id);
                return true;
              }).ok());
  std::sort(touched.begin(), touched.end());
  touched.erase(std::unique(touched.begin(), touched.end()), touched.end());  // pieces
  EXPECT_EQ(touched, (std::vector<std::uint32_t>{1, 2, 5}));
}

std::string kind_name(const testing::TestParamInfo<Kind>& kind) {
  std::string name = kind.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

// Of two other golden files.
std::vector<std::byte> packed() {
  const auto open = [](const std::filesystem::path& path) -> Result<File> {
    static const std::vector<std::byte> wide8 = golden_bytes({"wide8", {}, {}});
    static const std::vector<std::byte> dedup = golden_bytes({"dedup", {}, {}});
    return File::open(Bytes(path == "wide8.bxt" ? wide8 : dedup));
  };
  std::vector<cooker::PackMember> members;
  for (const char* path : {"wide8.bxt", "dedup.bxt"}) {
    members.push_back(
        test::require(cooker::list_members(path, cooker::PackNames::kPath, open)).front());
  }
  const test::TempFolder folder;
  static_cast<void>(test::require(cooker::write_pack(folder.path() / "pack.bxt", members, open)));
  const std::string text = test::read_text(folder.path() / "pack.bxt");
  const Bytes bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

TEST(GoldenPack, PackingGivesTheSameBytesAsEver) {
  EXPECT_EQ(packed(), golden_bytes({"pack", {}, {}}));
}

TEST(GoldenPack, OpensAndAnswers) {
  const std::vector<std::byte> golden = golden_bytes({"pack", {}, {}});
  const Result<File> file = File::open(Bytes(golden));
  ASSERT_TRUE(file.ok()) << file.error().message();
  for (const auto& [name, codec] :
       {std::pair("dedup", CodecId::kDedup), std::pair("wide8", CodecId::kWide8)}) {
    const Result<std::uint32_t> number = file->find_tree(name);
    ASSERT_TRUE(number.ok()) << number.error().message();
    const Result<Tree> tree = Tree::bind(*file, *number);
    ASSERT_TRUE(tree.ok()) << tree.error().message();
    EXPECT_EQ(BoundTree::of(*tree).codec(), codec);
    const auto down = closest_hit(*tree, {{0.25, 0.25, 3}, {0, 0, -1}});
    ASSERT_TRUE(down.ok() && down.has_value());
    EXPECT_EQ(down->face.id, 0u);
    EXPECT_EQ(down->t, 3);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Golden, testing::ValuesIn(kinds()), kind_name);

}  // namespace
}  // namespace boxtree
