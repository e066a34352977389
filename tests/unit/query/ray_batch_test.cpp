// SPDX-License-Identifier: MIT
// Batches of rays answer each ray as it is answered alone, to the bit.
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
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
bool same_bits(const RayResult& a, const RayResult& b) {
  return a.has_value() == b.has_value() && a.code() == b.code() &&
         a.error().detail == b.error().detail && same_bits(a->t, b->t) &&
         a->face.id == b->face.id && a->face.index == b->face.index && a->triangle == b->triangle &&
         same_bits(a->u, b->u) && same_bits(a->v, b->v) && same_bits(a->point, b->point) &&
         same_bits(a->normal, b->normal);
}

// What results hold before a call: every one must be written.
const RayResult kUnwrittenRay(Errc::kInternal, "not written");

// By every instruction set; that of the closest hits is the same by all. `options`: QueryLimits or
// FaceOptions.
template <class Options = QueryLimits>
void expect_as_alone(const Tree& tree, const std::vector<Ray>& rays, const Options& options = {}) {
  std::vector<RayResult> by_first;
  for_each_target([&](const char* target) {
    SCOPED_TRACE(target);
    std::vector<RayResult> closest(rays.size(), kUnwrittenRay), any(rays.size(), kUnwrittenRay);
    ASSERT_TRUE(closest_hits(tree, rays, closest, options).ok());
    ASSERT_TRUE(any_hits(tree, rays, any, options).ok());
    if (by_first.empty()) by_first = closest;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      SCOPED_TRACE(i);
      ASSERT_TRUE(same_bits(closest[i], closest_hit(tree, rays[i], options)));
      ASSERT_TRUE(same_bits(any[i], any_hit(tree, rays[i], options)));
      ASSERT_TRUE(same_bits(closest[i], by_first[i]));
    }
  });
}

class RayBatches : public test::BatchTest {};

TEST_P(RayBatches, OfACameraAreAsAlone) {
  for_each_mesh([&](const Tree& tree, const Eigen::AlignedBox3d& box) {
    for (const double distance : {3.0, 1.2, 0.1}) {
      const Eigen::Vector3d eye =
          box.center() + distance * box.sizes().norm() * Eigen::Vector3d(0.36, 0.48, 0.8);
      std::vector<Ray> rays;
      for (int y = 0; y < 20; ++y) {
        for (int x = 0; x < 20; ++x) {
          const Eigen::Vector3d across(0.8, -0.6, 0), up(0.48, 0.64, -0.6);
          const Eigen::Vector3d forward(-0.36, -0.48, -0.8);
          rays.push_back({eye, forward + (x - 9.5) / 20 * across + (y - 9.5) / 20 * up});
        }
      }
      expect_as_alone(tree, rays);
    }
  });
}

TEST_P(RayBatches, OfRaysThatHaveNothingInCommonAreAsAlone) {
  for_each_mesh([&](const Tree& tree, const Eigen::AlignedBox3d& box) {
    std::vector<Ray> rays;
    for (int i = 0; i < 400; ++i) {
      const Eigen::Vector3d from = point_around(box, i % 3 == 0 ? 0.9 : 4);
      Ray ray{from, point_around(box, 1) - from};
      if (i % 5 == 0) ray.t_max = 1;
      if (i % 7 == 0) ray.t_min = 0.9;
      if (i % 11 == 0) ray.direction[i % 3] = 0;
      if (i % 13 == 0) ray.direction = Eigen::Vector3d::Unit(i % 3);
      rays.push_back(ray);
    }
    expect_as_alone(tree, rays);
  });
}

// Along edges and through corners of boxes and faces, where which face is hit is decided exactly.
TEST_P(RayBatches, ThroughCornersAreAsAlone) {
  for_each_mesh([&](const Tree& tree, const Eigen::AlignedBox3d& box) {
    std::vector<Ray> rays;
    for (std::uint32_t f = 0; f < std::min(tree.face_count(), 60u); ++f) {
      const Result<Triangle> triangle = tree.triangle({kNoFaceId, f}, 0);
      if (!triangle) continue;
      const auto& [a, b, c] = triangle->corner;
      const Eigen::Vector3d from = point_around(box, 3);
      rays.push_back({from, a - from});
      rays.push_back({from, 0.5 * (b + c) - from});
      rays.push_back({a - Eigen::Vector3d(0, 0, 1), {0, 0, 1}});
      rays.push_back({a, b - a});
    }
    for (int i = 0; i < 6; ++i) {
      const Eigen::Vector3d corner = i < 3 ? box.min() : box.max();
      rays.push_back({corner - Eigen::Vector3d::Unit(i % 3), Eigen::Vector3d::Unit(i % 3)});
    }
    expect_as_alone(tree, rays);
  });
}

// Those that are set up side by side with others are no different for it.
TEST_P(RayBatches, WithRaysThatAreRefusedOrExtremeAreAsAlone) {
  for_each_mesh([&](const Tree& tree, const Eigen::AlignedBox3d& box) {
    const double size = box.sizes().norm() + 0.1;
    const std::array<Eigen::Vector3d, 4> zero = {
        Eigen::Vector3d::Zero(), {kNan, 1, 1}, {kInfinity, 0, 0}, {0, -0.0, 0}};
    std::vector<Ray> rays;
    for (int i = 0; i < 200; ++i) {
      const Eigen::Vector3d from = point_around(box, 4);
      Ray ray{from, point_around(box, 0.5) - from};
      switch (i % 20) {
        case 1:
          ray.direction = zero[static_cast<std::size_t>(i / 20) % 4];
          break;
        case 2:
          ray.origin[i / 20 % 3] = i % 40 == 2 ? kNan : kInfinity;
          break;
        case 3:
          ray.t_min = i % 40 == 3 ? -1 : kNan;
          break;
        case 4:
          ray.t_max = i % 40 == 4 ? -1 : kNan;
          break;
        case 5:
          ray.direction *= 0x1p-1040;
          break;
        case 6:
          ray.direction *= 0x1p1000;
          break;
        case 7:
          ray.direction *= 0x1p-501;
          break;
        case 8:
          ray.direction *= 0x1p499;
          break;
        case 9:
          ray.origin -= 0x1p29 * size * ray.direction;
          break;
        case 10:
          ray.origin -= 0x1p60 * size * ray.direction;
          break;
        case 11:
          ray.origin -= 0x1p190 * size * ray.direction;
          break;
        case 12:
          ray.t_min = ray.t_max = 1;
          break;
        case 13:
          ray.t_min = kInfinity;
          break;
        case 14:
          ray.t_max = std::numeric_limits<double>::denorm_min();
          break;
        case 15:
          ray.direction[i / 20 % 3] *= 0x1p-1000;
          break;
        case 16:
          ray.direction = -ray.direction;
          break;
        default:
          break;
      }
      rays.push_back(ray);
    }
    expect_as_alone(tree, rays);
  });
}

TEST_P(RayBatches, OfSidesAndFacesAreAsAlone) {
  for_each_mesh([&](const Tree& tree, const Eigen::AlignedBox3d& box) {
    std::vector<Ray> rays;
    const Eigen::Vector3d eye = point_around(box, 4);
    for (int i = 0; i < 50; ++i) rays.push_back({eye, point_around(box, 1) - eye});
    const auto some = [](const FaceRef& face) { return face.index % 3 != 0; };
    FaceOptions options;
    options.back_faces = BackFaces::kIgnore;
    expect_as_alone(tree, rays, options);
    options.filter = some;
    options.back_faces = BackFaces::kOnly;
    expect_as_alone(tree, rays, options);
    options.back_faces = BackFaces::kHit;
    expect_as_alone(tree, rays, options);
    options.limits = {5};
    expect_as_alone(tree, rays, options);
  });
}

TEST_P(RayBatches, OfAnyNumberAreAsAlone) {
  const test::CookedTree cooked = test::cook_tree(test::torus(20, 12), GetParam());
  for (std::size_t count = 0; count < 40; ++count) {
    std::vector<Ray> rays;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d from = point_around(cooked.tree.bounds(), 3);
      rays.push_back({from, point_around(cooked.tree.bounds(), 1) - from});
    }
    expect_as_alone(cooked.tree, rays);
  }
}

TEST_P(RayBatches, GiveEachRayItsOwnLimit) {
  const test::CookedTree cooked = test::cook_tree(test::torus(60, 40), GetParam());
  std::vector<Ray> rays;
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector3d from = point_around(cooked.tree.bounds(), 3);
    rays.push_back({from, point_around(cooked.tree.bounds(), 1) - from});
  }
  for (const std::uint64_t nodes : {0u, 1u, 3u, 1000u}) {
    expect_as_alone(cooked.tree, rays, QueryLimits{nodes});
  }
}

INSTANTIATE_TEST_SUITE_P(Encodings, RayBatches, testing::ValuesIn(test::all_encodings()),
                         test::encoding_name);

TEST(RayBatch, RefusesResultsOfAnotherNumber) {
  const test::CookedTree cooked = test::cook_tree(test::torus(20, 12), CodecId::kWide8);
  const std::array<Ray, 3> rays = {
      {{{1, 0, 9}, {0, 0, -1}}, {{2, 0, 9}, {0, 0, -1}}, {{1, 0, 9}, {0, 0, -1}}}};
  std::array<RayResult, 2> results = {kUnwrittenRay, kUnwrittenRay};
  for (const Status& refused :
       {closest_hits(cooked.tree, rays, results), any_hits(cooked.tree, rays, results)}) {
    EXPECT_EQ(refused.error().code, Errc::kInvalidQuery);
    EXPECT_EQ(refused.error().detail, "results.size()");
  }
  EXPECT_EQ(results[0].code(), Errc::kInternal) << "nothing was written";
}

// A ray that comes upon a corrupt node gets the error, those beside it their answers.
TEST(RayBatch, GivesErrorsToTheRaysThatComeUponThem) {
  test::CookedTree cooked = test::cook_tree(test::torus(80, 48), CodecId::kWide8);
  const auto nodes = test::section_of(cooked.bytes, SectionKind::kNodes);
  const std::size_t node_count = nodes.size() / sizeof(Wide8Node);
  std::vector<Ray> rays;
  for (int i = 0; i < 64; ++i) {
    const Eigen::Vector3d from(0.1 * i - 3.2, 0.3, 9);
    rays.push_back({from, Eigen::Vector3d(0.05 * i - 1.6, 0.2, 0) - from});
  }
  std::size_t failed = 0, answered = 0;
  for (std::size_t node = 0; node < node_count; node += 1 + node_count / 40) {
    std::vector<std::byte> bytes = cooked.bytes;
    test::section_of(
        bytes, SectionKind::kNodes)[node * sizeof(Wide8Node) + offsetof(Wide8Node, child_count)] =
        std::byte{200};
    const File file = test::require(File::open(bytes));
    const Tree tree = test::require(Tree::bind(file));
    expect_as_alone(tree, rays);
    for (const Ray& ray : rays) ++(closest_hit(tree, ray).ok() ? answered : failed);
  }
  EXPECT_GT(failed, 64u);
  EXPECT_GT(answered, 64u);
}

// A tree whose numbers are beyond those that rays are set up for side by side.
TEST(RayBatch, OfTreesOfAnySizeAreAsAlone) {
  for (const double scale : {0x1p-400, 0x1p-600, 0x1p120, 0x1p400, 0x1p600}) {
    SCOPED_TRACE(scale);
    cooker::SourceMesh mesh = test::torus(20, 12);
    mesh.positions.precision = cooker::Precision::kF64;
    for (const float x : mesh.positions.f32) mesh.positions.f64.push_back(scale * double{x});
    const Result<cooker::CookedTree> cooked = cooker::cook_mesh(mesh, {});
    if (!cooked) continue;
    const std::vector<std::byte> bytes = cooker::serialize(std::span(&cooked->tree, 1));
    const File file = test::require(File::open(bytes));
    const Tree tree = test::require(Tree::bind(file));
    std::vector<Ray> rays;
    for (int i = 0; i < 40; ++i) {
      rays.push_back({scale * Eigen::Vector3d(0.05 * i - 1, 0.1, 9), {0, 0.01, -1}});
      rays.push_back({scale * Eigen::Vector3d(0.05 * i - 1, 0.1, 9), {0, 0.01 * scale, -scale}});
    }
    expect_as_alone(tree, rays);
  }
}

}  // namespace
}  // namespace boxtree
