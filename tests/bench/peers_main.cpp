// SPDX-License-Identifier: MIT
// boxtree_peers: every codec, the original and other libraries on the same queries in one run. Each
// time is listed with its answers, and each answer is compared with brute force.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "cooker/choose/measure.h"
#include "cooker/import/import.h"
#include "tests/bench/exact_answers.h"
#include "tests/bench/libraries.h"
#include "tests/support/program_options.h"

namespace boxtree::bench {
namespace {

struct Arguments {
  std::vector<std::filesystem::path> meshes;
  std::vector<std::string> only;
  std::size_t runs = 5;
  std::size_t tumble_steps = 0;
  double longest_edge = 0;
  std::string builder = "sah";
  std::vector<std::string> queries = {"single", "shapes", "pairs", "distances", "tumble"};
  bool quick = false;
  bool answers = false;
  bool json = false;
};

constexpr cooker::WorkloadSize kFull{.camera = 512, .segments = 200'000};
constexpr cooker::WorkloadSize kQuick{20'000, 2'000, 2'000, 20, 20, 128, 20'000};
constexpr cooker::WorkloadSize kAnswers{2'000, 300, 300, 20, 20, 32, 2'000};

const cooker::WorkloadSize& full_size(const Arguments& arguments) {
  if (arguments.answers) return kAnswers;
  return arguments.quick ? kQuick : kFull;
}

// Collects rows of one library on one mesh.
class Rows {
 public:
  Rows(const TriangleMesh& mesh, const Library& library, nlohmann::ordered_json& rows)
      : mesh_(mesh), library_(library), rows_(rows) {}

  void add(const std::string& metric, double value, const std::string& unit) {
    rows_.push_back({{"mesh", mesh_.name},
                     {"triangles", mesh_.triangles.size()},
                     {"library", library_.name},
                     {"variant", library_.variant},
                     {"metric", metric},
                     {"value", value},
                     {"unit", unit}});
  }

 private:
  const TriangleMesh& mesh_;
  const Library& library_;
  nlohmann::ordered_json& rows_;
};

// Approximate limit of a run of one kind of query; slow libraries run fewer queries.
constexpr double kSecondsPerRun = 4;

double sum(const std::vector<double>& values) {
  double total = 0;
  for (const double value : values) total += value;
  return total;
}

// The number of queries answered by brute force whose answers differ by more than `slack`.
double count_wrong(const std::vector<double>& found, const std::vector<double>& exact,
                   double slack) {
  double wrong = 0;
  for (std::size_t i = 0; i < std::min(found.size(), exact.size()); ++i) {
    const bool same = found[i] == exact[i] || std::abs(found[i] - exact[i]) <= slack;
    wrong += same ? 0 : 1;
  }
  return wrong;
}

double largest_error(const std::vector<double>& found, const std::vector<double>& exact) {
  double largest = 0;
  for (std::size_t i = 0; i < std::min(found.size(), exact.size()); ++i) {
    if (std::isfinite(found[i]) && std::isfinite(exact[i])) {
      largest = std::max(largest, std::abs(found[i] - exact[i]));
    }
  }
  return largest;
}

double checked(const std::vector<double>& found, const std::vector<double>& exact) {
  return static_cast<double>(std::min(found.size(), exact.size()));
}

double excess(const std::vector<double>& found, const std::vector<double>& exact) {
  double more = 0;
  for (std::size_t i = 0; i < std::min(found.size(), exact.size()); ++i)
    more += found[i] - exact[i];
  return more;
}

double count_finite(const std::vector<double>& values) {
  return static_cast<double>(std::count_if(values.begin(), values.end(),
                                           [](double value) { return std::isfinite(value); }));
}

// Names and units of one kind of query in reports.
struct Kind {
  std::string name;   // of its rows
  std::string unit;   // of its time
  std::string total;  // the row of the sum of all answers
  std::string total_unit;
  double (*total_of)(const std::vector<double>&) = sum;
  bool is_batch = false;  // a query has no time of its own
};

template <class Query>
using QueryFunction = bool (Subject::*)(std::span<const Query>, std::span<double>);

// The median over single queries in seconds; each query's time is the least of the runs. Uses the
// wall clock, which is much faster to read than a thread's processor time.
template <class Query>
double median_of_each(Subject& subject, QueryFunction<Query> query, std::span<const Query> queries,
                      std::span<double> answers, std::size_t runs) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> least(queries.size(), std::numeric_limits<double>::infinity());
  for (std::size_t run = 0; run < runs; ++run) {
    for (std::size_t i = 0; i < queries.size(); ++i) {
      const Clock::time_point start = Clock::now();
      (subject.*query)(queries.subspan(i, 1), answers.subspan(i, 1));
      const std::chrono::duration<double> taken = Clock::now() - start;
      least[i] = std::min(least[i], taken.count());
    }
  }
  return cooker::median(std::move(least));
}

// Times one kind of query and adds the rows of time and answers. Empty if the library does not have
// the query. An untimed run finds the number of affordable queries; other answers are dropped.
template <class Query>
std::optional<std::vector<double>> run_query(Subject& subject, QueryFunction<Query> query,
                                             const std::vector<Query>& queries, const Kind& kind,
                                             std::size_t runs, Rows& rows) {
  std::vector<double> answers(queries.size());
  const auto first_query = [&](std::size_t count) {
    return (subject.*query)(std::span(queries).first(count), std::span(answers).first(count));
  };
  if (queries.empty() || !first_query(1)) return std::nullopt;
  std::size_t query_count = 1;
  for (bool affordable = true; affordable && query_count < queries.size();) {
    const std::size_t more = std::min(queries.size(), 2 * query_count);
    const double taken = cooker::seconds_taken([&] { first_query(more); });
    query_count = more;
    affordable = 2 * taken < kSecondsPerRun;
  }
  answers.resize(query_count);
  std::vector<double> seconds;
  for (std::size_t run = 0; run < runs; ++run) {
    seconds.push_back(cooker::seconds_taken([&] { first_query(query_count); }));
  }
  const double each = cooker::median(std::move(seconds)) / static_cast<double>(query_count);
  rows.add(kind.name + "_" + kind.unit, (kind.unit == "ns" ? 1e9 : 1e6) * each, kind.unit);
  if (!kind.is_batch) {
    const double middle = median_of_each(subject, query, std::span(queries).first(query_count),
                                         std::span(answers), runs);
    rows.add(kind.name + "_median_" + kind.unit, (kind.unit == "ns" ? 1e9 : 1e6) * middle,
             kind.unit);
  }
  rows.add(kind.name + "_queries", static_cast<double>(query_count), "queries");
  rows.add(kind.total, kind.total_of(answers), kind.total_unit);
  return answers;
}

// The same rays one by one and in batches.
void measure_rays(Subject& subject, const std::vector<Ray>& rays, const std::string& name,
                  const std::vector<double>& exact, double scene, std::size_t runs, Rows& rows) {
  const double slack = scene * 1e-5;
  for (const bool is_batch : {false, true}) {
    const std::string kind = is_batch ? name + "_batch" : name;
    const auto found =
        run_query(subject, is_batch ? &Subject::ray_batches : &Subject::rays, rays,
                  {kind, "ns", kind + "_hits", "hits", count_finite, is_batch}, runs, rows);
    if (!found) continue;
    rows.add(kind + "_checked", checked(*found, exact), "queries");
    rows.add(kind + "_wrong", count_wrong(*found, exact, slack), "queries");
    rows.add(kind + "_error", largest_error(*found, exact) / scene, "of the scene");
  }
}

void measure_single(const TriangleMesh& mesh, Subject& subject, const cooker::Workload& workload,
                    const ExactAnswers& exact, std::size_t runs, Rows& rows) {
  // A library in f32 cannot resolve distances below this share of the scene.
  const double scene = 4 * mesh.bounds.diagonal().norm();
  const double slack = scene * 1e-5;
  measure_rays(subject, workload.rays, "ray", exact.rays, scene, runs, rows);
  measure_rays(subject, workload.camera, "camera", exact.camera, scene, runs, rows);
  if (subject.ends_rays()) {
    measure_rays(subject, workload.segments, "segment", exact.segments, scene, runs, rows);
  }
  if (const auto found =
          run_query(subject, &Subject::casts, casts_of(workload, ShapeKind::kSphere),
                    {"cast_sphere", "ns", "cast_sphere_hits", "hits", count_finite}, runs, rows)) {
    rows.add("cast_sphere_checked", checked(*found, exact.sphere_casts), "queries");
    rows.add("cast_sphere_wrong", count_wrong(*found, exact.sphere_casts, slack), "queries");
    rows.add("cast_sphere_error", largest_error(*found, exact.sphere_casts) / scene,
             "of the scene");
  }
  if (const auto found = run_query(subject, &Subject::boxes, workload.boxes,
                                   {"box", "ns", "box_tris", "triangles"}, runs, rows)) {
    rows.add("box_checked", checked(*found, exact.boxes), "queries");
    rows.add("box_wrong", count_wrong(*found, exact.boxes, 0), "queries");
  }
  if (const auto found = run_query(subject, &Subject::points, workload.points,
                                   {"point", "ns", "point_distance", "summed"}, runs, rows)) {
    rows.add("point_checked", checked(*found, exact.points), "queries");
    rows.add("point_wrong", count_wrong(*found, exact.points, slack), "queries");
    rows.add("point_error", largest_error(*found, exact.points) / scene, "of the scene");
  }
}

// Other casts, and shapes at rest near the surface.
void measure_shapes(const TriangleMesh& mesh, Subject& subject, const cooker::Workload& workload,
                    std::size_t count, const ExactAnswers& exact, std::size_t runs, Rows& rows) {
  struct Shape {
    ShapeKind kind;
    std::string name;
  };
  for (const auto& [kind, shape] :
       {Shape{ShapeKind::kSphere, "sphere"}, Shape{ShapeKind::kCapsule, "capsule"},
        Shape{ShapeKind::kCube, "cube"}}) {
    if (kind != ShapeKind::kSphere) {  // those are among the single queries
      static_cast<void>(run_query(
          subject, &Subject::casts, casts_of(workload, kind),
          {"cast_" + shape, "ns", "cast_" + shape + "_hits", "hits", count_finite}, runs, rows));
    }
    const std::vector<PlacedShape> placed = shapes_on(mesh, workload, count, kind);
    const auto found = run_query(
        subject, &Subject::overlaps, placed,
        {"overlap_" + shape, "ns", "overlap_" + shape + "_tris", "triangles"}, runs, rows);
    if (found && kind == ShapeKind::kSphere) {
      rows.add("overlap_sphere_checked", checked(*found, exact.spheres), "queries");
      rows.add("overlap_sphere_wrong", count_wrong(*found, exact.spheres, 0), "queries");
    }
    static_cast<void>(run_query(
        subject, &Subject::contacts, placed,
        {"collide_" + shape, "ns", "collide_" + shape + "_contacts", "contacts"}, runs, rows));
  }
}

void measure_pairs(Subject& subject, const cooker::Workload& workload, const ExactAnswers& exact,
                   std::size_t runs, Rows& rows) {
  if (const auto found = run_query(subject, &Subject::first_contacts, workload.poses,
                                   {"pair_first", "us", "pair_hits", "contacts"}, runs, rows)) {
    std::vector<double> touching = exact.pairs;
    for (double& count : touching) count = count > 0 ? 1 : 0;
    rows.add("pair_checked", checked(*found, exact.pairs), "queries");
    rows.add("pair_first_wrong", count_wrong(*found, touching, 0), "queries");
  }
  if (const auto found = run_query(subject, &Subject::all_pairs, workload.poses,
                                   {"pair_all", "us", "pair_pairs", "pairs"}, runs, rows)) {
    rows.add("pair_all_wrong", count_wrong(*found, exact.pairs, 0), "queries");
    rows.add("pair_all_error", excess(*found, exact.pairs), "pairs too many");
  }
}

// Queries without and with an allowed error: results may exceed the true distance by that error.
void measure_distances(const TriangleMesh& mesh, Subject& subject, const cooker::Workload& workload,
                       const ExactAnswers& exact, std::size_t runs, Rows& rows) {
  // A library in double cannot resolve distances below a few roundings of its coordinates.
  const double slack = 1e-12 * mesh.bounds.diagonal().norm();
  struct Allowed {
    const char* name;
    double error;
  };
  for (const Allowed& allowed : {Allowed{"distance", 0}, Allowed{"distance_1_percent", 0.01},
                                 Allowed{"distance_10_percent", 0.1}}) {
    std::vector<DistanceRequest> queries;
    for (const Pose& pose : workload.apart) queries.push_back({pose, allowed.error});
    const std::string name = allowed.name;
    const auto found = run_query(subject, &Subject::distances, queries,
                                 {name, "us", name + "_sum", "summed"}, runs, rows);
    if (!found) return;
    double wrong = 0;
    double largest = 0;
    for (std::size_t i = 0; i < std::min(found->size(), exact.distances.size()); ++i) {
      const double truth = exact.distances[i];
      const bool holds =
          (*found)[i] >= truth - slack && (*found)[i] <= truth * (1 + allowed.error) + slack;
      wrong += holds ? 0 : 1;
      largest = std::max(largest, std::abs((*found)[i] - truth) / truth);
    }
    rows.add(name + "_checked", checked(*found, exact.distances), "queries");
    rows.add(name + "_wrong", wrong, "queries");
    rows.add(name + "_error", largest, "of the distance");
  }
}

// Protocol P1: 20 distances from 2.0 to 0.6 half extents, `steps` rotations at each.
std::vector<Pose> all_tumble_poses(const TriangleMesh& mesh, std::size_t steps) {
  constexpr std::size_t kDistances = 20;
  constexpr double kFar = 2.0;
  constexpr double kNear = 0.6;
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < kDistances; ++i) {
    const double distance =
        kFar + (kNear - kFar) * static_cast<double>(i) / static_cast<double>(kDistances - 1);
    const std::vector<Pose> turns = cooker::tumble_poses(mesh.bounds, distance, steps);
    poses.insert(poses.end(), turns.begin(), turns.end());
  }
  return poses;
}

void measure_tumble(Subject& subject, const std::vector<Pose>& poses, std::size_t runs,
                    Rows& rows) {
  const std::optional<CacheMissCounter> counter = CacheMissCounter::open();
  const auto measure = [&](bool first_only) {
    const std::string name = first_only ? "tumble_first" : "tumble_all";
    const QueryFunction<Pose> query = first_only ? &Subject::first_contacts : &Subject::all_pairs;
    const Kind kind = first_only ? Kind{name, "us", name + "_hits", "contacts"}
                                 : Kind{name, "us", name + "_pairs", "pairs"};
    auto found = run_query(subject, query, poses, kind, runs, rows);
    if (!found) return;
    const auto affordable = std::span(poses).first(found->size());
    const auto add = [&](const char* metric, std::uint64_t total, const char* unit) {
      rows.add(name + metric, static_cast<double>(total) / static_cast<double>(affordable.size()),
               unit);
    };
    if (counter) {
      counter->start();
      (subject.*query)(affordable, *found);
      add("_cache_misses", counter->stop(), "a query (processor)");
    }
    CacheModel cache;
    const std::optional<PairWork> work = subject.pair_work(affordable, first_only, cache);
    if (!work) return;
    add("_node_pairs", work->node_pairs, "a query");
    add("_leaf_tests", work->leaf_tests, "a query");
    add("_level1_misses", cache.level1_misses(), "a query (simulated)");
    add("_level2_misses", cache.level2_misses(), "a query (simulated)");
  };
  measure(true);
  measure(false);
}

// Kinds of queries that are not selected get a count of zero.
bool is_selected(const Arguments& arguments, const char* kind) {
  const auto& kinds = arguments.queries;
  return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
}

std::size_t shape_count(const Arguments& arguments) {
  if (!is_selected(arguments, "shapes")) return 0;
  return full_size(arguments).boxes;
}

cooker::WorkloadSize workload_size(const Arguments& arguments) {
  cooker::WorkloadSize size = full_size(arguments);
  if (!is_selected(arguments, "single")) size.boxes = size.points = size.camera = size.segments = 0;
  if (!is_selected(arguments, "single") && !is_selected(arguments, "shapes")) size.rays = 0;
  if (!is_selected(arguments, "pairs")) size.poses = 0;
  if (!is_selected(arguments, "distances")) size.apart = 0;
  return size;
}

void measure_library(const TriangleMesh& mesh, const Library& library,
                     const cooker::Workload& workload, const ExactAnswers& exact,
                     const std::vector<Pose>& tumble, const Arguments& arguments,
                     nlohmann::ordered_json& out) {
  Rows rows(mesh, library, out);
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  const std::unique_ptr<Subject> subject = library.build(mesh);
  const std::chrono::duration<double, std::milli> build = Clock::now() - start;
  const auto triangles = static_cast<double>(mesh.triangles.size());
  const SubjectBytes bytes = subject->bytes();
  rows.add("tree_bytes_per_tri", bytes.tree / triangles, "bytes");
  rows.add("total_bytes_per_tri", bytes.total / triangles, "bytes");
  rows.add("build_ms", build.count(), "ms");
  if (const auto open = subject->open(arguments.runs)) {
    rows.add("open_us", open->micros, "us");
    rows.add("file_bytes_per_tri", open->file_bytes / triangles, "bytes");
    rows.add("resident_bytes_per_tri", open->resident_bytes / triangles, "bytes");
  }
  measure_single(mesh, *subject, workload, exact, arguments.runs, rows);
  if (const std::size_t count = shape_count(arguments)) {
    measure_shapes(mesh, *subject, workload, count, exact, arguments.runs, rows);
  }
  measure_pairs(*subject, workload, exact, arguments.runs, rows);
  measure_distances(mesh, *subject, workload, exact, arguments.runs, rows);
  measure_tumble(*subject, tumble, arguments.runs, rows);
}

bool is_wanted(const Library& library, const std::vector<std::string>& only) {
  return only.empty() || std::find(only.begin(), only.end(), library.name) != only.end() ||
         std::find(only.begin(), only.end(), library.name + ":" + library.variant) != only.end();
}

int run(const Arguments& arguments) {
  for (const std::string& name : missing_libraries()) {
    fmt::print(stderr, "boxtree_peers: {} is not installed here, skipped\n", name);
  }
  const auto builder =
      arguments.builder == "paper" ? cooker::Builder::kPaper : cooker::Builder::kSah;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const std::filesystem::path& path : arguments.meshes) {
    const Result<cooker::Imported> imported = cooker::import_mesh(path);
    if (!imported) {
      fmt::print(stderr, "boxtree_peers: {}\n", imported.error().message());
      return error_info(imported.code()).exit_status;
    }
    const TriangleMesh mesh =
        make_triangle_mesh(imported->mesh, path.stem().string(), arguments.longest_edge);
    const cooker::Workload workload = cooker::make_workload(mesh.bounds, workload_size(arguments));
    const ExactAnswers exact = exact_answers(mesh, workload, shape_count(arguments));
    const std::vector<Pose> tumble = all_tumble_poses(mesh, arguments.tumble_steps);
    for (const Library& library : all_libraries(builder)) {
      if (!is_wanted(library, arguments.only)) continue;
      const std::size_t first = rows.size();
      fmt::print(stderr, "{}: {} {}\n", mesh.name, library.name, library.variant);
      measure_library(mesh, library, workload, exact, tumble, arguments, rows);
      for (std::size_t i = first; i < rows.size() && !arguments.json; ++i) {
        fmt::print("{:14} {:9} {:11} {:26} {:14.6g} {}\n", mesh.name, library.name, library.variant,
                   rows[i]["metric"].get<std::string>(), rows[i]["value"].get<double>(),
                   rows[i]["unit"].get<std::string>());
      }
    }
  }
  if (arguments.json) fmt::print("{}\n", nlohmann::ordered_json{{"rows", rows}}.dump(1));
  return 0;
}

}  // namespace
}  // namespace boxtree::bench

int main(int argc, char** argv) {
  boxtree::bench::Arguments arguments;
  boxtree::test::ProgramOptions program(
      "Sizes, times and answers of all codecs, the original and other libraries, in one run");
  program.add("meshes", arguments.meshes, "Mesh files").required();
  program.add("--only", arguments.only, "A library, or library:variant; may be repeated [all]")
      .one_value_each();
  program.add("--runs", arguments.runs, "Runs whose median counts; one more goes before")
      .between(1, 1000)
      .shows_default();
  program
      .add("--queries", arguments.queries,
           "single (rays, casts of spheres, boxes, points), shapes (other casts, overlaps "
           "and contacts "
           "of shapes), pairs, distances or tumble; may be repeated [all]")
      .one_value_each()
      .one_of({"single", "shapes", "pairs", "distances", "tumble"});
  program.add("--tumble", arguments.tumble_steps,
              "Protocol P1 with so many turns at each of 20 distances [none]");
  program.add("--longest-edge", arguments.longest_edge, "Scale the bounds of meshes to this");
  program.add("--builder", arguments.builder, "Builder of our trees")
      .one_of({"sah", "paper"})
      .shows_default();
  program.add_flag("--quick", arguments.quick, "A tenth of the queries");
  program.add_flag("--answers", arguments.answers,
                   "So few queries that times mean nothing, to see who answers what");
  program.add_flag("--json", arguments.json, "Print one JSON document");
  if (const std::optional<int> status = program.parse(argc, argv)) return *status;
  try {
    return boxtree::bench::run(arguments);
  } catch (const std::exception& error) {
    fmt::print(stderr, "boxtree_peers: {}\n", error.what());
    return 4;
  }
}
