// SPDX-License-Identifier: MIT
// Exported files of every codec against the source mesh and against a walk of single nodes.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include <gtest/gtest.h>

#include "cooker/import/mesh_arrays.h"
#include "exported.h"
#include "format/tree_record.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "viewer_files.h"

namespace boxtree::cooker {
namespace {

using test::ViewedPart;

class Export : public testing::TestWithParam<CodecId> {};

TEST_P(Export, ReimportedFilesHoldTheFacesOfTheSourceInItsOrder) {
  const test::TempFolder folder;
  for (const SourceMesh& mesh : test::all_kinds()) {
    SCOPED_TRACE(mesh.name);
    const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
    const auto obj = export_one(folder, "out.obj", cooked.tree, triangles_only());
    const SourceMesh again = as_f32(imported(obj, Precision::kF64));
    EXPECT_EQ(faces_of(again), faces_of(mesh));
    EXPECT_EQ(cook_as(again, GetParam())->geometry_hash,
              OpenFile::of(cooked.file).tree_record(0).geometry_hash);
    // Lines are no faces: boxes do not disturb.
    const auto glb = export_one(folder, "out.glb", cooked.tree, {});
    EXPECT_EQ(triangles_of(imported(glb)), triangles_of(mesh));
  }
}

// What a walk by expand() meets, level by level in the order of the children.
struct Walked {
  std::map<std::string, std::vector<Eigen::AlignedBox3d>> boxes;  // of object space, by group
  // For each leaf: its faces, and the boxes on its path as (group, number in it).
  struct Leaf {
    Node node;
    std::vector<std::pair<std::string, std::uint64_t>> path;
  };
  std::vector<Leaf> leaves;
};

void walk(const Tree& tree, const Node& node, std::uint32_t level, Walked::Leaf path, Walked& out) {
  const std::string group = "level " + std::to_string(level);
  const auto add_to = [&](const std::string& name) {
    path.path.emplace_back(name, out.boxes[name].size());
    out.boxes[name].push_back(BoundTree::of(tree).to_object(node.box));
  };
  add_to(group);
  if (node.is_leaf) {
    add_to("leaves");
    path.node = node;
    out.leaves.push_back(path);
    return;
  }
  NodeChildren children;
  ASSERT_EQ(BoundTree::of(tree).expand(node, children), NodeState::kValid);
  for (std::uint32_t i = 0; i < children.count; ++i) {
    walk(tree, children.child[i], level + 1, path, out);
  }
}

Walked walked(const Tree& tree) {
  Walked out;
  if (!tree.empty()) walk(tree, BoundTree::of(tree).root(), 0, {}, out);
  return out;
}

// "level 2" of any part: OBJ names it after its object, too.
std::string group_of(const ViewedPart& part) {
  for (std::string word : {"level", "leaves", "triangles"}) {
    const std::size_t start = part.name.find(word);
    if (start == std::string::npos) continue;
    std::string name = part.name.substr(start);
    std::replace(name.begin(), name.end(), '_', ' ');
    return name;
  }
  return part.name;
}

// As a box rounded outward to f32, and no farther. With positions of f64 in OBJ, the box itself.
void expect_rounded_outward(const ViewedPart& part, std::uint64_t i, const Eigen::AlignedBox3d& box,
                            bool is_f32) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  const Eigen::AlignedBox3d seen = part.box(i);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    const double low = box.min()[axis] - part.translation[axis];
    const double high = box.max()[axis] - part.translation[axis];
    if (!is_f32) {
      ASSERT_EQ(seen.min()[axis], low);
      ASSERT_EQ(seen.max()[axis], high);
      continue;
    }
    const auto seen_low = static_cast<float>(seen.min()[axis]);
    const auto seen_high = static_cast<float>(seen.max()[axis]);
    ASSERT_LE(seen_low, low);
    ASSERT_GT(std::nextafter(seen_low, kInfinity), low);
    ASSERT_GE(seen_high, high);
    ASSERT_LT(std::nextafter(seen_high, -kInfinity), high);
  }
}

// Every part is there, has the boxes of the walk, and every triangle lies in every box above.
void expect_boxes_around_triangles(const Tree& tree, const std::filesystem::path& path) {
  const Walked walk = walked(tree);
  std::map<std::string, ViewedPart> parts;
  for (ViewedPart& part : test::read_viewer_file(path)) parts[group_of(part)] = std::move(part);
  ASSERT_EQ(parts.size(), walk.boxes.size() + 1);
  const bool is_f32 = path.extension() == ".glb" || has_f32_positions(tree);
  for (const auto& [group, boxes] : walk.boxes) {
    const ViewedPart& part = parts.at(group);
    ASSERT_EQ(part.box_count(), boxes.size()) << group;
    EXPECT_EQ(part.elements.size(), 12 * boxes.size()) << group;
    EXPECT_TRUE(part.has_lines);
    for (std::uint64_t i = 0; i < boxes.size(); ++i) {
      expect_rounded_outward(part, i, boxes[i], is_f32);
    }
  }
  // In tree order faces are exported as the leaves number them. A quad is one element in OBJ and
  // two in GLB.
  const ViewedPart& triangles = parts.at("triangles");
  std::map<std::uint32_t, std::vector<std::size_t>> elements_of_face;
  std::size_t element = 0;
  for (std::uint32_t f = 0; f < tree.face_count(); ++f) {
    TriangleBatch batch;
    ASSERT_EQ(BoundTree::of(tree).leaf_triangles({{}, {f, 1}, true}, batch), Errc::kOk);
    const bool is_split = batch.count == 2 && triangles.elements.at(element).size() == 3;
    for (int i = 0; i < (is_split ? 2 : 1); ++i) elements_of_face[f].push_back(element++);
  }
  ASSERT_EQ(element, triangles.elements.size());
  for (const Walked::Leaf& leaf : walk.leaves) {
    for (std::uint32_t i = 0; i < leaf.node.ref.second; ++i) {
      for (const std::size_t e : elements_of_face.at(leaf.node.ref.first + i)) {
        for (const std::uint32_t corner : triangles.elements[e]) {
          for (const auto& [group, number] : leaf.path) {
            ASSERT_TRUE(parts.at(group).box(number).contains(triangles.vertices[corner]))
                << group << ", box " << number << ", element " << e;
          }
        }
      }
    }
  }
}

TEST_P(Export, HoldsTheBoxesOfAWalkAndTheyHoldTheTriangles) {
  const test::TempFolder folder;
  ExportOptions options = everything();
  options.order = ExportOrder::kTree;
  for (const SourceMesh& mesh : test::all_kinds()) {
    const std::vector<std::pair<const char*, test::CookedTree>> variants = [&] {
      std::vector<std::pair<const char*, test::CookedTree>> trees;
      trees.emplace_back("exact", test::cook_tree(mesh, GetParam()));
      trees.emplace_back("grid", test::cook_tree(mesh, GetParam(), on_grid(12)));
      trees.emplace_back("far",
                         test::cook_tree(far_away(mesh, 1e-3, {6.4e6, -6.4e6, 1.5e6}), GetParam()));
      // The frame's origin is not zero although the mesh has positions near zero, whose digits a
      // difference from that origin cannot hold.
      trees.emplace_back("around zero",
                         test::cook_tree(far_away(mesh, 1.1, {0.3, 0.7, 1e-9}), GetParam()));
      return trees;
    }();
    for (const auto& [variant, cooked] : variants) {
      for (const char* name : {"out.obj", "out.glb"}) {
        SCOPED_TRACE(mesh.name + ", " + variant + ", " + name);
        expect_boxes_around_triangles(cooked.tree, export_one(folder, name, cooked.tree, options));
      }
    }
  }
}

TEST_P(Export, ReportsWhatItWrote) {
  const test::TempFolder folder;
  const SourceMesh mesh = test::city(24, 2);
  const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
  ExportOptions options;
  options.levels = {{2, 2}, {1, 2}};
  options.leaves = true;
  ExportReport report;
  const auto path = export_one(folder, "out.glb", cooked.tree, options, &report);
  ASSERT_EQ(report.trees.size(), 1u);
  const ExportedTree& tree = report.trees[0];
  EXPECT_EQ(tree.name, "city");
  EXPECT_EQ(tree.faces, mesh.faces.size());
  EXPECT_EQ(tree.triangles, mesh.triangle_count());
  Walked walk = walked(cooked.tree);
  std::vector<std::string> groups;
  for (const BoxGroup& group : tree.boxes) {
    groups.push_back(group.name());
    EXPECT_EQ(group.count, walk.boxes.at(group.name()).size());
  }
  EXPECT_EQ(groups, (std::vector<std::string>{"level 1", "level 2", "leaves"}));
  const std::vector<ViewedPart> parts = test::read_viewer_file(path);
  ASSERT_EQ(parts.size(), 4u);
  EXPECT_EQ(parts[0].elements.size(), tree.triangles);
}

TEST_P(Export, GridPointsAreWhatATreeDecodes) {
  const test::TempFolder folder;
  for (const SourceMesh& mesh : {test::city(24, 2), test::soup(300, 3)}) {
    for (const int bits : {8, 16, 24}) {
      SCOPED_TRACE(mesh.name + ", " + std::to_string(bits));
      const test::CookedTree cooked = test::cook_tree(mesh, GetParam(), on_grid(bits));
      // Multiples of the step, as the grid's origin is one: what import rounded here, face by face.
      const double step = std::ldexp(1.0, BoundTree::of(cooked.tree).grid_exponent());
      SourceMesh rounded = far_away(mesh, 1, Eigen::Vector3d::Zero());
      for (double& x : rounded.positions.f64) x = std::floor(x / step + 0.5) * step;
      const auto obj = export_one(folder, "out.obj", cooked.tree, triangles_only());
      EXPECT_EQ(triangles_of(imported(obj, Precision::kF64)), triangles_of(rounded));
      // Translation and f32 positions together hold 24 bits.
      const auto glb = export_one(folder, "out.glb", cooked.tree, triangles_only());
      EXPECT_EQ(triangles_of(imported(glb, Precision::kF64)), triangles_of(rounded));
    }
  }
}

TEST_P(Export, FarFromTheOriginPrecisionSurvives) {
  const test::TempFolder folder;
  const SourceMesh far = far_away(test::torus(20, 12), 1e-3, {6.4e6, -6.4e6, 1.5e6});
  const test::CookedTree cooked = test::cook_tree(far, GetParam());
  const auto obj = export_one(folder, "out.obj", cooked.tree, triangles_only());
  EXPECT_EQ(faces_of(imported(obj, Precision::kF64)), faces_of(far));
  ExportReport report;
  const auto glb = export_one(folder, "out.glb", cooked.tree, triangles_only(), &report);
  const ViewedPart part = test::read_viewer_file(glb).at(0);
  EXPECT_EQ(part.translation, report.trees[0].translation);
  for (const double t : part.translation) EXPECT_EQ(t, static_cast<float>(t));
  ASSERT_EQ(part.elements.size(), far.faces.size());
  for (std::size_t f = 0; f < far.faces.size(); ++f) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Eigen::Vector3d seen = part.vertices[part.elements[f][c]] + part.translation;
      // The translation is an f32, here up to a quarter off the middle; f32 tells positions as far
      // from it 3e-8 apart, but 0.5 without it.
      EXPECT_LT((seen - far.positions[far.faces[f].corner[c]]).norm(), 1e-7);
    }
  }
}

TEST_P(Export, WithoutFaceIdsTheOrderIsTheTrees) {
  const test::TempFolder folder;
  const SourceMesh mesh = test::soup(100, 3);
  CookOptions options;
  options.face_ids = false;
  const test::CookedTree cooked = test::cook_tree(mesh, GetParam(), options);
  std::vector<FaceBits> faces =
      faces_of(imported(export_one(folder, "out.obj", cooked.tree, triangles_only())));
  std::vector<FaceBits> expected = faces_of(mesh);
  EXPECT_NE(faces, expected);
  std::sort(faces.begin(), faces.end());
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(faces, expected);
  ExportOptions in_source_order = triangles_only();
  in_source_order.order = ExportOrder::kSource;
  EXPECT_EQ(
      export_trees(std::span(&cooked.tree, 1), folder.path() / "no.obj", in_source_order).code(),
      Errc::kPartLeftOut);
}

TEST_P(Export, ExternalGeometryComesFromItsMesh) {
  const test::TempFolder folder;
  const SourceMesh mesh = test::torus(20, 12);
  CookOptions options;
  options.geometry = GeometryId::kExternal;
  BindOptions bind;
  bind.mesh = arrays_of(mesh);
  const test::CookedTree cooked = test::cook_tree(mesh, GetParam(), options, bind);
  const test::CookedTree stored = test::cook_tree(mesh, GetParam());
  const auto exported = export_one(folder, "out.obj", cooked.tree, triangles_only());
  EXPECT_EQ(faces_of(as_f32(imported(exported, Precision::kF64))), faces_of(mesh));
  // The order of the tree is the leaves': the first leaf's faces come first, unless leaves name
  // faces by their number in the source.
  ExportOptions in_tree_order = triangles_only();
  in_tree_order.order = ExportOrder::kTree;
  const SourceMesh in_order =
      as_f32(imported(export_one(folder, "tree.obj", cooked.tree, in_tree_order), Precision::kF64));
  for (std::uint32_t f = 0; f < mesh.faces.size(); ++f) {
    ASSERT_EQ(bits_of(in_order, in_order.faces[f]),
              bits_of(mesh, mesh.faces[BoundTree::of(cooked.tree).face_id(f)]));
  }
  // Boxes need no mesh.
  bind.mesh = absent_arrays(OpenFile::of(cooked.file).tree_record(0));
  const Tree boxes_only = test::require(Tree::bind(cooked.file, 0, bind));
  ExportOptions boxes = everything();
  boxes.triangles = false;
  const auto without = export_one(folder, "boxes.obj", boxes_only, boxes);
  const auto with = export_one(folder, "stored.obj", stored.tree, boxes);
  if (is_wide(GetParam())) {  // others number the faces otherwise, which may widen fields
    EXPECT_EQ(test::read_text(without), test::read_text(with));
  }
  for (const ViewedPart& part : test::read_viewer_file(without)) {
    EXPECT_EQ(part.box_count(), walked(boxes_only).boxes.at(group_of(part)).size());
  }
}

INSTANTIATE_TEST_SUITE_P(Codecs, Export, testing::ValuesIn(test::all_codecs()), test::test_name);

}  // namespace
}  // namespace boxtree::cooker
