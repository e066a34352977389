// SPDX-License-Identifier: MIT
// Every figure comes from the steps; captions distinguish guarantees from observations.
#include "cooker/report/approximate_page.h"

#include <algorithm>
#include <array>
#include <functional>
#include <string>

#include <fmt/format.h>

#include "cooker/report/tradeoff_advice.h"

namespace boxtree::cooker {
namespace {

using Row = std::vector<std::string>;
using Steps = std::vector<ApproximateStep>;
using ValueOf = std::function<double(const ApproximateStep&)>;

struct ApproximateWords {
  const char* title;
  const char* one;  // a query
  const char* queries;
  const char* promise;
};
constexpr std::array<ApproximateWords, kApproximateKinds> kApproximateWords = {
    {{"closest points, approximately", "a closest point",
      "Points in 1.2 times the bounds of the mesh.",
      "Nodes: this walk is depth-first, so theory promises less work for a larger error on average "
      "only. A single query may take more, if a nearer triangle that would have cut the walk "
      "short was not worth looking at; the table counts such queries as slower. A budget bounds "
      "the worst case: its walk is best-first, one box at a time, and in the median slower than "
      "the walk without one."},
     {"distances, approximately", "a distance",
      "The mesh and a copy of it, turned at random, 1.05, 1.2, 1.5 or 2 times as far away as their "
      "turned bounding boxes touch: apart, always.",
      "Nodes (pairs of them): the walk takes pairs in an order that does not depend on the error "
      "allowed, so no query takes more of them when more is allowed, as long as 2048 waiting "
      "pairs suffice; the table counts queries for which they did not as slower."}}};

std::string share(double value) {
  return value == 0 ? "0" : fmt::format("{:.3g} %", 100 * value);
}

// The encodings that were queried, in the order of kApproximateCodecs.
std::vector<const TradePoint*> queried_points(const MeshTradeoff& mesh) {
  std::vector<const TradePoint*> points;
  for (const CodecId codec : kApproximateCodecs) {
    for (const TradePoint& point : mesh.points) {
      const bool is_queried = !point.approximate[0].by_error.empty();
      if (point.codec == codec && is_queried) points.push_back(&point);
    }
  }
  return points;
}

std::string allowed(const ApproximateStep& step) {
  if (step.node_budget != kUnlimitedNodes) return fmt::format("{} nodes", step.node_budget);
  return step.relative_error == 0 ? "none" : share(step.relative_error);
}

PagePlot::Series series_of(const std::string& name, const Steps& steps, const ValueOf& x,
                           const ValueOf& y) {
  PagePlot::Series series{name, {}, PagePlot::Joined::kCurve};
  for (const ApproximateStep& step : steps) {
    const bool is_exact = step.node_budget != kUnlimitedNodes && step.converged == step.queries;
    if (step.found == 0 || is_exact) continue;  // no error to show, or only rounding
    series.points.push_back({x(step), y(step), "", 4,
                             fmt::format("{}, allowed {}: {:.3g}", name, allowed(step), y(step))});
  }
  return series;
}

double error_allowed(const ApproximateStep& step) {
  return step.relative_error;
}
double nodes_allowed(const ApproximateStep& step) {
  return static_cast<double>(step.node_budget);
}

PagePlot cost_plot(const std::vector<const TradePoint*>& points, std::size_t kind, bool of_time) {
  PagePlot plot;
  plot.title = of_time ? "Allowed error against time" : "Allowed error against nodes";
  plot.x_title = "allowed relative error";
  plot.y_title = of_time ? "median time, ns" : "nodes of a query, mean";
  plot.x_scale = plot.y_scale = AxisScale::kLogarithmic;
  plot.zero_name = "none";
  for (const TradePoint* point : points) {
    plot.series.push_back(series_of(std::string(codec_name(point->codec)),
                                    point->approximate[kind].by_error, error_allowed,
                                    [&](const ApproximateStep& step) {
                                      return of_time ? step.times.median_ns : step.nodes_mean;
                                    }));
  }
  return plot;
}

// The allowed, stated and true errors of one encoding.
PagePlot error_plot(const TradePoint& point, std::size_t kind, bool by_budget) {
  Steps steps = by_budget ? point.approximate[kind].by_budget : point.approximate[kind].by_error;
  if (!by_budget) steps.erase(steps.begin());  // no error allowed: only rounding remains
  const auto x = by_budget ? nodes_allowed : error_allowed;
  PagePlot plot;
  plot.title = by_budget ? fmt::format("{}: budget against error", codec_name(point.codec))
                         : fmt::format("{}: allowed and measured error", codec_name(point.codec));
  plot.x_title = by_budget ? "budget, nodes" : "allowed relative error";
  plot.y_title = "share of the true distance";
  plot.x_scale = plot.y_scale = AxisScale::kLogarithmic;
  if (!by_budget) {
    PagePlot::Series bound = series_of("the bound", steps, x, error_allowed);
    bound.marks = false;
    bound.colour = kPlotColours;
    plot.series.push_back(std::move(bound));
  }
  plot.series.push_back(series_of(by_budget ? "largest stated: upper - lower" : "largest stated",
                                  steps, x,
                                  [](const ApproximateStep& step) { return step.gap_max; }));
  plot.series.push_back(series_of("largest measured", steps, x,
                                  [](const ApproximateStep& s) { return s.error_max; }));
  plot.series.push_back(series_of("median measured", steps, x,
                                  [](const ApproximateStep& step) { return step.error_median; }));
  return plot;
}

PageTable table_of(const MeshTradeoff& mesh, const std::vector<const TradePoint*>& points,
                   std::size_t kind, bool by_budget) {
  PageTable table{{"encoding", by_budget ? "budget" : "allowed"}, {}, 1};
  if (mesh.timed) {
    table.columns.insert(table.columns.end(), {"median time", "p99"});
  }
  table.columns.insert(table.columns.end(),
                       {"nodes, mean", "error, max", "error, median", "stated, max"});
  if (by_budget) {
    table.columns.insert(table.columns.end(), {"found", "converged", "false bounds"});
  } else {
    table.columns.insert(table.columns.end(), {"false bounds", "slower"});
  }
  for (const TradePoint* point : points) {
    const ApproximateCurves& curves = point->approximate[kind];
    for (const ApproximateStep& step : by_budget ? curves.by_budget : curves.by_error) {
      Row row = {point->name(), allowed(step)};
      if (mesh.timed) {
        row.push_back(time_in_words(mesh, step.times.median_ns));
        row.push_back(time_in_words(mesh, step.times.p99_ns));
      }
      const auto of_all = [&](std::size_t count) {
        return fmt::format("{} of {}", count, step.queries);
      };
      const auto error = [&](double value) { return step.found == 0 ? "-" : share(value); };
      row.insert(row.end(), {fmt::format("{:.1f}", step.nodes_mean), error(step.error_max),
                             error(step.error_median), error(step.gap_max)});
      if (by_budget) row.insert(row.end(), {of_all(step.found), of_all(step.converged)});
      row.push_back(std::to_string(step.false_bounds));
      if (!by_budget) row.push_back(std::to_string(step.slower));
      table.rows.push_back(std::move(row));
    }
  }
  return table;
}

double cost_of(const MeshTradeoff& mesh, const ApproximateStep& step) {
  return goes_by_work(mesh) ? step.nodes_mean : step.times.median_ns;
}

// The effect of one allowed error, in the first encoding.
PageConclusion conclusion_of(const MeshTradeoff& mesh, const TradePoint& point, std::size_t kind,
                             const ApproximateStep& step) {
  const ApproximateStep& exact = point.approximate[kind].by_error.front();
  const auto cost = [&](const ApproximateStep& of) {
    return goes_by_work(mesh) ? fmt::format("{:.1f} nodes", cost_of(mesh, of))
                              : time_in_words(cost_of(mesh, of));
  };
  return {fmt::format("{} allowed:", share(step.relative_error)),
          fmt::format(
              "{} takes {} instead of {} ({}), {:.2f} times as much. The answers were at most "
              "{} above the true distance, {} in the median, and {} of {} bounds were "
              "false.",
              kApproximateWords[kind].one, cost(step), cost(exact), point.name(),
              cost_of(mesh, step) / std::max(cost_of(mesh, exact), 1e-300), share(step.error_max),
              share(step.error_median), step.false_bounds, step.queries)};
}

PageSection section_of(const MeshTradeoff& mesh, const std::vector<const TradePoint*>& points,
                       std::size_t kind) {
  PageSection section;
  section.title = fmt::format("{}: {}", mesh.name, kApproximateWords[kind].title);
  section.text = fmt::format(
      "{} Exact geometry. An answer is [lower, upper], and the true distance lies between them, "
      "whatever was allowed. With an allowed error E the walk ends when upper <= lower * (1 + E); "
      "with a budget it ends after so many nodes, with what it knows by then. Measured is how far "
      "upper was from the distance that plain-f32 finds with no error allowed; stated is upper - "
      "lower; both as shares of the true distance, or of a thousandth of the diagonal where that "
      "is "
      "more, over the answers that found a triangle. The "
      "largest may come near the bound; the median is far below it, often 0 and then not drawn: "
      "the "
      "first triangle met is often the nearest, and what costs is the proof. {}",
      kApproximateWords[kind].queries, kApproximateWords[kind].promise);
  for (const double error : {0.01, 0.1}) {
    for (const ApproximateStep& step : points.front()->approximate[kind].by_error) {
      if (step.relative_error == error) {
        section.conclusions.push_back(conclusion_of(mesh, *points.front(), kind, step));
      }
    }
  }
  if (mesh.timed) section.plots.push_back(cost_plot(points, kind, true));
  section.plots.push_back(cost_plot(points, kind, false));
  section.plots.push_back(error_plot(*points.front(), kind, false));
  section.plots.push_back(error_plot(*points.front(), kind, true));
  section.tables = {table_of(mesh, points, kind, false), table_of(mesh, points, kind, true)};
  return section;
}

}  // namespace

std::vector<PageSection> approximate_sections(const MeshTradeoff& mesh) {
  const std::vector<const TradePoint*> points = queried_points(mesh);
  if (points.empty()) return {};
  std::vector<PageSection> sections;
  for (std::size_t kind = 0; kind < kApproximateKinds; ++kind) {
    sections.push_back(section_of(mesh, points, kind));
  }
  return sections;
}

}  // namespace boxtree::cooker
