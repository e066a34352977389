// SPDX-License-Identifier: MIT
// boxtree_peers: every codec, the original and other libraries on the same questions in one run,
// each time beside its answers, each answer beside brute force.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <limits>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <boxtree/cooker/import/import.h>
#include <boxtree/cooker/report/measure.h>

#include "tests/bench/exact_answers.h"
#include "tests/bench/libraries.h"

namespace boxtree::bench {
namespace {

struct Arguments {
  std::vector<std::filesystem::path> meshes;
  std::vector<std::string> only;
  std::size_t runs = 5;
  std::size_t tumble_steps = 0;
  double longest_edge = 0;
  std::string builder = "sah";
  std::vector<std::string> questions = {"single", "pairs", "tumble"};
  bool quick = false;
  bool json = false;
};

constexpr cooker::WorkloadSize kFull;
constexpr cooker::WorkloadSize kQuick{20'000, 2'000, 2'000, 20};

// Collects rows of one library on one mesh.
class Rows {
 public:
  Rows(const TriangleMesh& mesh, const Library& library, nlohmann::ordered_json& rows)
      : mesh_(mesh), library_(library), rows_(rows) {}

  void add(const char* metric, double value, const char* unit) {
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

using Ask = std::function<bool(std::span<double>)>;

// A run of one kind of question takes no longer than about this; slow libraries are asked less.
constexpr double kSecondsPerRun = 4;

struct Timed {
  double seconds;     // a question
  std::size_t asked;  // how many of them
};

// Nothing if the library does not know the question. The run that is not counted finds out how many
// questions are affordable; answers to the others are cut off.
std::optional<Timed> time_questions(std::size_t count, std::size_t runs, std::vector<double>& out,
                                    const Ask& ask) {
  out.assign(count, 0);
  if (count == 0 || !ask(std::span(out).first(1))) return std::nullopt;
  std::size_t asked = 1;
  for (bool affordable = true; affordable && asked < count;) {
    const std::size_t more = std::min(count, 2 * asked);
    const double taken = cooker::seconds_taken([&] { ask(std::span(out).first(more)); });
    asked = more;
    affordable = 2 * taken < kSecondsPerRun;
  }
  out.resize(asked);
  std::vector<double> seconds;
  for (std::size_t run = 0; run < runs; ++run) {
    seconds.push_back(cooker::seconds_taken([&] { ask(out); }));
  }
  return Timed{cooker::median(std::move(seconds)) / static_cast<double>(asked), asked};
}

double sum(const std::vector<double>& values) {
  double total = 0;
  for (const double value : values) total += value;
  return total;
}

// In how many of the questions that brute force answered the two differ by more than `slack`.
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

void measure_single(const TriangleMesh& mesh, Subject& subject, const cooker::Workload& workload,
                    const ExactAnswers& exact, std::size_t runs, Rows& rows) {
  // A library in f32 cannot know distances better than this share of the scene.
  const double scene = 4 * mesh.bounds.diagonal().norm();
  const double slack = scene * 1e-5;
  std::vector<double> answers;
  if (const auto time =
          time_questions(workload.rays.size(), runs, answers, [&](std::span<double> out) {
            return subject.rays(std::span(workload.rays).first(out.size()), out);
          })) {
    rows.add("ray_ns", 1e9 * time->seconds, "ns");
    rows.add("ray_asked", static_cast<double>(time->asked), "questions");
    rows.add("ray_hits",
             static_cast<double>(std::count_if(answers.begin(), answers.end(),
                                               [](double t) { return std::isfinite(t); })),
             "hits");
    rows.add("ray_checked", checked(answers, exact.rays), "questions");
    rows.add("ray_wrong", count_wrong(answers, exact.rays, slack), "questions");
    rows.add("ray_error", largest_error(answers, exact.rays) / scene, "of the scene");
  }
  if (const auto time =
          time_questions(workload.boxes.size(), runs, answers, [&](std::span<double> out) {
            return subject.boxes(std::span(workload.boxes).first(out.size()), out);
          })) {
    rows.add("box_ns", 1e9 * time->seconds, "ns");
    rows.add("box_asked", static_cast<double>(time->asked), "questions");
    rows.add("box_tris", sum(answers), "triangles");
    rows.add("box_checked", checked(answers, exact.boxes), "questions");
    rows.add("box_wrong", count_wrong(answers, exact.boxes, 0), "questions");
  }
  if (const auto time =
          time_questions(workload.points.size(), runs, answers, [&](std::span<double> out) {
            return subject.points(std::span(workload.points).first(out.size()), out);
          })) {
    rows.add("point_ns", 1e9 * time->seconds, "ns");
    rows.add("point_asked", static_cast<double>(time->asked), "questions");
    rows.add("point_distance", sum(answers), "summed");
    rows.add("point_checked", checked(answers, exact.points), "questions");
    rows.add("point_wrong", count_wrong(answers, exact.points, slack), "questions");
    rows.add("point_error", largest_error(answers, exact.points) / scene, "of the scene");
  }
}

void measure_pairs(Subject& subject, const cooker::Workload& workload, const ExactAnswers& exact,
                   std::size_t runs, Rows& rows) {
  std::vector<double> answers;
  if (const auto time =
          time_questions(workload.poses.size(), runs, answers, [&](std::span<double> out) {
            return subject.first_contacts(std::span(workload.poses).first(out.size()), out);
          })) {
    std::vector<double> touching = exact.pairs;
    for (double& count : touching) count = count > 0 ? 1 : 0;
    rows.add("pair_first_us", 1e6 * time->seconds, "us");
    rows.add("pair_first_asked", static_cast<double>(time->asked), "questions");
    rows.add("pair_hits", sum(answers), "contacts");
    rows.add("pair_checked", checked(answers, exact.pairs), "questions");
    rows.add("pair_first_wrong", count_wrong(answers, touching, 0), "questions");
  }
  if (const auto time =
          time_questions(workload.poses.size(), runs, answers, [&](std::span<double> out) {
            return subject.all_pairs(std::span(workload.poses).first(out.size()), out);
          })) {
    rows.add("pair_all_us", 1e6 * time->seconds, "us");
    rows.add("pair_all_asked", static_cast<double>(time->asked), "questions");
    rows.add("pair_pairs", sum(answers), "pairs");
    rows.add("pair_all_wrong", count_wrong(answers, exact.pairs, 0), "questions");
    rows.add("pair_all_error", excess(answers, exact.pairs), "pairs too many");
  }
}

// Protocol P1: 20 distances from 2.0 to 0.6 half extents, `steps` turns at each.
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
  std::vector<double> answers;
  const auto measure = [&](bool first_only) {
    const std::string name = first_only ? "tumble_first_" : "tumble_all_";
    const Ask ask = [&](std::span<double> out) {
      const auto part = std::span(poses).first(out.size());
      return first_only ? subject.first_contacts(part, out) : subject.all_pairs(part, out);
    };
    const auto time = time_questions(poses.size(), runs, answers, ask);
    if (!time) return;
    const auto each = [&](double total) { return total / static_cast<double>(time->asked); };
    rows.add((name + "us").c_str(), 1e6 * time->seconds, "us");
    rows.add((name + "asked").c_str(), static_cast<double>(time->asked), "questions");
    rows.add((name + (first_only ? "hits" : "pairs")).c_str(), sum(answers),
             first_only ? "contacts" : "pairs");
    if (counter) {
      counter->start();
      ask(answers);
      rows.add((name + "cache_misses").c_str(), each(static_cast<double>(counter->stop())),
               "a query (processor)");
    }
    CacheModel cache;
    const std::optional<PairWork> work =
        subject.pair_work(std::span(poses).first(time->asked), first_only, cache);
    if (!work) return;
    rows.add((name + "node_pairs").c_str(), each(static_cast<double>(work->node_pairs)), "a query");
    rows.add((name + "leaf_tests").c_str(), each(static_cast<double>(work->leaf_tests)), "a query");
    rows.add((name + "level1_misses").c_str(), each(static_cast<double>(cache.level1_misses())),
             "a query (simulated)");
    rows.add((name + "level2_misses").c_str(), each(static_cast<double>(cache.level2_misses())),
             "a query (simulated)");
  };
  measure(true);
  measure(false);
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
  measure_pairs(*subject, workload, exact, arguments.runs, rows);
  measure_tumble(*subject, tumble, arguments.runs, rows);
}

// Questions that are not wanted are none.
cooker::WorkloadSize workload_size(const Arguments& arguments) {
  cooker::WorkloadSize size = arguments.quick ? kQuick : kFull;
  const auto wanted = [&](const char* kind) {
    const auto& kinds = arguments.questions;
    return std::find(kinds.begin(), kinds.end(), kind) != kinds.end();
  };
  if (!wanted("single")) size.rays = size.boxes = size.points = 0;
  if (!wanted("pairs")) size.poses = 0;
  return size;
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
    const ExactAnswers exact = exact_answers(mesh, workload);
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
  CLI::App app(
      "Sizes, times and answers of all codecs, the original and other libraries, in one run");
  app.add_option("meshes", arguments.meshes, "Mesh files")->required();
  app.add_option("--only", arguments.only, "A library, or library:variant; may be repeated [all]")
      ->allow_extra_args(false);
  app.add_option("--runs", arguments.runs, "Runs whose median counts; one more goes before")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  app.add_option("--questions", arguments.questions,
                 "single (rays, boxes, points), pairs or tumble; may be repeated [all]")
      ->allow_extra_args(false)
      ->check(CLI::IsMember({"single", "pairs", "tumble"}));
  app.add_option("--tumble", arguments.tumble_steps,
                 "Protocol P1 with so many turns at each of 20 distances [none]");
  app.add_option("--longest-edge", arguments.longest_edge, "Scale the bounds of meshes to this");
  app.add_option("--builder", arguments.builder, "Builder of our trees")
      ->check(CLI::IsMember({"sah", "paper"}))
      ->capture_default_str();
  app.add_flag("--quick", arguments.quick, "A tenth of the questions");
  app.add_flag("--json", arguments.json, "Print one JSON document");
  CLI11_PARSE(app, argc, argv);
  try {
    return boxtree::bench::run(arguments);
  } catch (const std::exception& error) {
    fmt::print(stderr, "boxtree_peers: {}\n", error.what());
    return 4;
  }
}
