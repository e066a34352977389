// SPDX-License-Identifier: MIT
// Recommendations first, then plots, the tables behind them, and how they were measured.
#include "cooker/report/tradeoff_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include <fmt/format.h>

#include "cooker/choose/workload.h"
#include "cooker/import/f32_digits.h"
#include "cooker/report/approximate_page.h"
#include "cooker/report/tradeoff_advice.h"
#include "cooker/text/at_most.h"
#include "cooker/text/counted.h"

namespace boxtree::cooker {
namespace {

using Row = std::vector<std::string>;

// boxtree's own codecs first, the largest trees last.
constexpr std::array kSeriesOrder = {CodecId::kWide8,    CodecId::kWide4,     CodecId::kPlainF32,
                                     CodecId::kPlainF16, CodecId::kPackedF32, CodecId::kPackedF16,
                                     CodecId::kDedup,    CodecId::kPackedF64};
static_assert(kSeriesOrder.size() == kCodecs.size());

// The name of a kind on the page, the metric of boxtree_peers, and its unit in nanoseconds.
struct KindWords {
  const char* title;
  const char* query;
  const char* peer_metric;
  double peer_unit_ns;
};
constexpr std::array<KindWords, kTimedKinds> kKinds = {{
    {"Rays", "closest hit of a ray", "ray_median_ns", 1},
    {"Boxes", "all faces in a cube with an edge of 5 % of the diagonal", "box_median_ns", 1},
    {"Closest points", "closest point of the surface", "point_median_ns", 1},
    {"All contacts", "", "pair_all_median_us", 1e3},
    {"First contacts", "first contact of the mesh and its copy", "pair_first_median_us", 1e3},
    {"Casts", "first touch of a sphere with a radius of 1 % of the diagonal along the same line",
     "cast_sphere_median_ns", 1},
    {"Contacts of a sphere",
     "contacts, with point, normal and depth, of a sphere with a diameter of 5 % of the diagonal",
     "", 1},
}};

// What plots have of a point: the measured median, as of other libraries, or the modelled mean.
double plotted_time(const MeshTradeoff& mesh, const TradePoint& point, std::size_t kind) {
  return mesh.timed ? point.times[kind].median_ns : point.modelled[kind];
}

std::string figure(double value) {
  return value == 0 ? "0" : fmt::format("{:.2g}", value);
}
// The largest of some values, or a bound of them: as sentences say it.
std::string largest_figure(double value) {
  return value == 0 ? "0" : at_most(value, 2);
}
std::string signed_percent(double share) {
  return fmt::format("{:+.1f} %", 100 * share);
}

// The area of a mark grows with the bytes, from a minimum size.
double radius_of(double bytes_per_triangle) {
  return std::clamp(1.2 * std::sqrt(bytes_per_triangle), 2.5, 16.0);
}

// The figure of one library's variant for a mesh.
const double* peer_figure(const TradeoffReport& report, const MeshTradeoff& mesh, const PeerRow& of,
                          const std::string& metric) {
  for (const PeerRow& row : report.peers) {
    if (row.mesh == mesh.name && row.library == of.library && row.variant == of.variant &&
        row.metric == metric) {
      return &row.value;
    }
  }
  return nullptr;
}

// One row per library and variant.
std::vector<PeerRow> peers_of(const TradeoffReport& report, const MeshTradeoff& mesh) {
  std::vector<PeerRow> peers;
  for (const PeerRow& row : report.peers) {
    const bool is_known = std::any_of(peers.begin(), peers.end(), [&](const PeerRow& other) {
      return other.library == row.library && other.variant == row.variant;
    });
    if (row.mesh == mesh.name && !is_known) peers.push_back(row);
  }
  return peers;
}

using ErrorOf = std::function<double(const TradePoint&)>;

// A series per codec over its grids, then the front. Exact points are last, where curves of bytes
// end.
std::vector<PagePlot::Series> codec_series(const MeshTradeoff& mesh, std::size_t kind,
                                           const ErrorOf& x_of) {
  std::vector<PagePlot::Series> all;
  for (const CodecId codec : kSeriesOrder) {
    PagePlot::Series series{std::string(codec_name(codec)), {}, PagePlot::Joined::kCurve};
    const auto add = [&](const TradePoint& point) {
      const double each = mesh.per_triangle(point.bytes.total());
      const double time = plotted_time(mesh, point, kind);
      series.points.push_back(
          {x_of(point), time, point.grid_bits == 0 ? "" : std::to_string(point.grid_bits),
           radius_of(each),
           fmt::format("{}: {:.2f} bytes per triangle, {}, surface moved by {}", point.name(), each,
                       time_in_words(time), largest_figure(point.surface_max))});
    };
    for (const bool on_grid : {true, false}) {
      for (const TradePoint& point : mesh.points) {
        const bool belongs = point.codec == codec && point.gates.pass();
        if (belongs && (point.grid_bits != 0) == on_grid) add(point);
      }
    }
    if (!series.points.empty()) all.push_back(std::move(series));
  }
  return all;
}

PagePlot::Series front_of(const std::vector<PagePlot::Series>& all, AxisScale x_scale) {
  std::vector<TwoCosts> costs;
  for (const PagePlot::Series& series : all) {
    for (const PagePlot::Point& point : series.points) {
      // Values without a logarithm are drawn at one place, so they count as equal.
      const double x = x_scale == AxisScale::kLogarithmic ? std::max(point.x, 0.0) : point.x;
      if (point.y > 0) costs.push_back({x, point.y});
    }
  }
  PagePlot::Series front{
      "best so far (Pareto front)", {}, PagePlot::Joined::kStaircase, kPlotColours, false};
  for (const std::size_t i : pareto_front(costs)) {
    front.points.push_back({costs[i].x, costs[i].y, "", 0});
  }
  return front;
}

PagePlot kind_plot(const TradeoffReport& report, const MeshTradeoff& mesh, std::size_t kind,
                   bool against_bytes) {
  const bool is_distance = kind == 2;
  const std::string time = mesh.timed ? "median time, ns" : "time by counted work, ns";
  PagePlot plot;
  plot.x_scale = plot.y_scale = AxisScale::kLogarithmic;
  plot.y_title = time;
  plot.zero_name = "exact";
  if (against_bytes) {
    plot.title = fmt::format("{}: bytes against time", kKinds[kind].title);
    plot.x_title = "bytes per triangle, whole file";
  } else {
    plot.title = fmt::format("{}: error against time", kKinds[kind].title);
    plot.x_title = is_distance ? "largest distance error, share of the diagonal"
                               : "largest move of the surface, share of the diagonal";
  }
  plot.series = codec_series(mesh, kind, [&](const TradePoint& point) {
    if (against_bytes) return mesh.per_triangle(point.bytes.total());
    return is_distance ? point.answers.distance_max : point.surface_max;
  });
  PagePlot::Series others{"other libraries", {}, PagePlot::Joined::kNot, kPlotColours};
  for (const PeerRow& peer : peers_of(report, mesh)) {
    const double* const ns = peer_figure(report, mesh, peer, kKinds[kind].peer_metric);
    const double* const bytes = peer_figure(report, mesh, peer, "total_bytes_per_tri");
    if (ns == nullptr || bytes == nullptr) continue;
    double x = *bytes;
    if (!against_bytes) {
      // These libraries keep the vertices unchanged. Their distances are shares of four diagonals.
      const double* const error = peer_figure(report, mesh, peer, "point_error");
      x = is_distance && error != nullptr ? 4 * *error : 0;
    }
    const double value = *ns * kKinds[kind].peer_unit_ns;
    const std::string name = peer.library + " " + peer.variant;
    others.points.push_back(
        {x, value, name, radius_of(*bytes),
         fmt::format("{}: {:.2f} bytes per triangle, {}", name, *bytes, time_in_words(value))});
  }
  const PagePlot::Series front = front_of(plot.series, plot.x_scale);
  if (!others.points.empty()) plot.series.push_back(others);
  plot.series.push_back(front);
  return plot;
}

// What is timed goes deeper than what is counted.
std::string contacts_meaning(const MeshTradeoff& mesh) {
  return mesh.timed ? fmt::format("all contacts with {}", kPoseMeaning) : kShallowMeaning;
}

PageSection kind_section(const TradeoffReport& report, const MeshTradeoff& mesh, std::size_t kind) {
  PageSection section;
  section.title = fmt::format("{}: {}", mesh.name, kKinds[kind].title);
  section.text = fmt::format(
      "The query: {}. Lower is faster, further left is more faithful or smaller, a larger mark "
      "is more bytes per triangle. A curve follows one codec over its grids; the number at a mark "
      "is the grid's bits. The dashed line is the Pareto front: nothing of ours lies below and to "
      "the left of it.",
      kind == static_cast<std::size_t>(QueryKind::kPair) ? contacts_meaning(mesh)
                                                         : kKinds[kind].query);
  section.plots = {kind_plot(report, mesh, kind, false), kind_plot(report, mesh, kind, true)};
  return section;
}

PageSection advice_section(const MeshTradeoff& mesh) {
  PageSection section;
  section.title = mesh.name + ": what to use";
  section.text = fmt::format(
      "{}, {} vertices, a diagonal of {:.4g} units.{}{}", counted(mesh.triangles, "triangle"),
      mesh.vertices, mesh.diagonal, mesh.is_f64 ? " Positions are f64." : "",
      mesh.skipped > 0
          ? fmt::format(" Without {} of the source.", counted(mesh.skipped, "bad face"))
          : "");
  section.conclusions = advice_in_words(mesh);
  if (mesh.moved_by_f32 > 0) {
    section.conclusions.insert(
        section.conclusions.begin(),
        {"Far from the origin.",
         fmt::format(
             "Reading the mesh as f32 moved a vertex by up to {}. Moves of the surface below "
             "are from there, and a tolerance is of both together; {}.",
             move_in_words(mesh, mesh.moved_by_f32 / mesh.diagonal), remedy_of(mesh.f32_loss))});
  }
  if (std::string disturbance = disturbance_in_words(mesh); !disturbance.empty()) {
    section.conclusions.insert(
        section.conclusions.begin(),
        {"Times were disturbed:", std::move(disturbance) + ". Disturbed times are behind a ~."});
  }
  const auto advice = advise(mesh);
  if (!advice) return section;
  PageTable table{{"choice", "encoding", "bytes / triangle", "without face ids", "of source",
                   "surface moved", "ray", "box", "point", contacts_name(mesh), "slowdown"},
                  {},
                  2};
  const std::vector<double> slower = slowdowns_of(mesh);
  for (const auto& [role, place] :
       {std::pair<const char*, std::size_t>{"balanced", advice->balanced},
        {"smallest", advice->smallest},
        {"fastest exact", advice->fastest_exact},
        {"smallest exact", advice->smallest_exact}}) {
    const TradePoint& point = mesh.points[place];
    Row row = {role,
               point.name(),
               fmt::format("{:.2f}", mesh.per_triangle(point.bytes.total())),
               fmt::format("{:.2f}", mesh.per_triangle(point.bytes.queried())),
               fmt::format("{:.0f} %", 100.0 * static_cast<double>(point.bytes.total()) /
                                           static_cast<double>(mesh.source.total())),
               largest_figure(point.surface_max)};
    for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
      row.push_back(time_in_words(mesh, mean_time_of(mesh, point, kind)));
    }
    row.push_back(fmt::format("{:.2f}", slower[place]));
    table.rows.push_back(std::move(row));
  }
  section.tables = {table};
  const std::string cook_of_mesh =
      fmt::format("boxtree cook{}{}", import_options(mesh),
                  mesh.tolerance ? fmt::format(" --tolerance {}", *mesh.tolerance) : "");
  const auto cooks_own = cooks_choice(mesh, Goal::kBalance);
  if (cooks_own && *cooks_own != advice->balanced) {
    section.conclusions.push_back({fmt::format("Unless told a codec, {} takes {}.", cook_of_mesh,
                                               mesh.points[*cooks_own].name()),
                                   "It counts nodes and geometry alone, where the balanced choice "
                                   "above counts whole files."});
  }
  std::string cooks;
  for (const Goal goal : {Goal::kMemory, Goal::kSpeed, Goal::kBalance}) {
    const auto place = cooks_choice(mesh, goal);
    if (!place) continue;
    cooks += fmt::format("{}{} for {}", cooks.empty() ? "" : ", ", mesh.points[*place].name(),
                         goal_name(goal));
  }
  const bool is_by_work = goes_by_work(mesh);
  section.notes = fmt::format(
      "Every encoding gives the same answers as brute force over its own geometry; on a grid that "
      "geometry is rounded. Sizes are those of whole files with face ids, as the commands make "
      "them; without --strip a file also holds the record of its cook, some 0.3 KB, and the name "
      "of its mesh. Without face "
      "ids, nodes and geometry alone, is the figure \"with geometry\" of boxtree cook. "
      "Unless told a codec, {} chooses by counted work, the same on every machine: "
      "{}. "
      "The choices above go by the {}, by whole files, and by how far a surface "
      "may move, so that they may differ. Only encodings with the same surface, bit for bit, "
      "compete for the fastest. Slowdown: {}, of the {} mean times of rays, boxes ({}), closest "
      "points and contacts ({}).",
      cook_of_mesh, cooks, is_by_work ? "modelled times" : "times on this page", kSlowdownMeaning,
      is_by_work ? "modelled" : "measured", kBoxMeaning,
      is_by_work ? kShallowMeaning : contacts_meaning(mesh));
  section.notes +=
      " A command that names a grid prints the slowdown over arrays of the grid's own vertices.";
  if (is_by_work) {
    section.notes +=
        " The model is of a processor with AVX-512: by AVX2 alone the slowdown of exact and grid "
        "is up to 0.2 more.";
  }
  if (is_by_work && mesh.timed) {
    section.notes += fmt::format(" Times are measured, of {}.", contacts_meaning(mesh));
  } else if (mesh.timed) {
    section.notes += fmt::format(
        " The slowdown that boxtree cook prints is that of the same kinds of queries, but of fewer "
        "of them; it computes times from the work that it counts, and has shallow contacts alone: "
        "{}.",
        kShallowMeaning);
  }
  return section;
}

PageSection bytes_section(const MeshTradeoff& mesh) {
  PageSection section;
  section.title = mesh.name + ": where the bytes go";
  section.text =
      "Bytes per triangle of a whole file, as cook --strip writes it. Nodes are the tree, vertices "
      "and corners the triangles "
      "themselves, face ids the numbers that answers name; the rest is header, records and "
      "padding. "
      "Source arrays are positions and 32-bit corners as a program holds them, without any tree.";
  PageBars bars;
  bars.title = "bytes per triangle by part";
  bars.parts = {"nodes", "vertices", "corners", "face ids", "rest"};
  PageTable table{{"encoding", "nodes", "vertices", "corners", "face ids", "rest", "sum"}, {}};
  const auto add = [&](const std::string& name, const ByteParts& bytes) {
    const std::vector<double> each = {
        mesh.per_triangle(bytes.nodes), mesh.per_triangle(bytes.vertices),
        mesh.per_triangle(bytes.corners), mesh.per_triangle(bytes.face_ids),
        mesh.per_triangle(bytes.rest)};
    bars.bars.push_back({name, each});
    Row row = {name};
    for (const double value : each) row.push_back(fmt::format("{:.2f}", value));
    row.push_back(fmt::format("{:.2f}", mesh.per_triangle(bytes.total())));
    table.rows.push_back(std::move(row));
  };
  add("source arrays", mesh.source);
  for (const CodecId codec : kSeriesOrder) {
    for (const TradePoint& point : mesh.points) {
      if (point.codec == codec) add(point.name(), point.bytes);
    }
  }
  section.bars = {bars};
  section.tables = {table};
  return section;
}

PageSection gates_section(const MeshTradeoff& mesh) {
  PageTable table{{"encoding", "gates", "faces missed", "boxes escaped", "certificate",
                   "surface moved, max", "rms", "promised", "distance error, max", "median",
                   "ray error, median", "flips per million"},
                  {},
                  2};
  for (const TradePoint& point : mesh.points) {
    table.rows.push_back(
        {point.name(), point.gates.pass() ? "pass" : "FAILED", std::to_string(point.gates.missed),
         std::to_string(point.gates.escapes), point.gates.certificate ? "valid" : "invalid",
         largest_figure(point.surface_max), figure(point.surface_rms),
         largest_figure(point.surface_bound), largest_figure(point.answers.distance_max),
         figure(point.answers.distance_median), figure(point.answers.ray_median),
         fmt::format("{:.0f}", point.answers.flips_per_million)});
  }
  return {mesh.name + ": gates and errors",
          "An encoding that misses a face or lets one stick out of a box above it is listed as "
          "failed here and left out of plots and advice. Lengths are shares of the diagonal, "
          "compared with exact geometry; flips are rays that hit one and miss the other.",
          {table},
          {}};
}

PageSection work_section(const MeshTradeoff& mesh) {
  PageSection section;
  section.title = mesh.name + ": work, counted";
  section.text = fmt::format(
      "Nodes decoded and leaves tested for one query, the same on every machine, and how many "
      "more (+) or fewer (-) than in the reference with exact geometry: plain-f32, whose boxes are "
      "exact, for codecs with one triangle per leaf; wide8 for the wide ones, which have a tree of "
      "their "
      "own. Pairs are {}. Fewer is "
      "possible, too: rays and closest points go to the nearest box first, and a grid changes the "
      "mesh that the tree is built on.",
      kShallowMeaning);
  PageTable node_table{{"encoding", "reference"}, {}, 2}, leaf_table = node_table;
  for (const char* kind : kQueryNames) {
    node_table.columns.insert(node_table.columns.end(),
                              {fmt::format("{}: nodes", kind), fmt::format("{}: extra", kind)});
    leaf_table.columns.insert(leaf_table.columns.end(),
                              {fmt::format("{}: leaves", kind), fmt::format("{}: false", kind)});
  }
  for (const TradePoint& point : mesh.points) {
    const Row name = {point.name(), std::string(codec_name(point.reference))};
    Row& of_nodes = node_table.rows.emplace_back(name);
    Row& of_leaves = leaf_table.rows.emplace_back(name);
    for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
      of_nodes.push_back(fmt::format("{:.1f}", point.work[kind].nodes));
      of_nodes.push_back(signed_percent(point.extra_nodes[kind]));
      of_leaves.push_back(fmt::format("{:.2f}", point.work[kind].leaves));
      of_leaves.push_back(signed_percent(point.false_leaf_tests[kind]));
    }
  }
  section.tables = {node_table, leaf_table};
  for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
    for (const bool leaves : {false, true}) {
      PagePlot plot;
      plot.title = fmt::format("{}: {} against time", kKinds[kind].title,
                               leaves ? "false leaf tests" : "extra nodes");
      plot.x_title = leaves ? "leaf tests beyond the reference's, share of them"
                            : "nodes beyond the reference's, share of them";
      plot.y_title = mesh.timed ? "median time, ns" : "time by counted work, ns";
      plot.x_scale = plot.y_scale = AxisScale::kLogarithmic;
      plot.zero_name = "none";
      plot.series = codec_series(mesh, kind, [&](const TradePoint& point) {
        return leaves ? point.false_leaf_tests[kind] : point.extra_nodes[kind];
      });
      for (PagePlot::Series& series : plot.series) series.joined = PagePlot::Joined::kNot;
      plot.series.push_back(front_of(plot.series, plot.x_scale));
      section.plots.push_back(std::move(plot));
    }
  }
  return section;
}

PageSection pages_section(const MeshTradeoff& mesh) {
  PageTable table{{"encoding", "pages in all", "open"}, {}};
  for (const char* kind : {"ray", "box", "point"}) {
    for (const char* what : {"median", "worst"}) {
      table.columns.push_back(fmt::format("{}: {}", kind, what));
    }
  }
  for (const TradePoint& point : mesh.points) {
    const PageFigures& pages = point.pages;
    Row row = {point.name(), std::to_string(pages.file_pages), std::to_string(pages.open)};
    for (const PageCount& count : {pages.ray, pages.box, pages.point}) {
      row.push_back(std::to_string(count.median));
      row.push_back(std::to_string(count.worst));
    }
    table.rows.push_back(std::move(row));
  }
  const auto passing = std::find_if(mesh.points.begin(), mesh.points.end(),
                                    [](const TradePoint& p) { return p.pages.ray.queries > 0; });
  const std::size_t queries = passing == mesh.points.end() ? 0 : passing->pages.ray.queries;
  return {mesh.name + ": pages of a cold file",
          fmt::format("Pages of 4 KiB that one query reads of a mapped file of which nothing was "
                      "read before, opening included: median and worst of {}. Rays come from "
                      "outside; boxes are as large as a leaf, in the middle of leaves, and points "
                      "are there. What a query does not need is not read.",
                      queries),
          {table},
          {}};
}

PageSection times_section(const TradeoffReport& report, const MeshTradeoff& mesh) {
  PageSection section;
  section.title = mesh.name + ": times";
  section.text =
      "Of one query: median, 99th percentile and mean over all queries, each query's time "
      "the least of several runs, on one thread, in memory that is already mapped. Clocks tick in "
      "steps of about 10 ns; the median box touches nothing and ends early.";
  // One table for each, which fits into a window.
  for (const auto& [what, part] :
       {std::pair("median", &KindTimes::median_ns),
        std::pair("99th percentile", &KindTimes::p99_ns), std::pair("mean", &KindTimes::mean_ns)}) {
    PageTable table{{fmt::format("{} by encoding", what)}, {}};
    for (const KindWords& kind : kKinds) table.columns.emplace_back(kind.title);
    for (const TradePoint& point : mesh.points) {
      Row& row = table.rows.emplace_back(Row{point.name()});
      for (const KindTimes& times : point.times) row.push_back(time_in_words(mesh, times.*part));
    }
    section.tables.push_back(std::move(table));
  }
  PageTable peers{{"other library", "variant", "bytes / triangle", "ray", "box", "point",
                   "all contacts", "first contact", "cast", "contacts of a sphere"},
                  {},
                  2};
  for (const PeerRow& peer : peers_of(report, mesh)) {
    Row row = {peer.library, peer.variant};
    const double* const bytes = peer_figure(report, mesh, peer, "total_bytes_per_tri");
    row.push_back(bytes == nullptr ? "" : fmt::format("{:.2f}", *bytes));
    for (const KindWords& kind : kKinds) {
      const double* const time = peer_figure(report, mesh, peer, kind.peer_metric);
      row.push_back(time == nullptr ? "-" : time_in_words(*time * kind.peer_unit_ns));
    }
    peers.rows.push_back(std::move(row));
  }
  if (!peers.rows.empty()) section.tables.push_back(peers);
  return section;
}

PageSection included_section(const IncludedResults& results) {
  PageTable table{{"id", "what", "figure", "limit", "pass"}, {}, 5};
  for (const IncludedRow& row : results.rows) {
    table.rows.push_back({row.id, row.what, row.figure, row.limit, row.pass});
  }
  return {results.title, results.text, {table}, {}};
}

PageSection words_section() {
  return {"Words used here",
          "",
          {{{"word", "meaning"},
            {{"codec", "how the nodes of the tree are stored; all give the same answers"},
             {"wide8, wide4", "our own: eight children a node, 8 or 4 bits for a side of a box"},
             {"plain, packed, dedup", "two children a node, as in the thesis"},
             {"exact", "every position of the mesh, as it was read, is kept bit for bit"},
             {"grid 24", "positions rounded to 2^24 steps over the largest extent"},
             {"tolerance", "positions rounded to the grid of --tolerance"},
             {"diagonal", "of the mesh's bounding box; errors are shares of it"},
             {"gates", "what every file must pass: no face missed, every box holds what is below"},
             {"extra nodes", "nodes decoded beyond those of the reference tree"},
             {"false leaf tests", "leaves tested beyond those of the reference tree"},
             {"allowed error", "an answer may be so much farther than the nearest, and is no more"},
             {"Pareto front", "encodings that no other one beats in both things at once"}},
            2}},
          {}};
}

PageSection machine_section(const TradeoffReport& report) {
  const Surroundings& around = report.surroundings;
  PageTable table{{"", ""}, {}, 2};
  table.rows = {{"command", around.command},
                {"boxtree", around.version},
                {"compiler", around.compiler},
                {"processor", around.processor},
                {"wide codecs walked by", around.instruction_set},
                {"hardware threads", around.threads},
                {"system", around.system}};
  const bool is_timed = std::any_of(report.meshes.begin(), report.meshes.end(),
                                    [](const MeshTradeoff& mesh) { return mesh.timed; });
  if (is_timed) table.rows.push_back({"load when measuring began", around.load});
  PageSection section{"Machine, compiler, command", "", {table}, {}};
  const auto left_out = [&](const std::string& what) {
    section.conclusions.push_back({"Left out:", what});
  };
  if (report.quick) left_out("more than half of the grids and most queries (--quick).");
  if (!report.no_peers.empty()) left_out("other libraries (" + report.no_peers + ").");
  if (report.included.empty()) {
    left_out("stiff contacts and robustness: no results were given with --include.");
  }
  return section;
}

Page page_head(const TradeoffReport& report) {
  Page page;
  std::string names;
  for (const MeshTradeoff& mesh : report.meshes) names += (names.empty() ? "" : ", ") + mesh.name;
  page.title = "Which encoding for " + names + "?";
  page.text =
      "What each encoding of a collision tree costs in bytes and in time, and how far it "
      "is from the original surface. Made by: " +
      report.surroundings.command;
  return page;
}

}  // namespace

Page tradeoff_summary(const TradeoffReport& report) {
  Page page = page_head(report);
  for (const MeshTradeoff& mesh : report.meshes) page.sections.push_back(advice_section(mesh));
  return page;
}

Page tradeoff_page(const TradeoffReport& report) {
  Page page = tradeoff_summary(report);
  for (const MeshTradeoff& mesh : report.meshes) {
    // Work is counted for all contacts alone, so a first contact has no modelled time.
    for (std::size_t kind = 0; kind < (mesh.timed ? kTimedKinds : kQueryKinds); ++kind) {
      page.sections.push_back(kind_section(report, mesh, kind));
    }
    for (PageSection& section : approximate_sections(mesh)) {
      page.sections.push_back(std::move(section));
    }
    page.sections.push_back(bytes_section(mesh));
    page.sections.push_back(gates_section(mesh));
    page.sections.push_back(work_section(mesh));
    page.sections.push_back(pages_section(mesh));
    if (mesh.timed) page.sections.push_back(times_section(report, mesh));
  }
  for (const IncludedResults& results : report.included) {
    page.sections.push_back(included_section(results));
  }
  page.sections.push_back(words_section());
  page.sections.push_back(machine_section(report));
  return page;
}

}  // namespace boxtree::cooker
