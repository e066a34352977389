// SPDX-License-Identifier: MIT
// `boxtree bench`: times of queries on cooked files.
#include <algorithm>
#include <filesystem>
#include <memory>
#include <set>
#include <vector>

#include <fmt/format.h>

#include <boxtree/boxtree.h>

#include "cooker/choose/cost_file.h"
#include "cooker/choose/measure.h"
#include "cooker/choose/timed_work.h"
#include "cooker/choose/workload.h"
#include "cooker/cli/command.h"
#include "cooker/cli/commands.h"
#include "cooker/cli/json_output.h"
#include "cooker/cli/open_file.h"
#include "cooker/cli/output.h"
#include "cooker/cli/standard_streams.h"
#include "cooker/import/import.h"
#include "cooker/report/approximate.h"
#include "cooker/report/pages_json.h"
#include "cooker/text/counted.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {
namespace {

struct BenchArguments {
  std::vector<std::filesystem::path> files;
  std::size_t runs = 5;
  bool calibrate = false;
  bool pages = false;
  bool quick = false;
  bool approximate = false;
  bool json = false;
};

// A tenth of the queries: for a look, not for a figure.
constexpr WorkloadSize kWholeWorkload{.camera = 512, .lattice = 32};
constexpr WorkloadSize kQuickWorkload{20'000, 2'000, 2'000, 20, 0, 128, 0, 16};

Result<Json> bench(const std::filesystem::path& path, std::uint32_t index, const Tree& tree,
                   const BenchArguments& arguments, TimedWork& timed_work) {
  const Workload workload = make_workload(bounds_in_object_space(tree),
                                          arguments.quick ? kQuickWorkload : kWholeWorkload);
  const Result<QueryFigures> figures =
      timed_work.add([&] { return measure_queries(tree, workload, arguments.runs); });
  if (!figures) return figures.error();
  const Result<OpenFigures> open = measure_open(path, index, 20 * arguments.runs);
  if (!open) return open.error();
  return Json{{"file", path.string()},
              {"tree", tree.name()},
              {"codec", codec_name(BoundTree::of(tree).codec())},
              {"triangles", tree.triangle_count()},
              {"instruction_set", instruction_set()},
              {"ray_ns", figures->ray_ns},
              {"ray_batch_ns", figures->ray_batch_ns},
              {"camera_ns", figures->camera_ns},
              {"camera_batch_ns", figures->camera_batch_ns},
              {"cast_sphere_ns", figures->cast_sphere_ns},
              {"box_ns", figures->box_ns},
              {"box_batch_ns", figures->box_batch_ns},
              {"point_ns", figures->point_ns},
              {"point_batch_ns", figures->point_batch_ns},
              {"lattice_ns", figures->lattice_ns},
              {"lattice_batch_ns", figures->lattice_batch_ns},
              {"ball_ns", figures->ball_ns},
              {"ball_batch_ns", figures->ball_batch_ns},
              {"pair_first_us", figures->pair_first_us},
              {"pair_all_us", figures->pair_all_us},
              {"open_us", open->first_answer_us},
              {"open_alone_us", open->open_us},
              {"open_page_faults", open->page_faults},
              {"ray_hits", figures->ray_hits},
              {"camera_hits", figures->camera_hits},
              {"cast_sphere_hits", figures->cast_sphere_hits},
              {"box_faces", figures->box_faces},
              {"point_distance", figures->point_distance},
              {"pair_hits", figures->pair_hits},
              {"pair_pairs", figures->pair_pairs}};
}

Json steps_json(const std::vector<ApproximateStep>& steps) {
  Json rows = Json::array();
  for (const ApproximateStep& step : steps) {
    const bool has_budget = step.node_budget != kUnlimitedNodes;
    rows.push_back({{"relative_error", step.relative_error},
                    {"node_budget", has_budget ? Json(step.node_budget) : Json(nullptr)},
                    {"median_ns", step.times.median_ns},
                    {"nodes", step.nodes_mean},
                    {"found", step.found},
                    {"measured_error", step.error_max},
                    {"false_bounds", step.false_bounds}});
  }
  return rows;
}

// Cost against the error that is allowed, and against budgets.
Result<Json> bench_approximate(const std::filesystem::path& path, const Tree& tree,
                               const BenchArguments& arguments) {
  constexpr WorkloadSize kAll{0, 0, 5'000, 0, 100};
  constexpr WorkloadSize kTenth{0, 0, 500, 0, 20};
  const Workload workload =
      make_workload(bounds_in_object_space(tree), arguments.quick ? kTenth : kAll);
  const auto truth = true_distances(tree, workload);
  if (!truth) return truth.error();
  const auto figures = measure_approximate(tree, workload, *truth, {false, arguments.runs});
  if (!figures) return figures.error();
  Json json = {{"file", path.string()},
               {"tree", tree.name()},
               {"codec", codec_name(BoundTree::of(tree).codec())},
               {"triangles", tree.triangle_count()}};
  for (std::size_t kind = 0; kind < kApproximateKinds; ++kind) {
    json["approximate"][kApproximateNames[kind]] = {
        {"by_error", steps_json((*figures)[kind].by_error)},
        {"by_budget", steps_json((*figures)[kind].by_budget)}};
  }
  return json;
}

void print_approximate(const Json& kinds) {
  for (const auto& [kind, curves] : kinds.items()) {
    fmt::print("  {:<16} {:>12} {:>10} {:>14}\n", kind, "median, ns", "nodes", "largest error");
    for (const char* curve : {"by_error", "by_budget"}) {
      for (const Json& row : curves[curve]) {
        const std::string allowed =
            row["node_budget"].is_null()
                ? fmt::format("error {}", row["relative_error"].get<double>())
                : fmt::format("budget {}", row["node_budget"].get<std::uint64_t>());
        const std::string error = row["found"].get<std::uint64_t>() == 0
                                      ? "-"
                                      : fmt::format("{:.2g}", row["measured_error"].get<double>());
        fmt::print("    {:<14} {:12.0f} {:10.1f} {:>14}{}\n", allowed,
                   row["median_ns"].get<double>(), row["nodes"].get<double>(), error,
                   row["false_bounds"].get<std::uint64_t>() == 0 ? "" : "  FALSE BOUNDS");
      }
    }
  }
}

void print_row(const Json& row) {
  fmt::print("{} ({}, {}, {})\n", shown(row["file"].get<std::string>()),
             shown(row["tree"].get<std::string>()), row["codec"].get<std::string>(),
             counted(row["triangles"].get<std::uint32_t>(), "triangle"));
  if (row.contains("approximate")) return print_approximate(row["approximate"]);
  fmt::print(
      "  measured means, wide codecs walked by {}; spheres with a radius of 1 % of the diagonal "
      "are cast along the rays;\n"
      "  boxes are {};\n  contacts are those with {};\n  view is {};\n  near is {};\n"
      "  ball is whether a sphere of that radius around each of them touches anything\n",
      row["instruction_set"].get<std::string>(), kBoxMeaning, kPoseMeaning, kCameraMeaning,
      kLatticeMeaning);
  const auto number = [&](const char* key) { return row[key].get<double>(); };
  const auto of = [&](const char* key, const char* word) {
    return counted(row[key].get<std::uint64_t>(), word);
  };
  fmt::print("  ray   {:9.0f} ns  {}, in batches {:.0f} ns\n", number("ray_ns"),
             of("ray_hits", "hit"), number("ray_batch_ns"));
  fmt::print("  view  {:9.0f} ns  {}, in batches {:.0f} ns\n", number("camera_ns"),
             of("camera_hits", "hit"), number("camera_batch_ns"));
  fmt::print("  cast  {:9.0f} ns  {} of spheres\n", number("cast_sphere_ns"),
             of("cast_sphere_hits", "hit"));
  fmt::print("  box   {:9.0f} ns  {}, in batches {:.0f} ns\n", number("box_ns"),
             of("box_faces", "face"), number("box_batch_ns"));
  fmt::print("  point {:9.0f} ns  {:.6g} summed distance, in batches {:.0f} ns\n",
             number("point_ns"), number("point_distance"), number("point_batch_ns"));
  fmt::print("  near  {:9.0f} ns  in batches {:.0f} ns\n", number("lattice_ns"),
             number("lattice_batch_ns"));
  fmt::print("  ball  {:9.0f} ns  in batches {:.0f} ns\n", number("ball_ns"),
             number("ball_batch_ns"));
  fmt::print("  first {:9.1f} us  {}\n", number("pair_first_us"), of("pair_hits", "contact"));
  fmt::print("  all   {:9.1f} us  {}\n", number("pair_all_us"), of("pair_pairs", "pair"));
  fmt::print(
      "  open  {:9.1f} us  to the first answer, of which opening and binding take {:.1f} us; {}\n",
      number("open_us"), number("open_alone_us"), of("open_page_faults", "page fault"));
}

// A row for each codec and store: nanoseconds of a query, a node and a leaf for each kind.
void print_row(const CodecCost& cost) {
  fmt::print("{:<10} {:<6} {}", codec_name(cost.codec), geometry_name(cost.geometry),
             precision_name(cost.precision));
  for (const StepCost& step : cost.of_kind) {
    fmt::print("  {:8.1f} {:6.2f} {:6.2f}", step.query, step.node, step.leaf);
  }
  fmt::print("\n");
}

int run_calibration(const BenchArguments& arguments) {
  std::vector<SourceMesh> meshes;
  for (const std::filesystem::path& path : arguments.files) {
    Result<Imported> imported = import_mesh(path, careful_import());
    if (!imported) return fail(imported.error());
    imported->mesh.name = path.stem().string();
    meshes.push_back(std::move(imported->mesh));
  }
  std::set<std::size_t> sizes;
  for (const SourceMesh& mesh : meshes) sizes.insert(mesh.faces.size());
  constexpr std::size_t kEnough = 3;
  if (sizes.size() < kEnough) {
    warn(
        fmt::format("constants of so few meshes hold for their like alone: give {} or more, of "
                    "different sizes",
                    kEnough));
  }
  const Result<Calibration> calibration = calibrate(meshes, arguments.runs);
  if (!calibration) return fail(calibration.error());
  if (const std::string warning = disturbed_constants(*calibration); !warning.empty())
    warn(warning);
  if (arguments.json) {
    print(parse_json(costs_to_json(*calibration)).value);
    return 0;
  }
  fmt::print(
      "ns of a query, of a node expanded and of a leaf read, for rays, boxes ({}), points and "
      "pairs ({})\n",
      kBoxMeaning, kShallowMeaning);
  for (const CodecCost& cost : calibration->costs) print_row(cost);
  fmt::print("modelled and measured times differ by at most {:.2f} times\n",
             calibration->worst_ratio);
  return 0;
}

void print_row(const char* kind, const PageCount& count) {
  fmt::print("  {:<5} {:5} at the median, {:5} at worst, of {} queries\n", kind, count.median,
             count.worst, count.queries);
}

void print_row(const FirstRays& first) {
  fmt::print("  levels {:2}, nodes {:6}: {:5} read ahead, {:5} by the rays\n", first.levels,
             first.nodes, first.pages_before, first.pages_more);
}

// What queries read of a file of which nothing has been read.
Result<Json> pages(const std::filesystem::path& path, std::uint32_t index, const Tree& tree,
                   const BenchArguments& arguments) {
  const std::size_t queries = arguments.quick ? 100 : 1000;
  const Result<PageFigures> figures = measure_pages(path, index, queries);
  if (!figures) return figures.error();
  const Result<std::vector<FirstRays>> first_rays = measure_first_rays(path, index, queries);
  if (!first_rays) return first_rays.error();
  if (!arguments.json) {
    fmt::print("{} ({}, {}, {}): {} of 4 KiB\n", shown(path.string()), shown(tree.name()),
               codec_name(BoundTree::of(tree).codec()), counted(tree.triangle_count(), "triangle"),
               counted(figures->file_pages, "page"));
    fmt::print("  pages that are read of a cold file\n  open  {:5}\n", figures->open);
    print_row("ray", figures->ray);
    print_row("box", figures->box);
    print_row("point", figures->point);
    fmt::print("  pages of the first {} rays on one open file, after Tree::prefetch(levels)\n",
               queries);
    for (const FirstRays& first : *first_rays) print_row(first);
  }
  Json rays = Json::array();
  for (const FirstRays& first : *first_rays) rays.push_back(to_json(first));
  return Json{{"file", path.string()},
              {"tree", tree.name()},
              {"codec", codec_name(BoundTree::of(tree).codec())},
              {"triangles", tree.triangle_count()},
              {"pages", to_json(*figures)},
              {"first_rays", {{"rays", queries}, {"prefetched", std::move(rays)}}}};
}

int run(const BenchArguments& arguments) {
  const auto& files = arguments.files;
  if (std::any_of(files.begin(), files.end(), is_standard_stream)) {
    return usage("bench: - (standard input) is no file, and bench times the opening of files, too");
  }
  if (arguments.calibrate) return run_calibration(arguments);
  Json rows = Json::array();
  TimedWork timed_work;
  for (const std::filesystem::path& path : arguments.files) {
    const Result<File> file = map_file(path);
    if (file.code() == Errc::kFeatureUnsupported && open_file(path)) {
      return fail({file.code(), path.string() + ": it is a blob, and bench times files that are "
                                                "mapped; cook it with another codec"});
    }
    if (!file) return fail(file.error());
    for (std::uint32_t i = 0; i < file->tree_count(); ++i) {
      const Result<Tree> tree = Tree::bind(*file, i);
      if (!tree) return fail({tree.code(), path.string() + ": " + tree.error().detail});
      const Result<Json> row = arguments.pages ? pages(path, i, *tree, arguments)
                               : arguments.approximate
                                   ? bench_approximate(path, *tree, arguments)
                                   : bench(path, i, *tree, arguments, timed_work);
      if (!row) return fail(row.error());
      if (arguments.json) {
        rows.push_back(*row);
      } else if (!arguments.pages) {
        print_row(*row);
      }
    }
  }
  const bool is_timed = !arguments.pages && !arguments.approximate;
  if (arguments.json) {
    Json document = {{"files", rows}};
    if (is_timed) {
      document["processor_share"] = timed_work.processor_share();
      document["speed_ratio"] = timed_work.speed_ratio();
    }
    print(document);
  }
  if (const std::string warning = timed_work.warning("times may be wrong"); !warning.empty())
    warn(warning);
  return 0;
}

}  // namespace

void add_bench_command(Command& program, int& status) {
  const auto arguments = std::make_shared<BenchArguments>();
  Command& command = program.add_command("bench", "Time queries on .bxt files");
  command
      .add_file("FILE", arguments->files, Values::kCookedFilesAndMeshes,
                "Files with geometry inside; with --calibrate meshes, three or more")
      ->required();
  Option* calibrate =
      command
          .add_flag(
              "--calibrate", arguments->calibrate,
              "Measure the constants by which `cook` chooses, with --json for its --costs; files "
              "are meshes, three or more of different sizes")
          ->group(kRareOptions);
  command.add_option("--runs", arguments->runs, "Runs whose median counts; one more goes before")
      ->type_name("N")
      ->between(1, 1000, "1 to 1000")
      ->shows_default();
  Option* pages =
      command.add_flag("--pages", arguments->pages,
                       "Count the pages of a cold file that queries read, in place of times");
  command.add_flag("--quick", arguments->quick, "A tenth of the queries");
  Option* approximate =
      command.add_flag("--approximate", arguments->approximate,
                       "Instead: closest points and distances against the error that is allowed");
  approximate->excludes(pages);
  calibrate->excludes(pages)->excludes(approximate);
  command.add_flag("--json", arguments->json, "Print one JSON document");
  command.example("A first impression", "boxtree bench bunny.bxt --quick --runs 1");
  command.example("The constants of this machine, for cook --costs",
                  "boxtree bench --calibrate bunny.obj horse.obj cat.obj --json > costs.json");
  command.callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace boxtree::cooker
