// SPDX-License-Identifier: MIT
// Per-node access, frames, external geometry and parts that were left out.
#include <functional>
#include <map>

#include <gtest/gtest.h>

#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;

TEST(Frames, ReachIsTheLargestMagnitudeOnEachAxis) {
  const Box<double> box{{-3, 1, -5}, {2, 4, -1}};
  EXPECT_EQ(max_abs_of(box), Eigen::Vector3d(3, 4, 5));
}

class Trees : public testing::TestWithParam<CodecId> {};

// Every corner of every face, as a reader of single nodes meets them.
using Faces = std::map<std::uint32_t, std::vector<Triangle>>;

void walk(const Tree& tree, const Node& node, std::uint32_t depth, Faces& faces) {
  if (node.is_leaf) {
    TriangleBatch batch;
    ASSERT_EQ(BoundTree::of(tree).leaf_triangles(node, batch), Errc::kOk);
    for (std::uint32_t i = 0; i < batch.count; ++i) {
      const Triangle triangle = batch.triangle(i);
      for (const Eigen::Vector3d& corner : triangle.corner) {
        for (std::size_t k = 0; k < 3; ++k) {
          ASSERT_GE(corner[static_cast<Eigen::Index>(k)], node.box.low[k]);
          ASSERT_LE(corner[static_cast<Eigen::Index>(k)], node.box.high[k]);
        }
      }
      faces[BoundTree::of(tree).face_id(batch.face[i])].push_back(triangle);
    }
    return;
  }
  NodeChildren children;
  ASSERT_EQ(BoundTree::of(tree).expand(node, children), NodeState::kValid);
  ASSERT_GE(children.count, 1u);
  ASSERT_LT(depth, BoundTree::of(tree).depth());
  for (std::uint32_t i = 0; i < children.count; ++i) {
    const Node& child = children.child[i];
    for (std::size_t k = 0; k < 3; ++k) {
      ASSERT_GE(child.box.low[k], node.box.low[k]);
      ASSERT_LE(child.box.high[k], node.box.high[k]);
    }
    walk(tree, child, depth + 1, faces);
  }
}

TEST_P(Trees, NodeByNodeEveryFaceOfTheSourceIsMetOnceInsideItsBoxes) {
  for (const SourceMesh& mesh : test::all_kinds()) {
    SCOPED_TRACE(mesh.name);
    const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
    Faces faces;
    walk(cooked.tree, BoundTree::of(cooked.tree).root(), 0, faces);
    for (std::uint32_t i = BoundTree::of(cooked.tree).counts().faces_in_leaves;
         i < mesh.faces.size(); ++i) {
      const std::uint32_t original =
          BoundTree::of(cooked.tree).face_id(BoundTree::of(cooked.tree).original_of(i));
      ASSERT_TRUE(faces.contains(original));
      faces[BoundTree::of(cooked.tree).face_id(i)] = faces[original];
    }
    ASSERT_EQ(faces.size(), mesh.faces.size());
    for (const auto& [id, triangles] : faces) {
      const cooker::Face& source = mesh.faces[id];
      ASSERT_EQ(triangles.size(), source.is_quad() ? 2u : 1u);
      for (std::size_t half = 0; half < triangles.size(); ++half) {
        const std::size_t corner[3] = {0, half + 1, half + 2};
        for (std::size_t c = 0; c < 3; ++c) {
          // Bit for bit: the frame of an f32 mesh only scales by a power of two.
          ASSERT_EQ(BoundTree::of(cooked.tree).frame().to_object(triangles[half].corner[c]),
                    mesh.positions[source.corner[corner[c]]]);
        }
      }
    }
  }
}

// A leaf of more faces than a batch has room for is refused before anything is written
// behind the batch.
TEST_P(Trees, LeavesOfMoreTrianglesThanABatchHoldsAreRefused) {
  const test::CookedTree cooked = test::cook_tree(test::soup(40, 3), GetParam());
  TriangleBatch batch;
  EXPECT_EQ(BoundTree::of(cooked.tree).leaves().read(0, kMaxLeafTriangles, batch), Errc::kOk);
  EXPECT_EQ(batch.count, kMaxLeafTriangles);
  EXPECT_EQ(BoundTree::of(cooked.tree).leaves().read(0, kMaxLeafTriangles + 1, batch),
            Errc::kFaceOutOfRange);
}

// The application's own arrays of a mesh without quads.
struct Arrays {
  std::vector<float> positions;
  std::vector<std::uint32_t> corners;

  explicit Arrays(const SourceMesh& mesh) : positions(mesh.positions.f32) {
    for (const cooker::Face& face : mesh.faces) {
      corners.insert(corners.end(), face.corner.begin(), face.corner.begin() + 3);
    }
  }
  [[nodiscard]] MeshArrays view() const {
    return external_mesh(positions.data(), static_cast<std::uint32_t>(positions.size() / 3),
                         corners.data(), static_cast<std::uint32_t>(corners.size() / 3));
  }
};

cooker::CookOptions external() {
  cooker::CookOptions options;
  options.geometry = GeometryId::kExternal;
  return options;
}

TEST_P(Trees, ExternalGeometryAnswersAsStoredGeometryDoes) {
  const SourceMesh mesh = test::torus(24, 16);
  const Arrays arrays(mesh);
  BindOptions bind;
  bind.mesh = arrays.view();
  bind.verify_mesh = true;
  const test::CookedTree outside = test::cook_tree(mesh, GetParam(), external(), bind);
  const test::CookedTree inside = test::cook_tree(mesh, GetParam());
  EXPECT_LT(outside.bytes.size(), inside.bytes.size());
  for (int i = 0; i < 200; ++i) {
    const Ray ray{{-2, 0.01 * i - 1, 0.013 * i - 1.2}, {1, 0.1, 0.05}};
    const auto a = closest_hit(outside.tree, ray);
    const auto b = closest_hit(inside.tree, ray);
    ASSERT_TRUE(a.ok() && b.ok());
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a.has_value()) continue;
    EXPECT_EQ(a->t, b->t);
    EXPECT_EQ(a->face.id, b->face.id);
  }
}

// Positions and corners of an application may be of other types; triangles are the same to the bit.
TEST_P(Trees, ExternalArraysOfEveryTypeAreRead) {
  const SourceMesh mesh = test::torus(12, 8);
  const Arrays arrays(mesh);
  const auto vertices = static_cast<std::uint32_t>(mesh.positions.size());
  const auto faces = static_cast<std::uint32_t>(mesh.faces.size());
  SourceMesh in_f64 = mesh;
  in_f64.positions = {cooker::Precision::kF64, {}, {}};
  // More digits than an f32 has.
  for (const float x : mesh.positions.f32) in_f64.positions.f64.push_back(1.1 * x);
  std::vector<std::uint16_t> narrow;
  for (const std::uint32_t corner : arrays.corners) {
    narrow.push_back(static_cast<std::uint16_t>(corner));
  }
  const auto expect_same = [](const SourceMesh& source, const MeshArrays& given) {
    BindOptions bind;
    bind.mesh = given;
    bind.verify_mesh = true;
    const test::CookedTree outside = test::cook_tree(source, GetParam(), external(), bind);
    cooker::CookOptions in_arrays;  // whose leaves have the order of the layout, too
    in_arrays.geometry = GeometryId::kArrays;
    const test::CookedTree inside = test::cook_tree(source, GetParam(), in_arrays);
    const std::vector<Triangle> read = test::all_triangles(outside.tree);
    const std::vector<Triangle> stored = test::all_triangles(inside.tree);
    ASSERT_EQ(read.size(), stored.size());
    for (std::size_t i = 0; i < read.size(); ++i) {
      for (std::size_t corner = 0; corner < 3; ++corner) {
        ASSERT_EQ(read[i].corner[corner], stored[i].corner[corner]) << i;
      }
    }
  };
  expect_same(mesh, arrays.view());
  expect_same(mesh, external_mesh(arrays.positions.data(), vertices, narrow.data(), faces));
  expect_same(in_f64,
              external_mesh(in_f64.positions.f64.data(), vertices, arrays.corners.data(), faces));
}

TEST_P(Trees, NoFacesAtAllMayStayExternal) {
  const SourceMesh mesh;
  const Arrays arrays(mesh);
  BindOptions bind;
  bind.mesh = arrays.view();
  bind.verify_mesh = true;
  EXPECT_TRUE(test::cook_tree(mesh, GetParam(), external(), bind).tree.empty());
}

// What an application says of its arrays is checked before a leaf is read through it.
TEST_P(Trees, ExternalArraysThatCannotBeAreRefused) {
  const SourceMesh mesh = test::torus(8, 6);
  const std::vector<std::byte> bytes = test::cook_bytes(mesh, GetParam(), external());
  const Result<File> file = File::open(Bytes(bytes));
  const Arrays arrays(mesh);
  const auto bound_with = [&](const std::function<void(MeshArrays&)>& change) {
    BindOptions bind;
    bind.verify_mesh = true;
    bind.mesh = arrays.view();
    change(*bind.mesh);
    return Tree::bind(*file, 0, bind).code();
  };
  EXPECT_EQ(bound_with([](MeshArrays&) {}), Errc::kOk);
  for (const std::uint32_t corners : {0u, 1u, 2u, 5u, 0xffffffffu}) {
    EXPECT_EQ(bound_with([=](MeshArrays& given) { given.corners_per_face = corners; }),
              Errc::kExternalMeshMismatch);
  }
  for (const std::uint32_t width : {0u, 1u, 3u, 8u}) {
    EXPECT_EQ(bound_with([=](MeshArrays& given) { given.corner_bytes = width; }),
              Errc::kExternalMeshMismatch);
  }
  EXPECT_EQ(bound_with([](MeshArrays& given) { given.position_stride = 11; }),
            Errc::kExternalMeshMismatch);
  EXPECT_EQ(bound_with([](MeshArrays& given) { given.positions = nullptr; }),
            Errc::kExternalMeshMismatch);
  EXPECT_EQ(bound_with([](MeshArrays& given) { given.corners = nullptr; }),
            Errc::kExternalMeshMismatch);
}

// A tree of a temporary file would point into memory that is gone.
template <class F>
concept BindsTree = requires(F&& file) {
  Tree::bind(std::forward<F>(file));
};
static_assert(BindsTree<File&> && BindsTree<const File&>);
static_assert(!BindsTree<File> && !BindsTree<const File>);

TEST_P(Trees, ExternalGeometryIsRequiredAndRecognised) {
  const SourceMesh mesh = test::torus(8, 6);
  const std::vector<std::byte> bytes = test::cook_bytes(mesh, GetParam(), external());
  const Result<File> file = File::open(Bytes(bytes));
  EXPECT_EQ(Tree::bind(*file).code(), Errc::kExternalMeshNeeded);

  Arrays arrays(mesh);
  BindOptions bind;
  bind.verify_mesh = true;
  bind.mesh = arrays.view();
  EXPECT_TRUE(Tree::bind(*file, 0, bind).ok());
  bind.mesh->face_count -= 1;
  EXPECT_EQ(Tree::bind(*file, 0, bind).code(), Errc::kExternalMeshMismatch);
  arrays.positions[0] += 1;
  bind.mesh = arrays.view();
  EXPECT_EQ(Tree::bind(*file, 0, bind).code(), Errc::kExternalMeshMismatch);
  arrays.corners[1] = 1u << 30;
  EXPECT_EQ(Tree::bind(*file, 0, bind).code(), Errc::kVertexOutOfRange);
  bind.verify_mesh = false;  // then the query finds it
  const Result<Tree> tree = Tree::bind(*file, 0, bind);
  ASSERT_TRUE(tree.ok());
  EXPECT_EQ(closest_point(*tree, {9, 9, 9}, 1e9).code() == Errc::kVertexOutOfRange ||
                overlap_sphere(*tree, {0, 0, 0}, 99, [](const FaceRef&) { return true; }).code() ==
                    Errc::kVertexOutOfRange,
            true);
}

TEST_P(Trees, FaceIdsCanBeLeftOutAndRequested) {
  const SourceMesh mesh = test::torus(8, 6);
  cooker::CookOptions options;
  options.face_ids = false;
  const test::CookedTree cooked = test::cook_tree(mesh, GetParam(), options);
  EXPECT_FALSE(cooked.tree.has_face_ids());
  const auto hit = closest_hit(cooked.tree, {{1, 0.01, 9}, {0, 0, -1}});
  ASSERT_TRUE(hit.ok() && hit.has_value());
  EXPECT_EQ(hit->face.id, kNoFaceId);
  BindOptions bind;
  bind.require_face_ids = true;
  const Result<Tree> refused = Tree::bind(cooked.file, 0, bind);
  EXPECT_EQ(refused.code(), Errc::kPartLeftOut);
  EXPECT_EQ(
      refused.error().detail,
      "tree 0: it was cooked without face ids: with --no-face-ids, or face_ids = false of its "
      "profile");
}

TEST_P(Trees, DoublesFarFromTheOriginKeepTheirDigits) {
  // A torus of millimetres, six thousand kilometres away: f32 would collapse it to a point.
  const SourceMesh near = test::torus(24, 16);
  SourceMesh far = near;
  far.positions.precision = cooker::Precision::kF64;
  far.positions.f64.resize(near.positions.f32.size());
  const Eigen::Vector3d offset(6.4e6, -6.4e6, 1.5e6);
  for (std::size_t i = 0; i < near.positions.f32.size(); ++i) {
    far.positions.f64[i] = 0.001 * near.positions.f32[i] + offset[static_cast<Eigen::Index>(i % 3)];
  }
  far.positions.f32.clear();
  const test::CookedTree cooked = test::cook_tree(far, GetParam());
  const test::CookedTree reference = test::cook_tree(near, GetParam());
  int hits = 0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d from(-2, 0.01 * i - 1, 0.013 * i - 1.2);
    const Eigen::Vector3d along(1, 0.1, 0.05);
    const auto a = closest_hit(cooked.tree, {0.001 * from + offset, along});
    const auto b = closest_hit(reference.tree, {from, along});
    ASSERT_TRUE(a.ok() && b.ok());
    ASSERT_EQ(a.has_value(), b.has_value()) << i;
    if (!a.has_value()) continue;
    ++hits;
    // An ulp of the coordinates is a nanometre.
    EXPECT_NEAR(a->t, 0.001 * b->t, 1e-8);
  }
  EXPECT_GT(hits, 50);
}

// A difference from the frame's origin cannot hold the digits of a position near zero, so that it
// may be rounded into a box from outside.
TEST_P(Trees, BoxesOfObjectSpaceHoldThePositionsOfTheSource) {
  SourceMesh mesh = test::torus(20, 12);
  mesh.positions.precision = cooker::Precision::kF64;
  for (const float x : mesh.positions.f32) mesh.positions.f64.push_back(1.1 * x + 0.3);
  mesh.positions.f32.clear();
  const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
  ASSERT_NE(BoundTree::of(cooked.tree).frame().origin, Eigen::Vector3d::Zero());
  const std::function<void(const Node&, std::vector<Eigen::AlignedBox3d>)> walk_down =
      [&](const Node& node, std::vector<Eigen::AlignedBox3d> above) {
        above.push_back(BoundTree::of(cooked.tree).to_object(node.box));
        NodeChildren children;
        if (!node.is_leaf) {
          ASSERT_EQ(BoundTree::of(cooked.tree).expand(node, children), NodeState::kValid);
        }
        for (std::uint32_t i = 0; i < children.count; ++i) walk_down(children.child[i], above);
        for (std::uint32_t i = 0; node.is_leaf && i < node.ref.second; ++i) {
          const cooker::Face& face =
              mesh.faces[BoundTree::of(cooked.tree).face_id(node.ref.first + i)];
          for (std::size_t corner = 0; corner < 3; ++corner) {
            for (const Eigen::AlignedBox3d& box : above) {
              ASSERT_TRUE(box.contains(mesh.positions[face.corner[corner]]));
            }
          }
        }
      };
  walk_down(BoundTree::of(cooked.tree).root(), {});
}

INSTANTIATE_TEST_SUITE_P(Codecs, Trees, testing::ValuesIn(test::all_codecs()), test::test_name);

}  // namespace
}  // namespace boxtree
