// SPDX-License-Identifier: MIT
// Batches of closest points answer each point as it is answered alone, to the bit.
#include <array>
#include <cstddef>
#include <vector>

#include <gtest/gtest.h>

#include <boxtree/boxtree.h>

#include "cooker/cook.h"
#include "format/codec_wide.h"
#include "tests/support/cooked.h"
#include "tests/support/infinity.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/unit/query/batches.h"
#include "tests/unit/walk/targets.h"

namespace boxtree {
namespace {

using test::kInfinity;
using test::kNan;

using test::same_bits;
bool same_bits(const PointResult& a, const PointResult& b) {
  return a.has_value() == b.has_value() && a.code() == b.code() &&
         a.error().detail == b.error().detail && same_bits(a->distance, b->distance) &&
         a->face.id == b->face.id && a->face.index == b->face.index && a->triangle == b->triangle &&
         same_bits(a->point, b->point);
}

// What results hold before a call: every one must be written.
const PointResult kUnwritten(Errc::kInternal, "not written");

// By every instruction set.
void expect_as_alone(const Tree& tree, const std::vector<Eigen::Vector3d>& points,
                     double max_distance = kInfinity, const QueryLimits& limits = {}) {
  for_each_target([&](const char* target) {
    SCOPED_TRACE(target);
    std::vector<PointResult> results(points.size(), kUnwritten);
    ASSERT_TRUE(closest_points(tree, points, results, max_distance, limits).ok());
    for (std::size_t i = 0; i < points.size(); ++i) {
      SCOPED_TRACE(i);
      ASSERT_TRUE(same_bits(results[i], closest_point(tree, points[i], max_distance, limits)));
    }
  });
}

class PointBatches : public test::BatchTest {};

TEST_P(PointBatches, OfALatticeAreAsAlone) {
  for_each_mesh([&](const Tree& tree, const Eigen::AlignedBox3d& box) {
    const double size = box.sizes().norm() + 0.1;
    std::vector<Eigen::Vector3d> points;
    for (int z = 0; z < 6; ++z) {
      for (int y = 0; y < 8; ++y) {
        for (int x = 0; x < 8; ++x) {
          points.push_back(box.center() + size * Eigen::Vector3d(x - 3.5, y - 3.5, z - 2.5) / 8);
        }
      }
    }
    expect_as_alone(tree, points);
    for (const double max_distance : {0.0, 0.05 * size, 0.3 * size}) {
      expect_as_alone(tree, points, max_distance);
    }
  });
}

TEST_P(PointBatches, OfPointsThatHaveNothingInCommonAreAsAlone) {
  for_each_mesh([&](const Tree& tree, const Eigen::AlignedBox3d& box) {
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 400; ++i) points.push_back(point_around(box, i % 3 == 0 ? 1.2 : 4));
    expect_as_alone(tree, points);
  });
}

// As near to several faces, where the smaller id decides.
TEST_P(PointBatches, OnCornersAndEdgesAreAsAlone) {
  for_each_mesh([&](const Tree& tree, const Eigen::AlignedBox3d& box) {
    std::vector<Eigen::Vector3d> points;
    for (std::uint32_t f = 0; f < std::min(tree.face_count(), 60u); ++f) {
      const Result<Triangle> triangle = tree.triangle({kNoFaceId, f}, 0);
      if (!triangle) continue;
      const auto& [a, b, c] = triangle->corner;
      points.insert(points.end(), {a, 0.5 * (a + b), 0.5 * (b + c), (a + b + c) / 3, 2 * a - b});
    }
    points.push_back(box.center());
    expect_as_alone(tree, points);
    expect_as_alone(tree, points, 0);
  });
}

TEST_P(PointBatches, WithPointsThatAreRefusedOrExtremeAreAsAlone) {
  for_each_mesh([&](const Tree& tree, const Eigen::AlignedBox3d& box) {
    const double size = box.sizes().norm() + 0.1;
    std::vector<Eigen::Vector3d> points;
    for (int i = 0; i < 120; ++i) {
      Eigen::Vector3d point = point_around(box, 2);
      switch (i % 10) {
        case 1:
          point[i / 10 % 3] = kNan;
          break;
        case 2:
          point[i / 10 % 3] = i % 20 == 2 ? kInfinity : -kInfinity;
          break;
        case 3:
          point += 0x1p7 * size * Eigen::Vector3d::Unit(i / 10 % 3);
          break;
        case 4:
          point *= 0x1p60;
          break;
        case 5:
          point *= 0x1p400;
          break;
        case 6:
          point *= 0x1p1000;
          break;
        case 7:
          point *= 0x1p-1040;
          break;
        default:
          break;
      }
      points.push_back(point);
    }
    expect_as_alone(tree, points);
    for (const double max_distance : {kNan, -1.0, 0x1p-1060, 0x1p1000}) {
      expect_as_alone(tree, points, max_distance);
    }
  });
}

TEST_P(PointBatches, OfAnyNumberAreAsAlone) {
  const test::CookedTree cooked = test::cook_tree(test::torus(20, 12), GetParam());
  for (std::size_t count = 0; count < 40; ++count) {
    std::vector<Eigen::Vector3d> points;
    for (std::size_t i = 0; i < count; ++i) {
      points.push_back(point_around(cooked.tree.bounds(), 2));
    }
    expect_as_alone(cooked.tree, points);
  }
}

TEST_P(PointBatches, GiveEachPointItsOwnLimit) {
  const test::CookedTree cooked = test::cook_tree(test::torus(60, 40), GetParam());
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 50; ++i) points.push_back(point_around(cooked.tree.bounds(), 2));
  for (const std::uint64_t nodes : {0u, 1u, 3u, 1000u}) {
    expect_as_alone(cooked.tree, points, kInfinity, QueryLimits{nodes});
  }
}

INSTANTIATE_TEST_SUITE_P(Encodings, PointBatches, testing::ValuesIn(test::all_encodings()),
                         test::encoding_name);

TEST(PointBatch, RefusesResultsOfAnotherNumber) {
  const test::CookedTree cooked = test::cook_tree(test::torus(20, 12), CodecId::kWide8);
  const std::array<Eigen::Vector3d, 3> points = {{{1, 0, 9}, {2, 0, 9}, {1, 0, 9}}};
  std::array<PointResult, 2> results = {kUnwritten, kUnwritten};
  const Status refused = closest_points(cooked.tree, points, results);
  EXPECT_EQ(refused.error().code, Errc::kInvalidQuery);
  EXPECT_EQ(refused.error().detail, "results.size()");
  EXPECT_EQ(results[0].code(), Errc::kInternal) << "nothing was written";
}

// A point that comes upon a corrupt node gets the error, those beside it their answers.
TEST(PointBatch, GivesErrorsToThePointsThatComeUponThem) {
  test::CookedTree cooked = test::cook_tree(test::torus(80, 48), CodecId::kWide8);
  const auto nodes = test::section_of(cooked.bytes, SectionKind::kNodes);
  const std::size_t node_count = nodes.size() / sizeof(Wide8Node);
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < 64; ++i) points.emplace_back(0.1 * i - 3.2, 0.3, 0.9);
  std::size_t failed = 0, answered = 0;
  for (std::size_t node = 0; node < node_count; node += 1 + node_count / 40) {
    std::vector<std::byte> bytes = cooked.bytes;
    test::section_of(
        bytes, SectionKind::kNodes)[node * sizeof(Wide8Node) + offsetof(Wide8Node, child_count)] =
        std::byte{200};
    const File file = test::require(File::open(bytes));
    const Tree tree = test::require(Tree::bind(file));
    expect_as_alone(tree, points);
    for (const Eigen::Vector3d& point : points) {
      ++(closest_point(tree, point).ok() ? answered : failed);
    }
  }
  EXPECT_GT(failed, 64u);
  EXPECT_GT(answered, 64u);
}

}  // namespace
}  // namespace boxtree
