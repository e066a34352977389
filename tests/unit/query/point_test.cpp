// SPDX-License-Identifier: MIT
// Closest points with an allowed error or a budget, against brute force in extended precision over
// the decoded triangles, and against the exact query where no error is allowed.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/shape_reference.h"
#include "tests/unit/walk/targets.h"

namespace boxtree {
namespace {

using cooker::SourceMesh;

// Triangles in object space, each in a sphere that rules most of them out.
class BruteForce {
 public:
  explicit BruteForce(const Tree& tree) : items_(test::bounded_triangles(tree)) {}

  [[nodiscard]] long double distance(const Eigen::Vector3d& point) const {
    const test::LongVector p = point.cast<long double>();
    long double best = std::numeric_limits<long double>::infinity();
    for (const test::BoundedTriangle& item : items_) {
      if ((item.center - p).norm() - item.radius > best) continue;
      best = std::min(best, test::distance_in_extended_precision({p, p, p}, item.corner));
    }
    return best;
  }

 private:
  std::vector<test::BoundedTriangle> items_;
};

class ApproximatePoints : public testing::TestWithParam<test::Encoding> {
 protected:
  // Amid the mesh, far from it, on a vertex, next to the surface.
  std::vector<Eigen::Vector3d> points(const Tree& tree, int count) {
    const Eigen::AlignedBox3d box = BoundTree::of(tree).to_object(BoundTree::of(tree).root().box);
    const auto coordinate = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random_);
    };
    std::vector<Eigen::Vector3d> result;
    for (int i = 0; i < count; ++i) {
      Eigen::Vector3d p;
      for (Eigen::Index k = 0; k < 3; ++k) {
        const double margin = 0.2 * (box.max()[k] - box.min()[k]);
        p[k] = coordinate(box.min()[k] - margin, box.max()[k] + margin);
      }
      if (i % 5 == 1) p *= 1e5;
      if (i % 5 == 2) p = closest_point(tree, p)->point;
      if (i % 5 == 3) p += (1 - 1e-6) * (closest_point(tree, p)->point - p);
      result.push_back(p);
    }
    return result;
  }

  template <class Body>
  void for_each_point(int count, Body body) {
    for (const SourceMesh& mesh : test::all_kinds()) {
      SCOPED_TRACE(mesh.name);
      const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
      const BruteForce truth(cooked.tree);
      const double size = BoundTree::of(cooked.tree)
                              .to_object(BoundTree::of(cooked.tree).root().box)
                              .diagonal()
                              .norm();
      for (const Eigen::Vector3d& point : points(cooked.tree, count)) {
        body(cooked.tree, point, truth.distance(point), size + point.norm());
        if (HasFatalFailure()) return;
      }
    }
  }

  static void check(const ApproximatePoint& found, const Eigen::Vector3d& point, long double truth,
                    double size) {
    ASSERT_LE(found.lower, truth * (1 + 1e-17L) + 1e-19L * size);
    ASSERT_GE(found.upper, truth - 1e-19L * size);
    ASSERT_LE(found.lower, found.upper);
    ASSERT_EQ(found.witness.has_value(), std::isfinite(found.upper));
    if (!found.witness) return;
    ASSERT_NEAR((found.witness->point - point).norm(), found.upper, 1e-13 * size);
    ASSERT_NEAR(found.witness->distance, found.upper, 1e-13 * size);
  }

  std::mt19937_64 random_{5};
};

TEST_P(ApproximatePoints, BoundsAreTrueAndAsCloseAsRequested) {
  std::array<std::uint64_t, 7> nodes{};
  std::uint64_t nodes_within = 0;
  for_each_point(
      30, [&](const Tree& tree, const Eigen::Vector3d& point, long double truth, double size) {
        std::uint64_t exact_nodes = 0;
        const std::array<double, 7> errors = {0.0, 1e-6, 1e-3, 0.01, 0.1, 0.5, 1.0};
        for (std::size_t i = 0; i < errors.size(); ++i) {
          SCOPED_TRACE(errors[i]);
          const auto found = closest_point(tree, point, PointOptions{errors[i], 0});
          ASSERT_TRUE(found.ok() && found->converged);
          check(*found, point, truth, size);
          ASSERT_LE(found->upper, found->lower * (1 + errors[i]) + 1e-12 * size);
          nodes[i] += found->nodes_expanded;
          if (i == 0) exact_nodes = found->nodes_expanded;
          ASSERT_LE(found->nodes_expanded, exact_nodes);
          if (HasFatalFailure()) return;
        }
        for (const double error : {1e-3, 0.1, 10.0}) {
          const auto found = closest_point(tree, point, PointOptions{0, error});
          check(*found, point, truth, size);
          ASSERT_LE(found->upper, found->lower + error + 1e-12 * size);
          ASSERT_LE(found->nodes_expanded, exact_nodes);
          if (error == 0.1) nodes_within += found->nodes_expanded;
        }
      });
  for (std::size_t i = 1; i < nodes.size(); ++i) EXPECT_LE(nodes[i], nodes[i - 1]);
  EXPECT_LT(nodes.back(), nodes.front());
  EXPECT_LT(nodes_within, nodes.front());
}

TEST_P(ApproximatePoints, WithoutErrorTheyAreTheExactOnes) {
  for_each_point(
      20, [&](const Tree& tree, const Eigen::Vector3d& point, long double truth, double size) {
        const auto exact = closest_point(tree, point);
        PointOptions unlimited;
        PointOptions enough;  // best-first to the end: ties must end the same way
        enough.node_budget = 1u << 30;
        for (const PointOptions& options : {unlimited, enough}) {
          const auto found = closest_point(tree, point, options);
          ASSERT_TRUE(found->converged);
          ASSERT_EQ(found->witness->distance, exact->distance);
          ASSERT_EQ(found->witness->point, exact->point);
          ASSERT_EQ(found->witness->face.id, exact->face.id);
          ASSERT_EQ(found->witness->triangle, exact->triangle);
          check(*found, point, truth, size);
        }
      });
}

TEST_P(ApproximatePoints, BudgetsEndTheSearchWithTrueBounds) {
  int spent = 0;
  for_each_point(
      10, [&](const Tree& tree, const Eigen::Vector3d& point, long double truth, double size) {
        double gap = std::numeric_limits<double>::infinity();
        for (const std::uint64_t budget : {0u, 1u, 10u, 20u, 1000u}) {
          SCOPED_TRACE(budget);
          PointOptions options;
          options.node_budget = budget;
          const auto found = closest_point(tree, point, options);
          check(*found, point, truth, size);
          ASSERT_LE(found->nodes_expanded, budget);
          ASSERT_LE(found->upper - found->lower, gap);  // more nodes never tell less
          gap = found->upper - found->lower;
          if (found->converged) continue;
          ++spent;
          ASSERT_EQ(found->nodes_expanded, budget);
        }
      });
  EXPECT_GT(spent, 100);
}

// Vectors compute the keys of plain code, so that a budget ends every search at the same place.
TEST_P(ApproximatePoints, BudgetsAreSpentAlikeByEveryInstructionSet) {
  for_each_point(10, [&](const Tree& tree, const Eigen::Vector3d& point, long double, double) {
    for (const std::uint64_t budget : {1u, 5u, 12u, 40u, 1u << 30}) {
      SCOPED_TRACE(budget);
      PointOptions options;
      options.node_budget = budget;
      std::optional<ApproximatePoint> first;
      for_each_target([&](const char* target) {
        SCOPED_TRACE(target);
        const auto found = closest_point(tree, point, options);
        ASSERT_TRUE(found.ok());
        if (!first) first = *found;
        ASSERT_EQ(found->nodes_expanded, first->nodes_expanded);
        ASSERT_EQ(found->converged, first->converged);
        ASSERT_EQ(found->lower, first->lower);
        ASSERT_EQ(found->upper, first->upper);
        ASSERT_EQ(found->witness.has_value(), first->witness.has_value());
        if (!found->witness) return;
        ASSERT_EQ(found->witness->face.id, first->witness->face.id);
        ASSERT_EQ(found->witness->triangle, first->witness->triangle);
        ASSERT_EQ(found->witness->point, first->witness->point);
        ASSERT_EQ(found->witness->distance, first->witness->distance);
      });
    }
  });
}

TEST_P(ApproximatePoints, NothingBeyondTheMaximalDistance) {
  for_each_point(
      5, [&](const Tree& tree, const Eigen::Vector3d& point, long double truth, double size) {
        for (const std::uint64_t budget : {kUnlimitedNodes, std::uint64_t{1} << 30}) {
          PointOptions options;
          options.node_budget = budget;
          options.max_distance = static_cast<double>(truth * 1.001L);
          if (truth < 1e-9L * size) continue;  // a thousandth of it is less than points are off by
          ASSERT_TRUE(closest_point(tree, point, options)->witness.has_value());
          options.max_distance = static_cast<double>(truth * 0.999L);
          const auto nothing = closest_point(tree, point, options);
          ASSERT_FALSE(nothing->witness.has_value());
          ASSERT_TRUE(nothing->converged);
          check(*nothing, point, truth, size);
          ASSERT_GE(nothing->lower, options.max_distance - 1e-12 * size);
        }
      });
}

// A distance is within itself and within nothing less, however its square was rounded.
TEST(ClosestPoint, IsFoundWithinItsOwnDistanceAndWithinNothingLess) {
  std::mt19937_64 random(8);
  std::uniform_real_distribution<double> coordinate(-3, 3);
  for (const double size : {1.0, 1e-150, 1e130}) {
    SourceMesh mesh;
    mesh.name = "triangle";
    mesh.positions.precision = cooker::Precision::kF64;
    for (const double x : {0.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 2.0, 0.0}) {
      mesh.positions.f64.push_back(x * size);
    }
    mesh.faces = {{{0, 1, 2, cooker::kNoCorner}}};
    const test::CookedTree cooked = test::cook_tree(mesh, CodecId::kWide8);
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector3d point =
          size * Eigen::Vector3d(coordinate(random), coordinate(random), coordinate(random));
      const PointResult nearest = closest_point(cooked.tree, point);
      ASSERT_TRUE(nearest.has_value());
      const double distance = nearest->distance, less = std::nextafter(distance, 0.0);
      ASSERT_TRUE(closest_point(cooked.tree, point, distance).has_value()) << point.transpose();
      ASSERT_FALSE(closest_point(cooked.tree, point, less).has_value()) << point.transpose();
      int in_sphere = 0;
      const auto count = [&](const FaceRef&) { return ++in_sphere > 0; };
      ASSERT_TRUE(overlap_sphere(cooked.tree, point, distance, count).ok());
      ASSERT_EQ(in_sphere, 1) << point.transpose();
      std::array<PointResult, 1> of_batch;
      ASSERT_TRUE(closest_points(cooked.tree, {&point, 1}, of_batch, distance));
      ASSERT_TRUE(of_batch[0].has_value());
      ASSERT_TRUE(closest_points(cooked.tree, {&point, 1}, of_batch, less));
      ASSERT_FALSE(of_batch[0].has_value());
      PointOptions options;
      options.max_distance = distance;
      ASSERT_TRUE(closest_point(cooked.tree, point, options)->witness.has_value());
    }
  }
}

TEST_P(ApproximatePoints, RefuseWhatHasNoMeaning) {
  const test::CookedTree cooked = test::cook_tree(test::city(1, 2), GetParam());
  const auto refused = [&](const PointOptions& options) {
    return closest_point(cooked.tree, {0, 0, 0}, options).error().message();
  };
  EXPECT_EQ(refused({-1, 0}), "invalid_query: relative_error: expected 0 or more");
  EXPECT_EQ(refused({NAN, 0}), "invalid_query: relative_error: expected 0 or more");
  EXPECT_EQ(refused({0, -1}), "invalid_query: absolute_error: expected 0 or more");
  EXPECT_EQ(refused({0, 0, NAN}), "invalid_query: max_distance: expected 0 or more");
  EXPECT_EQ(closest_point(cooked.tree, {NAN, 0, 0}, PointOptions()).error().message(),
            "invalid_query: point: expected a finite point, at most 2^185 mesh extents away");
}

// A mesh that is one place, and points beside it: the square of the way there is no double.
TEST_P(ApproximatePoints, UpperBoundHoldsWhereSquaresUnderflow) {
  SourceMesh mesh;
  mesh.positions.f32.assign(3 * 3, 0.0F);
  mesh.faces.push_back({{0, 1, 2, cooker::kNoCorner}});
  const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
  for (const int exponent : {-1074, -1050, -600, -538}) {
    const double height = std::ldexp(1.0, exponent);
    const auto found = closest_point(cooked.tree, {0, 0, height}, PointOptions());
    ASSERT_TRUE(found.ok());
    EXPECT_LE(found->lower, height) << exponent;
    EXPECT_GE(found->upper, height) << exponent;
  }
  EXPECT_EQ(closest_point(cooked.tree, {0, 0, 0}, PointOptions())->upper, 0);
}

// Distances of a few units of 2^-1074 that are no doubles: the nearest one may be too small.
TEST_P(ApproximatePoints, UpperBoundHoldsWhereDoublesEnd) {
  constexpr double kLeast = std::numeric_limits<double>::denorm_min();
  constexpr double kSide = 0x1p34 * kLeast;
  SourceMesh mesh;
  mesh.positions.precision = cooker::Precision::kF64;
  mesh.positions.f64 = {0, 0, 0, kSide, 0, 0, 0, kSide, 0};
  mesh.faces.push_back({{0, 1, 2, cooker::kNoCorner}});
  const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
  const BruteForce truth(cooked.tree);
  int inexact = 0;
  for (int i = 1; i <= 8; ++i) {
    for (int j = 1; j <= 8; ++j) {
      const Eigen::Vector3d point(-i * kLeast, -j * kLeast, 0);
      const long double apart = truth.distance(point);
      const auto found = closest_point(cooked.tree, point, PointOptions());
      ASSERT_TRUE(found.ok());
      EXPECT_LE(found->lower, apart) << i << ' ' << j;
      EXPECT_GE(found->upper, apart) << i << ' ' << j;
      inexact += static_cast<double>(apart) < apart ? 1 : 0;
    }
  }
  EXPECT_GT(inexact, 10);
}

// A mesh that is one place, at a coordinate whose unit in the last place has no square. Found by
// boxtree_exact, seed 61: the lower bound was 0.
TEST_P(ApproximatePoints, LowerBoundIsTightBesideAMeshThatIsOnePlace) {
  const Eigen::Vector3d place(0x1.8001c93ed7188p-785, 0x1.13f502fe7619ep-784,
                              0x1.d8180c4b8e61cp-785);
  const double step = std::ldexp(1.0, -785 - 52);
  SourceMesh mesh;
  mesh.positions.precision = cooker::Precision::kF64;
  mesh.positions.f64 = {place[0], place[1], place[2]};
  mesh.faces.push_back({{0, 0, 0, cooker::kNoCorner}});
  const test::CookedTree cooked = test::cook_tree(mesh, GetParam());
  const Eigen::Vector3d beside = place + Eigen::Vector3d(step, 0, -step);
  ASSERT_NE(beside, place);
  const auto found = closest_point(cooked.tree, beside, PointOptions());
  ASSERT_TRUE(found.ok());
  const long double apart = BruteForce(cooked.tree).distance(beside);
  EXPECT_LE(found->lower, apart);
  EXPECT_GE(found->upper, apart);
  if (BoundTree::of(cooked.tree).leaves().is_grid()) return;  // which may move the place
  EXPECT_NEAR(static_cast<double>(apart / step), std::sqrt(2.0), 1e-15);
  EXPECT_GE(found->lower, apart * (1 - 0x1p-44L));
  EXPECT_LE(found->upper, apart * (1 + 0x1p-44L));
}

INSTANTIATE_TEST_SUITE_P(Encodings, ApproximatePoints, testing::ValuesIn(test::all_encodings()),
                         test::encoding_name);

}  // namespace
}  // namespace boxtree
