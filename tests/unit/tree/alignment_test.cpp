// SPDX-License-Identifier: MIT
// Files in memory of any alignment, and arrays of an application likewise: the same answers, to the
// bit. UndefinedBehaviorSanitizer watches it in the builds with sanitizers.
#include <cstring>
#include <vector>

#include <gtest/gtest.h>

#include "cooker/import/mesh_arrays.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/scenes.h"

namespace boxtree {
namespace {

// The bytes at every place of a cache line that is no multiple of their alignment, and at some that
// are multiples of 2 and 4 alone.
constexpr std::size_t kOffsets[] = {1, 2, 3, 4, 5, 7, 9, 15, 31, 63};

std::vector<std::byte> moved(const std::vector<std::byte>& bytes, std::size_t offset) {
  std::vector<std::byte> place(bytes.size() + offset);
  std::memcpy(place.data() + offset, bytes.data(), bytes.size());
  return place;
}

template <class... Numbers>
void add(std::vector<double>& all, Numbers... numbers) {
  (all.push_back(static_cast<double>(numbers)), ...);
}

// All that queries answer of a tree, as numbers.
std::vector<double> answers(const Tree& tree) {
  std::vector<double> all;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d at(0.9 * i - 3, 0.7 * i - 2, 0.1 * i);
    const auto hit =
        test::require(closest_hit(tree, {at + Eigen::Vector3d(0, 0, 20), {0.01, 0.02, -1}}));
    if (hit) add(all, hit->t, hit->face.id, hit->u, hit->v);
    const auto any =
        test::require(any_hit(tree, {at - Eigen::Vector3d(20, 0, 0), {1, 0.03, 0.01}}));
    add(all, any ? any->face.id : kNoFaceId);
    const auto touch = test::require(
        cast_closest(tree, Sphere{at + Eigen::Vector3d(0, 0, 20), 0.3}, Motion{{0.01, 0.02, -1}}));
    if (touch) add(all, touch->t, touch->t_lower, touch->face.id);
    const auto closest = test::require(closest_point(tree, at));
    if (closest) add(all, closest->distance, closest->face.id);
    const auto keep = [&](const FaceRef& face) {
      add(all, face.id);
      return true;
    };
    static_cast<void>(
        test::require(overlap_box(tree, {at, at + Eigen::Vector3d::Constant(0.8)}, keep)));
    static_cast<void>(test::require(overlap_sphere(tree, at, 0.7, keep)));
  }
  Pose turned = Pose::Identity();
  turned.rotate(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  const auto keep = [&](const FacePair& pair) {
    add(all, pair.first.id, pair.second.id);
    return true;
  };
  static_cast<void>(test::require(overlap_pairs(tree, Pose::Identity(), tree, turned, keep)));
  turned.translation() = Eigen::Vector3d(9, 1, 2);
  const Distance apart = test::require(distance(tree, Pose::Identity(), tree, turned));
  add(all, apart.lower, apart.upper);
  return all;
}

class Alignment : public testing::TestWithParam<test::Encoding> {};

TEST_P(Alignment, OfAFileChangesNoAnswer) {
  for (const cooker::SourceMesh& mesh : {test::torus(24, 12), test::city(8, 2)}) {
    const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
    const std::vector<double> expected = answers(cooked.tree);
    for (const std::size_t offset : kOffsets) {
      const std::vector<std::byte> place = moved(cooked.bytes, offset);
      const File file = test::require(File::open(Bytes(place).subspan(offset)));
      EXPECT_EQ(answers(test::require(Tree::bind(file))), expected) << offset;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Encodings, Alignment, testing::ValuesIn(test::all_encodings()),
                         test::encoding_name);

TEST(AlignmentOfMeshes, OfAnApplicationChangesNoAnswer) {
  const cooker::SourceMesh mesh = test::torus(24, 12);
  for (const CodecId codec : test::all_codecs()) {
    cooker::CookOptions options;
    options.geometry = GeometryId::kExternal;
    BindOptions bind;
    bind.mesh = cooker::arrays_of(mesh);
    const test::CookedTree cooked = test::cook_tree(mesh, codec, options, bind);
    const std::vector<double> expected = answers(cooked.tree);
    const MeshArrays& arrays = *bind.mesh;
    const std::size_t position_bytes = arrays.vertex_count * arrays.position_stride;
    const std::size_t corner_bytes =
        std::size_t{arrays.face_count} * arrays.corners_per_face * arrays.corner_bytes;
    for (const std::size_t offset : kOffsets) {
      std::vector<std::byte> place(offset + position_bytes + 1 + corner_bytes);
      std::memcpy(place.data() + offset, arrays.positions, position_bytes);
      std::byte* const corners = place.data() + offset + position_bytes + 1;
      std::memcpy(corners, arrays.corners, corner_bytes);
      bind.mesh->positions = place.data() + offset;
      bind.mesh->corners = corners;
      const Tree tree = test::require(Tree::bind(cooked.file, 0, bind));
      EXPECT_EQ(answers(tree), expected) << codec_name(codec) << ", " << offset;
      bind.mesh = cooker::arrays_of(mesh);
    }
  }
}

TEST(AlignmentOfScenes, ChangesNoAnswer) {
  const test::CookedScene cooked =
      test::cook_scene({test::torus(24, 12), test::city(8, 2)}, test::random_parts(30, 2, 4, 2, 1));
  const auto scene_answers = [](const File& file) {
    const Scene scene = test::require(Scene::bind(file));
    std::vector<double> all;
    const auto keep = [&](const SceneFace& face) {
      add(all, face.instance, face.face.id);
      return true;
    };
    for (int i = 0; i < 8; ++i) {
      const Eigen::Vector3d at(3.0 * i - 9, 2.0 * i - 7, 0.5 * i);
      const auto hit =
          test::require(closest_hit(scene, {at - Eigen::Vector3d(90, 0, 0), {1, 0.02, 0.01}}));
      if (hit) add(all, hit->t, hit->instance, hit->face.id);
      const auto closest = test::require(closest_point(scene, at));
      if (closest) all.push_back(closest->distance);
      static_cast<void>(
          test::require(overlap_box(scene, {at, at + Eigen::Vector3d::Constant(4)}, keep)));
      static_cast<void>(test::require(overlap_sphere(scene, at, 3, keep)));
    }
    static_cast<void>(test::require(contacts(
        scene, [&](const ScenePair& pair) { return keep(pair.first) && keep(pair.second); })));
    return all;
  };
  const std::vector<double> expected = scene_answers(cooked.file);
  EXPECT_GT(expected.size(), 100u);
  for (const std::size_t offset : kOffsets) {
    const std::vector<std::byte> place = moved(cooked.bytes, offset);
    EXPECT_EQ(scene_answers(test::require(File::open(Bytes(place).subspan(offset)))), expected)
        << offset;
  }
}

}  // namespace
}  // namespace boxtree
