// SPDX-License-Identifier: MIT
// Curves of approximate queries: truths against brute force in extended precision, steps against
// what theory promises, the page and its data against the steps.
#include <algorithm>
#include <regex>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "cooker/report/approximate_page.h"
#include "cooker/report/tradeoff_page.h"
#include "runtime/tree/bound_tree.h"
#include "tests/support/cooked.h"
#include "tests/support/meshes.h"
#include "tests/support/require.h"
#include "tests/support/triangle_reference.h"

namespace boxtree::cooker {
namespace {

using test::require;

// Extended precision and bounds differ by roundings of numbers of the mesh's size, which is 1 here.
constexpr double kRounding = 1e-13;

std::vector<Triangle> in_object_space(const Tree& tree) {
  std::vector<Triangle> triangles = test::all_triangles(tree);
  for (Triangle& triangle : triangles) {
    for (Eigen::Vector3d& corner : triangle.corner)
      corner = BoundTree::of(tree).frame().to_object(corner);
  }
  return triangles;
}

Triangle moved(const Triangle& triangle, const Pose& pose) {
  return {{pose * triangle.corner[0], pose * triangle.corner[1], pose * triangle.corner[2]}};
}

TEST(Approximate, TruthsAreThoseOfBruteForce) {
  const test::CookedTree cooked = test::cook_tree(test::sphere(5, 6), CodecId::kPlainF32);
  const std::vector<Triangle> triangles = in_object_space(cooked.tree);
  const Workload queries = make_workload(bounds_in_object_space(cooked.tree), {0, 0, 40, 0, 8}, 5);
  const TrueDistances truth = require(true_distances(cooked.tree, queries));
  ASSERT_EQ(truth.points.size(), 40u);
  ASSERT_EQ(truth.poses.size(), 8u);
  for (std::size_t i = 0; i < queries.points.size(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (const Triangle& triangle : triangles) {
      least = std::min(least, test::distance_in_extended_precision(queries.points[i], triangle));
    }
    EXPECT_NEAR(truth.points[i].lower, least, kRounding) << i;
    EXPECT_NEAR(truth.points[i].upper, least, kRounding) << i;
  }
  for (std::size_t i = 0; i < queries.apart.size(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (const Triangle& second : triangles) {
      const Triangle there = moved(second, queries.apart[i]);
      for (const Triangle& first : triangles) {
        least = std::min(least, test::distance_in_extended_precision(first, there));
      }
    }
    EXPECT_GT(least, 0.01) << "a pose apart touches";
    EXPECT_NEAR(truth.poses[i].lower, least, kRounding) << i;
    EXPECT_NEAR(truth.poses[i].upper, least, kRounding) << i;
  }
}

// Without times: the same on every machine. Quick: fewer queries, and fewer grids, which have no
// such figures.
const MeshTradeoff& counted_torus() {
  static const MeshTradeoff tradeoff = [] {
    SourceMesh torus = test::torus(24, 40);
    torus.name = "torus";
    return require(measure_tradeoff(torus, {true, false}));
  }();
  return tradeoff;
}

std::vector<const TradePoint*> queried_points() {
  std::vector<const TradePoint*> points;
  for (const TradePoint& point : counted_torus().points) {
    if (!point.approximate[0].by_error.empty()) points.push_back(&point);
  }
  return points;
}

TEST(Approximate, CodecsOfTheListAreQueriedWithExactGeometry) {
  std::vector<CodecId> codecs;
  for (const TradePoint* point : queried_points()) {
    EXPECT_EQ(point->geometry, is_wide(point->codec) ? GeometryId::kExact : GeometryId::kArrays);
    codecs.push_back(point->codec);
  }
  EXPECT_TRUE(std::is_permutation(codecs.begin(), codecs.end(), kApproximateCodecs.begin(),
                                  kApproximateCodecs.end()));
}

TEST(Approximate, BoundsHoldTheTruthAndErrorsKeepToWhatIsAllowed) {
  for (const TradePoint* point : queried_points()) {
    for (std::size_t kind = 0; kind < kApproximateKinds; ++kind) {
      for (const ApproximateStep& step : point->approximate[kind].by_error) {
        const std::string what =
            fmt::format("{} {} {}", point->name(), kApproximateNames[kind], step.relative_error);
        EXPECT_EQ(step.false_bounds, 0u) << what;
        EXPECT_EQ(step.found, step.queries) << what;
        EXPECT_EQ(step.converged, step.queries) << what;
        EXPECT_LE(step.gap_max, step.relative_error + 1e-9) << what;
        EXPECT_LE(step.error_max, step.gap_max + 1e-9) << what;
        EXPECT_LE(step.error_median, step.error_max) << what;
      }
      for (const ApproximateStep& step : point->approximate[kind].by_budget) {
        const std::string what =
            fmt::format("{} {} {}", point->name(), kApproximateNames[kind], step.node_budget);
        EXPECT_EQ(step.false_bounds, 0u) << what;
        EXPECT_LE(step.nodes_mean, static_cast<double>(step.node_budget)) << what;
        EXPECT_LE(step.error_max, step.gap_max + 1e-9) << what;
      }
      // Each sweep begins where a budget ends most walks and comes to where it ends few or none.
      const std::vector<ApproximateStep>& budgets = point->approximate[kind].by_budget;
      EXPECT_LT(budgets.front().converged, budgets.front().queries / 2) << point->name();
      EXPECT_GT(budgets.back().converged, budgets.back().queries * 3 / 4) << point->name();
    }
  }
}

// Points of a flat mesh are on it: what their distances are off by is no multiple of 0.
TEST(Approximate, ErrorsOfPointsOnTheSurfaceAreSharesOfTheDiagonal) {
  SourceMesh flat = test::torus(24, 40);
  for (std::size_t i = 2; i < flat.positions.f32.size(); i += 3) flat.positions.f32[i] = 0;
  const test::CookedTree cooked = test::cook_tree(flat, CodecId::kWide8);
  const Workload queries = make_workload(bounds_in_object_space(cooked.tree), {0, 0, 200, 0, 4}, 5);
  const TrueDistances truth = require(true_distances(cooked.tree, queries));
  const ApproximateFigures figures =
      require(measure_approximate(cooked.tree, queries, truth, {false, 0}));
  const auto kPoint = static_cast<std::size_t>(ApproximateKind::kPoint);
  double largest = 0;
  for (const ApproximateStep& step : figures[kPoint].by_budget) {
    largest = std::max(largest, step.error_max);
  }
  EXPECT_GT(largest, 0);
  EXPECT_LE(largest, 1 / kLeastDistance);  // no point is farther than the diagonal from any other
}

// Pairs are taken in an order that the error does not change, so each query by itself takes no
// more of them; closest points without a budget are found depth-first, where only the mean is sure
// to follow. A budget that is larger sees more of the same order: nothing is farther then.
TEST(Approximate, WorkFallsAsTheAllowedErrorGrowsAndErrorsAsTheBudgetDoes) {
  constexpr auto kDistance = static_cast<std::size_t>(ApproximateKind::kDistance);
  for (const TradePoint* point : queried_points()) {
    for (std::size_t kind = 0; kind < kApproximateKinds; ++kind) {
      const ApproximateCurves& curves = point->approximate[kind];
      for (std::size_t i = 1; i < curves.by_error.size(); ++i) {
        EXPECT_GT(curves.by_error[i].relative_error, curves.by_error[i - 1].relative_error);
        EXPECT_LE(curves.by_error[i].nodes_mean, curves.by_error[i - 1].nodes_mean)
            << point->name() << ' ' << kApproximateNames[kind] << ' ' << i;
        if (kind == kDistance) {
          EXPECT_EQ(curves.by_error[i].slower, 0u) << point->name() << ' ' << i;
        }
      }
      EXPECT_LT(curves.by_error.back().nodes_mean, curves.by_error.front().nodes_mean);
      for (std::size_t i = 1; i < curves.by_budget.size(); ++i) {
        const ApproximateStep& less = curves.by_budget[i - 1];
        const ApproximateStep& more = curves.by_budget[i];
        EXPECT_GT(more.node_budget, less.node_budget);
        EXPECT_GE(more.converged, less.converged) << point->name() << ' ' << i;
        EXPECT_GE(more.found, less.found) << point->name() << ' ' << i;
        if (less.found < less.queries) continue;  // of other queries than the next step's
        EXPECT_LE(more.error_max, less.error_max) << point->name() << ' ' << i;
        EXPECT_LE(more.error_median, less.error_median) << point->name() << ' ' << i;
        EXPECT_LE(more.gap_max, less.gap_max + 1e-12) << point->name() << ' ' << i;
      }
    }
  }
}

TEST(Approximate, FalseBoundsAreCounted) {
  const test::CookedTree cooked = test::cook_tree(test::sphere(5, 6), CodecId::kWide8);
  const Workload queries = make_workload(bounds_in_object_space(cooked.tree), {0, 0, 20, 0, 4}, 5);
  TrueDistances lie = require(true_distances(cooked.tree, queries));
  for (auto* truths : {&lie.points, &lie.poses}) {
    for (TrueDistance& truth : *truths) truth = {2.5 * truth.lower, 2.5 * truth.upper};
  }
  const ApproximateFigures figures =
      require(measure_approximate(cooked.tree, queries, lie, {true, 0}));
  for (const ApproximateCurves& curves : figures) {
    for (const ApproximateStep& step : curves.by_error) {
      EXPECT_EQ(step.false_bounds, step.queries) << step.relative_error;
      EXPECT_EQ(step.times.median_ns, 0) << "no times were requested";
    }
  }
}

TEST(ApproximatePage, ShowsEveryStepAndSaysWhatIsPromised) {
  const std::vector<PageSection> sections = approximate_sections(counted_torus());
  ASSERT_EQ(sections.size(), kApproximateKinds);
  for (std::size_t kind = 0; kind < kApproximateKinds; ++kind) {
    const PageSection& section = sections[kind];
    std::size_t by_error = 0;
    std::size_t by_budget = 0;
    for (const TradePoint* point : queried_points()) {
      by_error += point->approximate[kind].by_error.size();
      by_budget += point->approximate[kind].by_budget.size();
    }
    ASSERT_EQ(section.tables.size(), 2u);
    EXPECT_EQ(section.tables[0].rows.size(), by_error);
    EXPECT_EQ(section.tables[1].rows.size(), by_budget);
    for (const PageTable& table : section.tables) {
      for (const auto& row : table.rows) EXPECT_EQ(row.size(), table.columns.size());
    }
    EXPECT_EQ(section.conclusions.size(), 2u);
    EXPECT_EQ(section.conclusions[0].lead, "1 % allowed:");
    // Of what is exact: fewer nodes.
    EXPECT_TRUE(std::regex_search(section.conclusions[0].text,
                                  std::regex(R"(\), 0\.\d\d times as much\.)")))
        << section.conclusions[0].text;
    EXPECT_EQ(section.plots.size(), 3u);
  }
  EXPECT_NE(sections[0].text.find("on average only"), std::string::npos);
  EXPECT_NE(sections[1].text.find("no query takes more"), std::string::npos);
  EXPECT_TRUE(approximate_sections({}).empty());
}

TEST(ApproximateData, JsonAndCsvSayWhatTheStepsSay) {
  TradeoffReport report;
  report.meshes = {counted_torus()};
  const auto json = nlohmann::json::parse(to_json(report));
  const auto& points = json.at("meshes").at(0).at("points");
  std::istringstream lines(approximate_to_csv(report));
  std::string line;
  ASSERT_TRUE(std::getline(lines, line));
  const auto commas = std::count(line.begin(), line.end(), ',');
  for (std::size_t p = 0; p < counted_torus().points.size(); ++p) {
    const TradePoint& point = counted_torus().points[p];
    const bool is_queried = !point.approximate[0].by_error.empty();
    EXPECT_EQ(points[p].at("approximate").is_null(), !is_queried) << point.name();
    if (!is_queried) continue;
    for (std::size_t kind = 0; kind < kApproximateKinds; ++kind) {
      const auto& curves = points[p].at("approximate").at(kApproximateNames[kind]);
      const auto compare = [&](const char* name, const std::vector<ApproximateStep>& steps) {
        ASSERT_EQ(curves.at(name).size(), steps.size());
        for (std::size_t i = 0; i < steps.size(); ++i) {
          EXPECT_EQ(curves.at(name)[i].at("nodes_mean"), steps[i].nodes_mean);
          EXPECT_EQ(curves.at(name)[i].at("error_max"), steps[i].error_max);
          EXPECT_TRUE(curves.at(name)[i].at("times").is_null());
          ASSERT_TRUE(std::getline(lines, line));
          EXPECT_EQ(std::count(line.begin(), line.end(), ','), commas) << line;
          EXPECT_NE(line.find(fmt::format(",,{},", steps[i].nodes_mean)), std::string::npos)
              << line;
        }
      };
      compare("by_error", point.approximate[kind].by_error);
      compare("by_budget", point.approximate[kind].by_budget);
    }
  }
  EXPECT_FALSE(std::getline(lines, line));
}

}  // namespace
}  // namespace boxtree::cooker
