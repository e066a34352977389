// SPDX-License-Identifier: MIT
// `boxtree bench`: times of queries on cooked files.
#include <filesystem>
#include <memory>
#include <vector>

#include <fmt/format.h>

#include <boxtree/cooker/choose/calibrate.h>
#include <boxtree/cooker/cli/output.h>
#include <boxtree/cooker/import/import.h>
#include <boxtree/cooker/report/measure.h>
#include <boxtree/runtime/boxtree.h>

namespace boxtree::cooker {
namespace {

struct Arguments {
  std::vector<std::filesystem::path> files;
  std::size_t runs = 5;
  bool calibrate = false;
  bool quick = false;
  bool json = false;
};

// A tenth of the questions: for a look, not for a figure.
constexpr WorkloadSize kQuick{20'000, 2'000, 2'000, 20};

Result<Json> bench(const std::filesystem::path& path, std::uint32_t index, const Tree& tree,
                   const Arguments& arguments) {
  const Workload workload =
      make_workload(bounds_in_object_space(tree), arguments.quick ? kQuick : WorkloadSize());
  const Result<QueryFigures> figures = measure_queries(tree, workload, arguments.runs);
  if (!figures) return figures.error();
  const Result<OpenFigures> open = measure_open(path, index, 20 * arguments.runs);
  if (!open) return open.error();
  return Json{{"file", path.string()},
              {"tree", tree.name()},
              {"codec", codec_name(tree.codec())},
              {"triangles", tree.record().triangle_count},
              {"ray_ns", figures->ray_ns},
              {"box_ns", figures->box_ns},
              {"point_ns", figures->point_ns},
              {"pair_first_us", figures->pair_first_us},
              {"pair_all_us", figures->pair_all_us},
              {"open_us", open->first_answer_us},
              {"open_alone_us", open->open_us},
              {"open_page_faults", open->page_faults},
              {"ray_hits", figures->ray_hits},
              {"box_faces", figures->box_faces},
              {"point_distance", figures->point_distance},
              {"pair_hits", figures->pair_hits},
              {"pair_pairs", figures->pair_pairs}};
}

void print_row(const Json& row) {
  fmt::print("{} ({}, {}, {} triangles)\n", row["file"].get<std::string>(),
             row["tree"].get<std::string>(), row["codec"].get<std::string>(),
             row["triangles"].get<std::uint32_t>());
  fmt::print("  ray   {:9.0f} ns  {} hits\n", row["ray_ns"].get<double>(),
             row["ray_hits"].get<std::uint64_t>());
  fmt::print("  box   {:9.0f} ns  {} faces\n", row["box_ns"].get<double>(),
             row["box_faces"].get<std::uint64_t>());
  fmt::print("  point {:9.0f} ns  {:.6g} summed distance\n", row["point_ns"].get<double>(),
             row["point_distance"].get<double>());
  fmt::print("  first {:9.1f} us  {} contacts\n", row["pair_first_us"].get<double>(),
             row["pair_hits"].get<std::uint64_t>());
  fmt::print("  all   {:9.1f} us  {} pairs\n", row["pair_all_us"].get<double>(),
             row["pair_pairs"].get<std::uint64_t>());
  fmt::print("  open  {:9.1f} us  to the first answer, {} page faults; {:.1f} us before it\n",
             row["open_us"].get<double>(), row["open_page_faults"].get<std::uint64_t>(),
             row["open_alone_us"].get<double>());
}

Json to_json(const CodecCost& cost) {
  Json json = {{"codec", codec_name(cost.codec)}, {"geometry", geometry_name(cost.geometry)}};
  for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
    const StepCost& step = cost.of_kind[kind];
    json[kQueryNames[kind]] = {
        {"question_ns", step.question}, {"node_ns", step.node}, {"leaf_ns", step.leaf}};
  }
  return json;
}

// A row for each codec and store: nanoseconds of a question, a node and a leaf for each kind.
void print_row(const CodecCost& cost) {
  fmt::print("{:<10} {:<5}", codec_name(cost.codec), geometry_name(cost.geometry));
  for (const StepCost& step : cost.of_kind) {
    fmt::print("  {:8.1f} {:6.2f} {:6.2f}", step.question, step.node, step.leaf);
  }
  fmt::print("\n");
}

int run_calibration(const Arguments& arguments) {
  std::vector<SourceMesh> meshes;
  for (const std::filesystem::path& path : arguments.files) {
    Result<Imported> imported = import_mesh(path);
    if (!imported) return fail(imported.error());
    imported->mesh.name = path.stem().string();
    meshes.push_back(std::move(imported->mesh));
  }
  const Result<Calibration> calibration = calibrate(meshes, arguments.runs);
  if (!calibration) return fail(calibration.error());
  Json costs = Json::array();
  for (const CodecCost& cost : calibration->costs) {
    if (arguments.json) {
      costs.push_back(to_json(cost));
    } else {
      print_row(cost);
    }
  }
  if (arguments.json) {
    print({{"worst_ratio", calibration->worst_ratio}, {"costs", costs}});
  } else {
    fmt::print("modelled and measured times differ by at most {:.2f} times\n",
               calibration->worst_ratio);
  }
  return 0;
}

int run(const Arguments& arguments) {
  if (arguments.calibrate) return run_calibration(arguments);
  Json rows = Json::array();
  for (const std::filesystem::path& path : arguments.files) {
    const Result<File> file = File::open(path);
    if (!file) return fail(file.error());
    for (std::uint32_t i = 0; i < file->tree_count(); ++i) {
      const Result<Tree> tree = Tree::bind(*file, i);
      if (!tree) return fail({tree.code(), path.string() + ": " + tree.error().detail});
      const Result<Json> row = bench(path, i, *tree, arguments);
      if (!row) return fail(row.error());
      if (arguments.json) {
        rows.push_back(*row);
      } else {
        print_row(*row);
      }
    }
  }
  if (arguments.json) print({{"files", rows}});
  return 0;
}

}  // namespace

void add_bench_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *app.add_subcommand("bench", "Time queries on .bxt files");
  command.add_option("files", arguments->files, "Files with geometry inside")->required();
  command
      .add_flag("--calibrate", arguments->calibrate,
                "Measure the constants that auto chooses by; the files are meshes then")
      ->group(kRareOptions);
  command.add_option("--runs", arguments->runs, "Runs whose median counts; one more goes before")
      ->check(CLI::Range(1, 1000))
      ->capture_default_str();
  command.add_flag("--quick", arguments->quick, "A tenth of the questions");
  command.add_flag("--json", arguments->json, "Print one JSON document");
  command.callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace boxtree::cooker
