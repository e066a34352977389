// SPDX-License-Identifier: MIT
// Hostile bytes: every truncation and every flipped bit of a small file is refused with a code or
// answered, with checksums repaired too, so that the checks behind them are reached.
#include <algorithm>

#include <gtest/gtest.h>

#include "cooker/proof/proof.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/tree_queries.h"

namespace boxtree {
namespace {

struct Encoding {
  CodecId codec;
  GeometryId geometry;
  bool duplicates = false;  // some faces twice
  bool active_edges = false;
  std::uint32_t materials = 0;  // runs; many are stored by face
};

std::vector<std::byte> small_file(const Encoding& encoding) {
  cooker::CookOptions options;
  options.geometry = encoding.geometry;
  options.grid.bits = 12;
  if (encoding.active_edges) options.active_edges = 5;
  cooker::SourceMesh mesh = test::city(2, 1);
  if (encoding.duplicates) mesh.faces.insert(mesh.faces.end(), 2, mesh.faces[1]);
  if (encoding.materials > 0) {
    const auto faces = static_cast<std::uint32_t>(mesh.faces.size());
    cooker::FaceMaterials materials;
    for (std::uint32_t i = 0; i < encoding.materials; ++i) {
      materials.names.push_back(std::string("m").append(std::to_string(i)));
      materials.runs.push_back({i * faces / encoding.materials, i});
    }
    return test::cook_bytes(mesh, materials, encoding.codec, options);
  }
  const Result<cooker::EncodedTree> cooked = cooker::cook_as(mesh, encoding.codec, options);
  return cooker::serialize(std::span(&*cooked, 1), "{}\n");
}

// Where a part of the file's tree touches a part of itself: all faces with themselves would take
// four fifths of the time.
const Pose kPartly = [] {
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Vector3d(1.25, 0.5, 0.125);
  return pose;
}();

// Opens, proves and queries everything; whatever comes back, it must come back.
void exercise(Bytes bytes) {
  const Result<File> file = File::open(bytes);
  if (!file) return;
  static_cast<void>(cooker::verify_file(*file));
  const Result<Tree> tree = Tree::bind(*file);
  if (!tree) return;
  static const std::vector<test::TreeQuery> queries = [] {
    test::QuerySet set;
    set.ray = {{0.3, 0.4, 9}, {0.01, 0.02, -1}};
    set.box = {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(9, 9, 9)};
    set.point = {3, 2, 1};
    set.radius = 4;
    set.far.translation() = Eigen::Vector3d(4, 5, 1);
    set.near = kPartly;
    set.node_budget = 100;
    return test::tree_queries(set);
  }();
  for (std::uint32_t face = 0; face <= std::min(tree->face_count(), 99u); ++face) {
    static_cast<void>(tree->material_name(tree->material({face, face})));
    static_cast<void>(tree->user_data({face, face}));
  }
  for (const test::TreeQuery& query : queries) static_cast<void>(query.run_query(*tree, *tree, {}));
}

TEST(MutationQueries, TouchAPartOfTheTree) {
  const std::vector<std::byte> bytes = small_file({CodecId::kWide8, GeometryId::kExact});
  const File file = *File::open(bytes);
  const Tree tree = *Tree::bind(file);
  std::size_t pairs = 0;
  ASSERT_TRUE(overlap_pairs(tree, Pose::Identity(), tree, kPartly,
                            [&](const FacePair&) { return ++pairs > 0; }));
  EXPECT_GT(pairs, 5u);
  EXPECT_LT(pairs, 4 * std::size_t{tree.face_count()});
}

class Mutation : public testing::TestWithParam<Encoding> {};

TEST_P(Mutation, EveryTruncationIsRefused) {
  const std::vector<std::byte> whole = small_file(GetParam());
  ASSERT_TRUE(File::open(whole).ok());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::vector<std::byte> cut(whole.begin(),
                                     whole.begin() + static_cast<std::ptrdiff_t>(size));
    ASSERT_FALSE(File::open(cut).ok()) << size;
  }
}

TEST_P(Mutation, EveryFlippedBitIsFoundByVerify) {
  std::vector<std::byte> bytes = small_file(GetParam());
  ASSERT_TRUE(cooker::verify_file(*File::open(bytes)).empty());
  for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
    bytes[bit / 8] ^= std::byte{1} << (bit % 8);
    exercise(bytes);
    const Result<File> file = File::open(bytes);
    ASSERT_TRUE(!file.ok() || !cooker::verify_file(*file).empty()) << "bit " << bit;
    bytes[bit / 8] ^= std::byte{1} << (bit % 8);
  }
}

TEST_P(Mutation, EveryFlippedBitWithGoodChecksumsIsAnsweredOrRefused) {
  const std::vector<std::byte> whole = small_file(GetParam());
  for (std::size_t bit = 0; bit < whole.size() * 8; ++bit) {
    std::vector<std::byte> bytes = whole;
    bytes[bit / 8] ^= std::byte{1} << (bit % 8);
    test::repair_checksums(bytes);
    exercise(bytes);
  }
}

// Every codec with exact geometry; a codec of each kind of leaf with the grid.
std::vector<Encoding> encodings() {
  std::vector<Encoding> all;
  for (const CodecId codec : test::all_codecs()) all.push_back({codec, GeometryId::kExact});
  all.push_back({CodecId::kWide8, GeometryId::kArrays});
  all.push_back({CodecId::kPlainF16, GeometryId::kGrid});
  all.push_back({CodecId::kWide8, GeometryId::kGrid});
  all.push_back({CodecId::kWide8, GeometryId::kExact, true});
  all.push_back({CodecId::kWide8, GeometryId::kExact, false, true});
  all.push_back({CodecId::kPlainF32, GeometryId::kGrid, true});
  all.push_back({CodecId::kWide8, GeometryId::kExact, false, false, 2});
  all.push_back({CodecId::kWide4, GeometryId::kExact, false, false, 9});
  return all;
}

std::string encoding_name(const testing::TestParamInfo<Encoding>& encoding) {
  const std::string codec = test::test_name({encoding.param.codec, encoding.index});
  return codec + "_" + std::string(geometry_name(encoding.param.geometry)) +
         (encoding.param.duplicates ? "_duplicates" : "") +
         (encoding.param.active_edges ? "_edges" : "") +
         (encoding.param.materials > 0 ? "_materials" + std::to_string(encoding.param.materials)
                                       : "");
}

INSTANTIATE_TEST_SUITE_P(Encodings, Mutation, testing::ValuesIn(encodings()), encoding_name);

}  // namespace
}  // namespace boxtree
