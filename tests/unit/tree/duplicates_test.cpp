// SPDX-License-Identifier: MIT
// Duplicates: which faces are grouped, what a file says of them, and what bytes that lie about them
// come to.
#include "cooker/build/duplicates.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <set>

#include <gtest/gtest.h>

#include "cooker/proof/proof.h"
#include "format/container.h"
#include "format/tree_record.h"
#include "runtime/file/open_file.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/coincident.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"

namespace boxtree {
namespace {

using cooker::kNoCorner;
using cooker::SourceMesh;
using test::require;

// A query of which only the visitor matters.
void run(Result<Visit> visited) {
  EXPECT_EQ(require(std::move(visited)), Visit::kComplete);
}

SourceMesh mesh_of(std::vector<float> positions, std::vector<cooker::Face> faces) {
  SourceMesh mesh;
  mesh.name = "mesh";
  mesh.positions.f32 = std::move(positions);
  mesh.faces = std::move(faces);
  return mesh;
}

TEST(FindDuplicates, ComparesBitsOfCornersInTheirOrder) {
  // Vertices 3 to 5 are 0 to 2 again; 6 is vertex 0 with another sign of zero.
  const std::vector<float> positions{0, 0, 0, 1, 0, 0, 0, 1, 0,    0, 0,
                                     0, 1, 0, 0, 0, 1, 0, 0, -0.f, 0};
  const SourceMesh mesh = mesh_of(positions, {{{0, 1, 2, kNoCorner}},
                                              {{1, 2, 0, kNoCorner}},
                                              {{3, 1, 5, kNoCorner}},
                                              {{6, 1, 2, kNoCorner}},
                                              {{0, 1, 2, 4}},
                                              {{4, 2, 3, kNoCorner}},
                                              {{3, 4, 5, 1}}});
  const cooker::Duplicates found = cooker::find_duplicates(mesh);
  EXPECT_EQ(found.original, (std::vector<std::uint32_t>{0, 1, 0, 3, 4, 1, 4}));
  EXPECT_EQ(found.count, 3u);
}

TEST(FindDuplicates, TheSmallestIdStandsForItsGroup) {
  SourceMesh mesh = test::identical_faces(5);
  mesh.face_ids = {7, 4, 9, 4, 8};
  EXPECT_EQ(cooker::find_duplicates(mesh).original, std::vector<std::uint32_t>(5, 1));
  std::vector<std::uint32_t> order{1};
  EXPECT_EQ(cooker::append_duplicates(mesh, cooker::find_duplicates(mesh), order),
            std::vector<std::uint32_t>(4, 0));
  EXPECT_EQ(order, (std::vector<std::uint32_t>{1, 3, 0, 4, 2}));
}

TEST(FindDuplicates, NothingIsSaidOfAMeshWithoutAny) {
  for (const SourceMesh& mesh : {test::torus(12, 8), test::city(9, 2), SourceMesh()}) {
    const cooker::Duplicates found = cooker::find_duplicates(mesh);
    EXPECT_TRUE(found.original.empty());
    EXPECT_EQ(found.count, 0u);
  }
}

// Quads and triangles, some of them twice and thrice.
SourceMesh city_with_copies() {
  SourceMesh mesh = test::city(6, 2);
  const std::size_t faces = mesh.faces.size();
  for (std::size_t i = 0; i < faces; i += 3) mesh.faces.push_back(mesh.faces[i]);
  for (std::size_t i = 0; i < faces; i += 6) mesh.faces.push_back(mesh.faces[i]);
  mesh.name = "city with copies";
  return mesh;
}

SourceMesh in_double(SourceMesh mesh) {
  mesh.positions.precision = cooker::Precision::kF64;
  for (const float x : mesh.positions.f32) mesh.positions.f64.push_back(1.1 * x + 0.3);
  mesh.positions.f32.clear();
  mesh.name += " in f64";
  return mesh;
}

std::vector<SourceMesh> meshes_with_copies() {
  std::vector<SourceMesh> meshes{test::identical_faces(1000),
                                 test::corner_orders(1000),
                                 test::duplicates(2),
                                 city_with_copies(),
                                 in_double(city_with_copies()),
                                 test::mixed(test::identical_faces(300), test::torus(16, 12)),
                                 test::mixed(test::corner_orders(300), test::soup(333, 1))};
  SourceMesh twice = test::mixed(test::torus(16, 12), test::torus(16, 12));
  twice.name = "a torus twice";
  meshes.push_back(twice);
  return meshes;
}

class WithDuplicates : public testing::TestWithParam<test::Encoding> {};

TEST_P(WithDuplicates, FilesAreProvenAndNameEveryFaceOnce) {
  for (const SourceMesh& mesh : meshes_with_copies()) {
    SCOPED_TRACE(mesh.name);
    const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
    const Tree& tree = cooked.tree;
    for (const Error& finding : cooker::verify_file(cooked.file))
      ADD_FAILURE() << finding.message();
    const cooker::Duplicates duplicates = cooker::find_duplicates(mesh);
    EXPECT_TRUE(BoundTree::of(tree).has_duplicates());
    EXPECT_GE(BoundTree::of(tree).duplicate_count(),
              duplicates.count);  // a grid may make more
    const std::uint32_t in_leaves = BoundTree::of(tree).counts().faces_in_leaves;
    std::set<std::uint32_t> ids;
    for (std::uint32_t face = 0; face < tree.face_count(); ++face) {
      ids.insert(BoundTree::of(tree).face_id(face));
      const std::uint32_t original = BoundTree::of(tree).original_of(face);
      ASSERT_LT(original, in_leaves);
      const FaceRange copies = BoundTree::of(tree).duplicates_of(original);
      if (face < in_leaves) {
        EXPECT_EQ(original, face);
        continue;
      }
      EXPECT_LE(copies.first, face);
      EXPECT_LT(face, copies.last);
      EXPECT_LT(BoundTree::of(tree).face_id(original), BoundTree::of(tree).face_id(face));
    }
    EXPECT_EQ(ids.size(), mesh.faces.size());
    EXPECT_EQ(*ids.rbegin() + 1, mesh.faces.size());
  }
}

TEST_P(WithDuplicates, SmallestIdsAnswerAndVisitorsHearOfAll) {
  for (const SourceMesh& mesh : meshes_with_copies()) {
    SCOPED_TRACE(mesh.name);
    const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
    const Tree& tree = cooked.tree;
    const Eigen::AlignedBox3d bounds =
        BoundTree::of(tree).to_object(BoundTree::of(tree).root().box);
    std::vector<std::uint32_t> met;
    const auto visit = [&](const FaceRef& face) {
      met.push_back(face.id);
      return true;
    };
    run(overlap_box(tree, bounds, visit));
    std::sort(met.begin(), met.end());
    ASSERT_EQ(met.size(), mesh.faces.size());
    for (std::uint32_t i = 0; i < met.size(); ++i) ASSERT_EQ(met[i], i);
    met.clear();
    run(overlap_sphere(tree, bounds.center(), 2 * bounds.diagonal().norm(), visit));
    ASSERT_EQ(met.size(), mesh.faces.size());
    met.clear();
    const Sphere everything{bounds.center(), 2 * bounds.diagonal().norm()};
    run(cast_all(tree, everything, Motion(), [&](const CastHit& hit) {
      if (hit.triangle == 0) met.push_back(hit.face.id);
      return 0.0;
    }));
    ASSERT_EQ(met.size(), mesh.faces.size());
    const cooker::Duplicates duplicates = cooker::find_duplicates(mesh);
    std::size_t hits = 0;
    for (int i = 0; i < 50; ++i) {
      const Eigen::Vector3d to = bounds.min() + bounds.sizes() * (0.01 + 0.0196 * i);
      const Eigen::Vector3d from = bounds.center() + Eigen::Vector3d(0.3, 0.2 * i - 5, 20);
      if (const auto hit = require(closest_hit(tree, {from, to - from}))) {
        ++hits;
        EXPECT_TRUE(duplicates.is_original(hit->face.id));
      }
      if (const auto touch = require(cast_closest(tree, Sphere{from, 0.1}, Motion{to - from}))) {
        EXPECT_TRUE(duplicates.is_original(touch->face.id));
      }
      EXPECT_TRUE(duplicates.is_original(require(closest_point(tree, from))->face.id));
    }
    EXPECT_GT(hits, 5u);
  }
}

TEST_P(WithDuplicates, AVisitorMayStopAmongCopies) {
  const test::CookedTree cooked = test::cook_tree(test::identical_faces(20), GetParam());
  const Tree& tree = cooked.tree;
  std::size_t met = 0;
  const auto visit = [&](const auto&) { return ++met < 7; };
  EXPECT_EQ(require(overlap_box(tree, BoundTree::of(tree).to_object(BoundTree::of(tree).root().box),
                                visit)),
            Visit::kStopped);
  EXPECT_EQ(met, 7u);
  met = 0;
  EXPECT_EQ(require(overlap_pairs(tree, Pose::Identity(), tree, Pose::Identity(), visit)),
            Visit::kStopped);
  EXPECT_EQ(met, 7u);
  met = 0;
  const auto all = [&](const auto&) { return ++met > 0; };
  EXPECT_EQ(require(overlap_pairs(tree, Pose::Identity(), tree, Pose::Identity(), all)),
            Visit::kComplete);
  EXPECT_EQ(met, 400u);
  const Tree originals = tree.without_duplicates();
  met = 0;
  EXPECT_EQ(require(overlap_pairs(tree, Pose::Identity(), originals, Pose::Identity(), all)),
            Visit::kComplete);
  EXPECT_EQ(met, 20u);
}

TEST_P(WithDuplicates, NothingIsStoredWhereThereAreNone) {
  for (const SourceMesh& mesh : {test::torus(12, 8), test::city(9, 2), test::duplicates(1)}) {
    const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
    EXPECT_FALSE(BoundTree::of(cooked.tree).has_duplicates());
    EXPECT_EQ(BoundTree::of(cooked.tree).duplicate_count(), 0u);
    EXPECT_EQ(OpenFile::of(cooked.file).container().find(SectionKind::kDuplicates, 0), nullptr);
  }
}

// A file of two triangles, thrice each, and more beside them, whose list of duplicates is changed.
class LyingBytes {
 public:
  explicit LyingBytes(const test::Encoding& encoding) {
    SourceMesh mesh = test::mixed(test::soup(2, 1), test::soup(2, 1));
    mesh = test::mixed(mesh, test::soup(2, 1));
    mesh = test::mixed(mesh, test::soup(30, 5));
    cooked_ = test::cook_tree(mesh, encoding).bytes;
  }

  // The codes that verify finds after a change.
  std::set<Errc> after(const std::function<void(TreeRecord&, std::byte*)>& change) const {
    std::vector<std::byte> bytes = cooked_;
    const Result<File> file = File::open(Bytes(bytes));
    const auto at = [&](SectionKind kind, std::uint32_t owner) {
      return bytes.data() + OpenFile::of(*file).container().find(kind, owner)->offset;
    };
    std::byte* const stored = at(SectionKind::kTrees, kNoOwner);
    auto record = load<TreeRecord>(stored);
    EXPECT_EQ(record.duplicate_count, 4u);
    EXPECT_EQ(record.duplicate_bytes, 1);
    change(record, at(SectionKind::kDuplicates, 0));
    std::memcpy(stored, &record, sizeof(record));
    test::repair_checksums(bytes);
    std::set<Errc> codes;
    const Result<File> changed = File::open(Bytes(bytes));
    if (!changed) return {changed.code()};
    for (const Error& finding : cooker::verify_file(*changed)) codes.insert(finding.code);
    if (const Result<Tree> tree = Tree::bind(*changed)) run_query(*tree);
    return codes;
  }

 private:
  // Whatever the answers are, they must come.
  static void run_query(const Tree& tree) {
    std::size_t met = 0;
    const auto count = [&](const auto&) { return ++met < 100'000; };
    const Eigen::AlignedBox3d box(Eigen::Vector3d(-9, -9, -9), Eigen::Vector3d(9, 9, 9));
    static_cast<void>(overlap_box(tree, box, count));
    static_cast<void>(overlap_sphere(tree, {0, 0, 0}, 9, count));
    static_cast<void>(cast_all(tree, Sphere{{0, 0, 0}, 9}, Motion(),
                               [&](const CastHit& hit) { return count(hit) ? 0.0 : -1.0; }));
    static_cast<void>(overlap_pairs(tree, Pose::Identity(), tree, Pose::Identity(), count));
    static_cast<void>(closest_hit(tree, {{0, 0, 9}, {0, 0, -1}}));
    static_cast<void>(closest_point(tree, {0, 0, 9}));
    for (std::uint32_t face = 0; face < tree.face_count(); ++face) {
      const FaceRange copies = BoundTree::of(tree).duplicates_of(face);
      EXPECT_LE(copies.first, copies.last);
      EXPECT_LE(copies.last, tree.face_count());
    }
  }

  std::vector<std::byte> cooked_;
};

TEST_P(WithDuplicates, VerifyRefusesListsThatLie) {
  const LyingBytes file(GetParam());
  const auto one = [](TreeRecord& /*record*/, std::byte*) {};
  EXPECT_TRUE(file.after(one).empty());
  const auto names = [&](std::size_t i, auto change) {
    return file.after([&](TreeRecord& record, std::byte* list) {
      list[i] = std::byte(change(std::to_integer<unsigned>(list[i]), record));
    });
  };
  // Another original; none; one that is a copy itself; out of order.
  const auto codes_of = [&](std::size_t i, auto change) {
    const std::set<Errc> codes = names(i, change);
    EXPECT_FALSE(codes.empty());
    return codes;
  };
  // The last one in leaves, or, where that is the original, the one before, which is out of order.
  const std::set<Errc> another = codes_of(3, [](unsigned old, const TreeRecord& r) {
    const std::uint32_t last = counts_of(r).faces_in_leaves - 1;
    return old == last ? last - 1 : last;
  });
  EXPECT_TRUE(another.contains(Errc::kDuplicateDiffers) || another.contains(Errc::kFaceOutOfRange));
  EXPECT_TRUE(codes_of(3, [](unsigned, const TreeRecord&) {
                return 255u;
              }).contains(Errc::kFaceOutOfRange));
  EXPECT_TRUE(codes_of(3, [](unsigned, const TreeRecord& r) {
                return counts_of(r).faces_in_leaves;
              }).contains(Errc::kFaceOutOfRange));
  EXPECT_TRUE(codes_of(0, [](unsigned, const TreeRecord& r) {
                return counts_of(r).faces_in_leaves - 1;
              }).contains(Errc::kFaceOutOfRange));
}

TEST_P(WithDuplicates, RecordsThatContradictThemselvesAreRefused) {
  const LyingBytes file(GetParam());
  const auto codes_of = [&](auto change) {
    return file.after([&](TreeRecord& record, std::byte*) { change(record); });
  };
  const auto refused = [&](auto change) {
    const std::set<Errc> codes = codes_of(change);
    return codes.contains(Errc::kRecordInvalid) || codes.contains(Errc::kSectionSize);
  };
  EXPECT_TRUE(refused([](TreeRecord& r) { r.duplicate_bytes = 0; }));
  EXPECT_TRUE(refused([](TreeRecord& r) { r.duplicate_bytes = 3; }));
  EXPECT_TRUE(refused([](TreeRecord& r) { r.duplicate_bytes = 4; }));
  EXPECT_TRUE(refused([](TreeRecord& r) { r.duplicate_count = 0; }));
  EXPECT_TRUE(refused([](TreeRecord& r) { r.duplicate_count = r.duplicate_bytes = 0; }));
  EXPECT_TRUE(refused([](TreeRecord& r) { r.duplicate_count = 3; }));
  EXPECT_TRUE(refused([](TreeRecord& r) { r.duplicate_count = r.face_count; }));
  EXPECT_TRUE(refused([](TreeRecord& r) { r.duplicate_count = 0xffffffffu; }));
}

INSTANTIATE_TEST_SUITE_P(Encodings, WithDuplicates, testing::ValuesIn(test::all_encodings()),
                         test::encoding_name);

// Arrays of an application, in whose order copies stand anywhere.
class ExternalDuplicates : public testing::TestWithParam<CodecId> {};

TEST_P(ExternalDuplicates, AnswersAreThoseOfStoredGeometry) {
  const SourceMesh mesh = test::mixed(test::corner_orders(90), test::torus(16, 12));
  std::vector<std::uint32_t> corners;
  for (const cooker::Face& face : mesh.faces) {
    corners.insert(corners.end(), face.corner.begin(), face.corner.begin() + 3);
  }
  cooker::CookOptions options;
  options.geometry = GeometryId::kExternal;
  BindOptions bind;
  bind.mesh =
      external_mesh(mesh.positions.f32.data(), static_cast<std::uint32_t>(mesh.positions.size()),
                    corners.data(), static_cast<std::uint32_t>(mesh.faces.size()));
  bind.verify_mesh = true;
  const test::CookedTree outside = test::cook_tree(mesh, GetParam(), options, bind);
  const test::CookedTree inside = test::cook_tree(mesh, GetParam());
  EXPECT_TRUE(cooker::verify_file(outside.file, bind.mesh).empty());
  EXPECT_TRUE(cooker::verify_file(outside.file).empty());
  EXPECT_EQ(BoundTree::of(outside.tree).duplicate_count(), 84u);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d at(0.04 * i - 1, 0.3, 2);
    const auto a = require(closest_point(outside.tree, at));
    const auto b = require(closest_point(inside.tree, at));
    EXPECT_EQ(a->face.id, b->face.id);
    EXPECT_EQ(a->distance, b->distance);
    const auto faces = [&](const Tree& tree) {
      std::multiset<std::uint32_t> ids;
      run(overlap_sphere(tree, at, 1.9, [&](const FaceRef& face) {
        ids.insert(face.id);
        return true;
      }));
      return ids;
    };
    EXPECT_EQ(faces(outside.tree), faces(inside.tree));
  }
}

INSTANTIATE_TEST_SUITE_P(Codecs, ExternalDuplicates, testing::ValuesIn(test::all_codecs()),
                         test::test_name);

}  // namespace
}  // namespace boxtree
