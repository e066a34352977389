// SPDX-License-Identifier: MIT
// Trees by the C interface: what is known of them is what the C++ interface says.
#include <boxtree_c.h>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/unit/c/copied_text.h"
#include "tests/unit/c/subjects.h"

namespace boxtree {
namespace {

using test::Answer;
using test::answer_of_c;
using test::Numbers;
using test::numbers_of;

TEST(CTrees, AreWhatCppSays) {
  std::size_t triangles = 0, materials = 0, numbers = 0;
  test::for_each_tree([&](const Tree& tree, const bxt_tree* c_tree) {
    EXPECT_EQ(
        test::copied_text([&](char* b, std::size_t n) { return bxt_tree_name(c_tree, b, n); }),
        tree.name());
    EXPECT_EQ(test::copied_text(
                  [&](char* b, std::size_t n) { return bxt_tree_codec_name(c_tree, b, n); }),
              tree.codec_name());
    EXPECT_EQ(bxt_tree_face_count(c_tree), tree.face_count());
    EXPECT_EQ(bxt_tree_triangle_count(c_tree), tree.triangle_count());
    EXPECT_EQ(bxt_tree_has_face_ids(c_tree), tree.has_face_ids());
    EXPECT_EQ(bxt_tree_has_active_edges(c_tree), tree.has_active_edges());
    EXPECT_EQ(bxt_tree_has_user_data(c_tree), tree.has_user_data());
    bxt_vec3 min, max;
    ASSERT_TRUE(bxt_tree_bounds(c_tree, &min, &max));
    EXPECT_EQ(Numbers() << min << max, Numbers() << tree.bounds().min() << tree.bounds().max());
    EXPECT_EQ(bxt_tree_prefetch(c_tree, 3), tree.prefetch(3));
    EXPECT_EQ(bxt_tree_material_count(c_tree), tree.material_count());
    for (std::uint32_t i = 0; i <= tree.material_count(); ++i) {
      EXPECT_EQ(test::copied_text([&](char* b, std::size_t n) {
                  return bxt_tree_material_name(c_tree, i, b, n);
                }),
                tree.material_name(i));
    }
    for (std::uint32_t f = 0; f <= tree.face_count(); ++f) {
      const FaceRef face{f * 3 + 1, f};
      const bxt_face c_face = {face.id, face.index, BXT_NO_INSTANCE};
      EXPECT_EQ(bxt_tree_material(c_tree, &c_face), tree.material(face));
      materials += tree.material(face) != kNoMaterial;
      std::uint32_t data = 123;
      const std::optional<std::uint32_t> expected_data = tree.user_data(face);
      EXPECT_EQ(bxt_tree_user_data(c_tree, &c_face, &data), expected_data.has_value());
      EXPECT_EQ(data, expected_data.value_or(123));
      numbers += expected_data.has_value();
      for (std::uint32_t half = 0; half < 3; ++half) {
        const Result<Triangle> triangle = tree.triangle(face, half);
        Answer expected;
        note_error(triangle, expected);
        if (triangle) expected.found.push_back(numbers_of(*triangle));
        triangles += triangle.ok();
        ASSERT_EQ(answer_of_c([&](bxt_error* error, std::vector<Numbers>& found) {
                    bxt_triangle told = {};
                    const bxt_status status =
                        bxt_tree_triangle(c_tree, &c_face, half, &told, error);
                    if (status == BXT_OK) found.push_back(numbers_of(told));
                    return status;
                  }),
                  expected);
        const Result<std::uint32_t> edges = active_edges(tree, face, half);
        Answer expected_edges;
        note_error(edges, expected_edges);
        if (edges) expected_edges.found.push_back(Numbers() << *edges);
        ASSERT_EQ(answer_of_c([&](bxt_error* error, std::vector<Numbers>& found) {
                    std::uint32_t told = 99;
                    const bxt_status status =
                        bxt_tree_active_edges(c_tree, &c_face, half, &told, error);
                    if (status == BXT_OK) found.push_back(Numbers() << told);
                    return status;
                  }),
                  expected_edges);
      }
    }
  });
  EXPECT_GT(triangles, 100u);
  EXPECT_GT(materials, 10u);
  EXPECT_GT(numbers, 10u);
}

TEST(CTrees, EmptyOnesHaveNoBounds) {
  const std::vector<std::byte> bytes = test::cook_bytes(cooker::SourceMesh(), CodecId::kWide8);
  const test::CFile file = test::open_c(bytes);
  const test::CTree tree = test::bind_c(file);
  bxt_vec3 min = {1, 2, 3}, max = {4, 5, 6};
  EXPECT_FALSE(bxt_tree_bounds(tree.get(), &min, &max));
  EXPECT_EQ(min.y, 2);
  EXPECT_EQ(max.z, 6);
  EXPECT_EQ(bxt_tree_face_count(tree.get()), 0u);
}

// What is required, and what is not there, is refused as by C++.
TEST(CTrees, AreBoundAsByCpp) {
  cooker::CookOptions bare;
  bare.face_ids = false;
  cooker::CookOptions outside;
  outside.geometry = GeometryId::kExternal;
  const std::vector<std::vector<std::byte>> files = {
      test::cook_bytes(test::city(2, 1), CodecId::kWide8),
      test::cook_bytes(test::city(2, 1), CodecId::kWide8, bare),
      test::cook_bytes(test::city(2, 1), CodecId::kWide8, outside)};
  std::size_t refused = 0;
  for (const std::vector<std::byte>& bytes : files) {
    const File file = test::require(File::open(Bytes(bytes)));
    const test::CFile c_file = test::open_c(bytes);
    for (int requirement = 0; requirement < 5; ++requirement) {
      BindOptions options;
      bxt_tree_options c = {};
      c.struct_size = sizeof c;
      c.require_face_ids = options.require_face_ids = requirement == 1;
      c.require_active_edges = options.require_active_edges = requirement == 2;
      c.require_materials = options.require_materials = requirement == 3;
      c.require_user_data = options.require_user_data = requirement == 4;
      for (const std::uint32_t number : {0u, 1u, std::uint32_t{BXT_ONLY_TREE}}) {
        const Result<Tree> bound =
            number == BXT_ONLY_TREE ? Tree::bind(file, options) : Tree::bind(file, number, options);
        Answer expected;
        note_error(bound, expected);
        refused += !bound.ok();
        ASSERT_EQ(answer_of_c([&](bxt_error* error, std::vector<Numbers>&) {
                    bxt_tree* tree = nullptr;
                    const bxt_status status = bxt_tree_bind(
                        c_file.get(), number, requirement == 0 ? nullptr : &c, &tree, error);
                    EXPECT_EQ(tree != nullptr, status == BXT_OK);
                    bxt_tree_release(tree);
                    return status;
                  }),
                  expected);
      }
    }
  }
  EXPECT_GT(refused, 20u);
  // Codecs of the paper are left out of the C library.
  const std::vector<std::byte> packed = test::cook_bytes(test::city(2, 1), CodecId::kPackedF32);
  const test::CFile c_packed = test::open_c(packed);
  bxt_tree* tree = nullptr;
  EXPECT_EQ(bxt_tree_bind(c_packed.get(), 0, nullptr, &tree, nullptr), BXT_CODEC_UNSUPPORTED);
}

TEST(CTrees, ExternalMeshesThatDifferAreRefused) {
  cooker::CookOptions outside;
  outside.geometry = GeometryId::kExternal;
  const test::SourceMesh mesh = test::torus(6, 5);
  const std::vector<std::byte> bytes = test::cook_bytes(mesh, CodecId::kWide8, outside);
  const test::CFile file = test::open_c(bytes);
  std::vector<float> positions = mesh.positions.f32;
  std::vector<std::uint32_t> corners;
  for (const cooker::Face& face : mesh.faces) {
    corners.insert(corners.end(), face.corner.begin(), face.corner.begin() + 3);
  }
  bxt_mesh arrays = {};
  arrays.struct_size = sizeof arrays;
  arrays.positions = positions.data();
  arrays.position_stride = 12;
  arrays.vertex_count = static_cast<std::uint32_t>(positions.size() / 3);
  arrays.corners = corners.data();
  arrays.corner_bytes = 4;
  arrays.corners_per_face = 3;
  arrays.face_count = static_cast<std::uint32_t>(mesh.faces.size());
  bxt_tree_options options = {};
  options.struct_size = sizeof options;
  options.mesh = &arrays;
  options.verify_mesh = true;
  EXPECT_NE(test::bind_c(file, 0, &options), nullptr);
  positions[4] += 1;
  bxt_tree* tree = nullptr;
  EXPECT_EQ(bxt_tree_bind(file.get(), 0, &options, &tree, nullptr), BXT_EXTERNAL_MESH_MISMATCH);
  EXPECT_EQ(bxt_tree_bind(file.get(), 0, nullptr, &tree, nullptr), BXT_EXTERNAL_MESH_NEEDED);
  arrays.struct_size = 8;
  EXPECT_EQ(bxt_tree_bind(file.get(), 0, &options, &tree, nullptr), BXT_INVALID_QUERY);
  EXPECT_EQ(tree, nullptr);
}

}  // namespace
}  // namespace boxtree
