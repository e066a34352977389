// SPDX-License-Identifier: MIT
// Records of trees and scenes: at each limit they are accepted, a step beyond they are refused.
#include <algorithm>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include "format/limits.h"
#include "format/scene_record.h"
#include "format/tree_record.h"
#include "tests/support/infinity.h"

namespace boxtree {
namespace {

using test::kInfinity;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

TreeRecord sound_tree() {
  TreeRecord record{};
  record.codec = CodecId::kWide8;
  record.geometry = GeometryId::kArrays;
  record.face_count = record.triangle_count = 100;
  record.node_count = 60;  // enough for so many faces in every codec
  record.root = RootKind::kSubtree;
  record.depth = 2;
  record.corner_bytes = 2;
  record.corners_per_face = 3;
  record.root_high = {1, 1, 1};
  return record;
}

SceneRecord sound_scene() {
  SceneRecord record{};
  record.instance_count = 10;
  record.static_count = 9;
  record.node_count = 2;
  record.root = RootKind::kSubtree;
  record.depth = 2;
  record.pose_bytes = 4;
  record.layer_count = 1;
  record.root_high = {1, 1, 1};
  record.condition = 3;
  return record;
}

Errc tree_after(const std::function<void(TreeRecord&)>& change) {
  TreeRecord record = sound_tree();
  change(record);
  return check_tree_record(record, 0).code();
}

Errc scene_after(const std::function<void(SceneRecord&)>& change) {
  SceneRecord record = sound_scene();
  change(record);
  return check_scene_record(record).code();
}

constexpr Errc kOk = Errc::kOk;
constexpr Errc kInvalid = Errc::kRecordInvalid;

TEST(TreeRecords, DepthHasTheLimitOfTheCodec) {
  const auto with_depth = [](CodecId codec, std::uint32_t depth) {
    return tree_after([=](TreeRecord& record) {
      record.codec = codec;
      record.depth = static_cast<std::uint8_t>(depth);
    });
  };
  EXPECT_EQ(with_depth(CodecId::kWide8, kMaxWideDepth), kOk);
  EXPECT_EQ(with_depth(CodecId::kWide8, kMaxWideDepth + 1), kInvalid);
  EXPECT_EQ(with_depth(CodecId::kWide4, kMaxWideDepth + 1), kInvalid);
  EXPECT_EQ(with_depth(CodecId::kPlainF32, kMaxDepth), kOk);
  EXPECT_EQ(with_depth(CodecId::kPlainF32, kMaxDepth + 1), kInvalid);
}

// A newer format may set them: that is not a damaged file.
TEST(TreeRecords, UnknownFlagsAreUnsupportedNotInvalid) {
  for (const int bit : {2, 7}) {
    EXPECT_EQ(tree_after(
                  [=](TreeRecord& record) { record.flags |= static_cast<std::uint8_t>(1 << bit); }),
              Errc::kFeatureUnsupported);
  }
}

TEST(TreeRecords, CountsKeepTheirLimits) {
  const auto with_faces = [](std::uint32_t faces, std::uint32_t triangles) {
    return tree_after([=](TreeRecord& record) {
      record.face_count = faces;
      record.triangle_count = triangles;
      record.node_count = std::max(record.node_count, faces / kLeafFaces);
    });
  };
  EXPECT_EQ(with_faces(100, 99), kInvalid);
  EXPECT_EQ(with_faces(100, 200), kOk);
  EXPECT_EQ(with_faces(100, 201), kInvalid);
  EXPECT_EQ(with_faces(kMaxFaces, kMaxFaces), kOk);
  EXPECT_EQ(with_faces(kMaxFaces + 1, kMaxFaces + 1), kInvalid);
  EXPECT_EQ(tree_after([](TreeRecord& record) { record.node_count = kMaxNodes; }), kOk);
  EXPECT_EQ(tree_after([](TreeRecord& record) { record.node_count = kMaxNodes + 1; }), kInvalid);
}

TEST(TreeRecords, DuplicatesHaveAnOriginalAndAWidth) {
  const auto with_duplicates = [](std::uint32_t count, int bytes, std::uint8_t flags = 0) {
    return tree_after([=](TreeRecord& record) {
      record.duplicate_count = count;
      record.duplicate_bytes = static_cast<std::uint8_t>(bytes);
      record.flags = flags;
    });
  };
  for (const int bytes : {1, 2, 4}) {
    EXPECT_EQ(with_duplicates(99, bytes), kOk);
    EXPECT_EQ(with_duplicates(0, bytes), kInvalid);
    EXPECT_EQ(with_duplicates(100, bytes), kInvalid);
    EXPECT_EQ(with_duplicates(101, bytes), kInvalid);
    EXPECT_EQ(with_duplicates(1, bytes, kTreeFacesInSourceOrder), kOk);
  }
  for (const int bytes : {0, 3, 5, 8}) EXPECT_EQ(with_duplicates(1, bytes), kInvalid) << bytes;
}

TEST(TreeRecords, ErrorsAreFiniteAndTrianglesWithoutAreaAreTriangles) {
  for (const double bad : {kNaN, kInfinity, -1.0}) {
    EXPECT_EQ(tree_after([=](TreeRecord& record) { record.max_vertex_error = bad; }), kInvalid);
  }
  EXPECT_EQ(tree_after([](TreeRecord& record) { record.degenerate_count = 100; }), kOk);
  EXPECT_EQ(tree_after([](TreeRecord& record) { record.degenerate_count = 101; }), kInvalid);
}

TEST(TreeRecords, FramesAreFiniteAndOrdered) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (const double bad : {kNaN, kInfinity, -kInfinity}) {
      EXPECT_EQ(tree_after([=](TreeRecord& record) { record.origin[k] = bad; }), kInvalid);
      EXPECT_EQ(tree_after([=](TreeRecord& record) { record.root_low[k] = bad; }), kInvalid);
      EXPECT_EQ(tree_after([=](TreeRecord& record) { record.root_high[k] = bad; }), kInvalid);
    }
    const auto with_box = [k](double low, double high) {
      return tree_after([=](TreeRecord& record) {
        record.root_low[k] = low;
        record.root_high[k] = high;
      });
    };
    EXPECT_EQ(with_box(1, 1), kOk);
    EXPECT_EQ(with_box(1, 0.5), kInvalid);
    EXPECT_EQ(with_box(-kMaxRootCoordinate, kMaxRootCoordinate), kOk);
    EXPECT_EQ(with_box(-2 * kMaxRootCoordinate, 0), kInvalid);
    EXPECT_EQ(with_box(0, 2 * kMaxRootCoordinate), kInvalid);
  }
  const auto with_scale = [](int scale) {
    return tree_after(
        [=](TreeRecord& record) { record.scale_exponent = static_cast<std::int16_t>(scale); });
  };
  for (const int sign : {-1, 1}) {
    EXPECT_EQ(with_scale(sign * kMaxScaleExponent), kOk);
    EXPECT_EQ(with_scale(sign * (kMaxScaleExponent + 1)), kInvalid);
  }
}

// Their magnitude is no int16: std::abs of the least one is undefined.
TEST(TreeRecords, TheLeastExponentsAreRefused) {
  constexpr std::int16_t kLeast = std::numeric_limits<std::int16_t>::min();
  EXPECT_EQ(tree_after([](TreeRecord& record) { record.scale_exponent = kLeast; }), kInvalid);
  const auto with_grid = [](int grid, int scale) {
    return tree_after([=](TreeRecord& record) {
      record.geometry = GeometryId::kGrid;
      record.corner_bytes = 0;
      record.grid_exponent = static_cast<std::int16_t>(grid);
      record.scale_exponent = static_cast<std::int16_t>(scale);
    });
  };
  EXPECT_EQ(with_grid(3, 3), kOk);
  EXPECT_EQ(with_grid(kLeast, 3), kInvalid);
  EXPECT_EQ(with_grid(3, kLeast), kInvalid);
  EXPECT_EQ(with_grid(kMaxScaleExponent, -kMaxScaleExponent), kInvalid);
  EXPECT_EQ(scene_after([](SceneRecord& record) { record.scale_exponent = kLeast; }), kInvalid);
}

// Boxes of instances are taken less the origin: it has to be a number in units of the scene.
TEST(SceneRecords, OriginsAreFiniteInUnitsOfTheScene) {
  const auto with_origin = [](double origin, std::int32_t scale) {
    return scene_after([=](SceneRecord& record) {
      record.origin = {0, origin, 0};
      record.scale_exponent = scale;
    });
  };
  EXPECT_EQ(with_origin(1e300, 900), kOk);
  EXPECT_EQ(with_origin(1e300, 0), kOk);
  EXPECT_EQ(with_origin(1e300, -900), kInvalid);
  EXPECT_EQ(with_origin(-1e300, -kMaxScaleExponent), kInvalid);
}

TEST(SceneRecords, CountsKeepTheirLimits) {
  EXPECT_EQ(scene_after([](SceneRecord& record) { record.instance_count = kMaxInstances; }), kOk);
  EXPECT_EQ(scene_after([](SceneRecord& record) { record.instance_count = kMaxInstances + 1; }),
            kInvalid);
  EXPECT_EQ(scene_after([](SceneRecord& record) { record.static_count = 10; }), kOk);
  EXPECT_EQ(scene_after([](SceneRecord& record) { record.static_count = 11; }), kInvalid);
  EXPECT_EQ(scene_after([](SceneRecord& record) { record.node_count = 9; }), kOk);
  EXPECT_EQ(scene_after([](SceneRecord& record) { record.node_count = 10; }), kInvalid);
  EXPECT_EQ(scene_after([](SceneRecord& record) { record.depth = kMaxWideDepth; }), kOk);
  EXPECT_EQ(scene_after([](SceneRecord& record) { record.depth = kMaxWideDepth + 1; }), kInvalid);
  EXPECT_EQ(scene_after([](SceneRecord& record) { record.layer_count = 0; }), kInvalid);
  EXPECT_EQ(scene_after([](SceneRecord& record) { record.layer_count = kMaxLayers; }), kOk);
  EXPECT_EQ(scene_after([](SceneRecord& record) { record.layer_count = kMaxLayers + 1; }),
            kInvalid);
  EXPECT_EQ(scene_after([](SceneRecord& record) { record.query_kinds = kAllQueries; }), kOk);
  EXPECT_EQ(scene_after([](SceneRecord& record) { record.query_kinds = kAllQueries + 1; }),
            kInvalid);
  for (std::uint8_t bytes = 0; bytes < 10; ++bytes) {
    EXPECT_EQ(scene_after([=](SceneRecord& record) { record.pose_bytes = bytes; }),
              bytes == 4 || bytes == 8 ? kOk : kInvalid)
        << int{bytes};
  }
}

TEST(SceneRecords, RootIsWhatTheCountsSay) {
  const auto with_root = [](RootKind root, std::uint32_t instances, std::uint32_t nodes) {
    return scene_after([=](SceneRecord& record) {
      record.root = root;
      record.static_count = instances;
      record.node_count = nodes;
    });
  };
  EXPECT_EQ(with_root(RootKind::kEmpty, 0, 0), kOk);
  EXPECT_EQ(with_root(RootKind::kEmpty, 1, 0), kInvalid);
  EXPECT_EQ(with_root(RootKind::kEmpty, 1, 1), kInvalid);
  EXPECT_EQ(with_root(RootKind::kLeaf, 1, 0), kOk);
  EXPECT_EQ(with_root(RootKind::kLeaf, 0, 0), kInvalid);
  EXPECT_EQ(with_root(RootKind::kLeaf, 2, 0), kInvalid);
  EXPECT_EQ(with_root(RootKind::kLeaf, 1, 1), kInvalid);
  EXPECT_EQ(with_root(RootKind::kSubtree, 2, 1), kOk);
  EXPECT_EQ(with_root(RootKind::kSubtree, 2, 0), kInvalid);
  EXPECT_EQ(with_root(RootKind::kSubtree, 0, 0), kInvalid);
  EXPECT_EQ(with_root(static_cast<RootKind>(3), 2, 1), kInvalid);
}

TEST(SceneRecords, FramesAreFiniteAndOrdered) {
  for (std::size_t k = 0; k < 3; ++k) {
    for (const double bad : {kNaN, kInfinity, -kInfinity}) {
      EXPECT_EQ(scene_after([=](SceneRecord& record) { record.origin[k] = bad; }), kInvalid);
      EXPECT_EQ(scene_after([=](SceneRecord& record) { record.root_low[k] = bad; }), kInvalid);
      EXPECT_EQ(scene_after([=](SceneRecord& record) { record.root_high[k] = bad; }), kInvalid);
    }
    const auto with_box = [k](double low, double high) {
      return scene_after([=](SceneRecord& record) {
        record.root_low[k] = low;
        record.root_high[k] = high;
      });
    };
    EXPECT_EQ(with_box(1, 1), kOk);
    EXPECT_EQ(with_box(1, 0.5), kInvalid);
    EXPECT_EQ(with_box(-kMaxRootCoordinate, kMaxRootCoordinate), kOk);
    EXPECT_EQ(with_box(-2 * kMaxRootCoordinate, 0), kInvalid);
    EXPECT_EQ(with_box(0, 2 * kMaxRootCoordinate), kInvalid);
  }
  for (const double bad : {kNaN, kInfinity, -1.0}) {
    EXPECT_EQ(scene_after([=](SceneRecord& record) { record.condition = bad; }), kInvalid);
  }
  for (const int sign : {-1, 1}) {
    EXPECT_EQ(
        scene_after([=](SceneRecord& record) { record.scale_exponent = sign * kMaxScaleExponent; }),
        kOk);
    EXPECT_EQ(scene_after([=](SceneRecord& record) {
                record.scale_exponent = sign * (kMaxScaleExponent + 1);
              }),
              kInvalid);
  }
  EXPECT_EQ(scene_after([](SceneRecord& record) { record.flags = 2; }), kInvalid);
  EXPECT_EQ(scene_after([](SceneRecord& record) { record.flags = kSceneFacesNumbered; }), kOk);
  EXPECT_EQ(scene_after([](SceneRecord& record) { record.reserved1[1] = 1; }), kInvalid);
}

}  // namespace
}  // namespace boxtree
