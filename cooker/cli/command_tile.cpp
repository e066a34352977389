// SPDX-License-Identifier: MIT
// `boxtree tile`: cuts a world into tiles, and writes the manifest that cooks them.
#include <filesystem>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "cooker/cli/byte_size.h"
#include "cooker/cli/command.h"
#include "cooker/cli/commands.h"
#include "cooker/cli/exit_status.h"
#include "cooker/cli/job_words.h"
#include "cooker/cli/json_output.h"
#include "cooker/cli/output.h"
#include "cooker/cli/standard_streams.h"
#include "cooker/cli/step_printer.h"
#include "cooker/text/counted.h"
#include "cooker/tile/tile_world.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

struct TileArguments {
  TileOptions options;
  std::string memory = "1G";
  std::string grid_step;
  bool quiet = false;
  bool json = false;
};

int run(TileArguments& arguments) {
  TileOptions& options = arguments.options;
  for (const fs::path& source : options.sources) {
    if (is_standard_stream(source)) {
      return usage("tile: sources are read several times: - (standard input) can be read once");
    }
  }
  if (is_standard_stream(options.jobs)) {
    return usage("tile: -o names the manifest, beside which the tiles are: - has no place");
  }
  if (const std::string fault = mesh_name_fault(options.jobs, ".jsonl"); !fault.empty()) {
    return usage("tile: " + fault);
  }
  if (options.jobs.extension() == ".bxt") {
    return usage("tile: -o names the manifest, for cook --manifest: expected " +
                 fs::path(options.jobs).replace_extension(".jsonl").string());
  }
  if (options.folder.empty()) {
    options.folder = options.jobs;
    options.folder.replace_extension();
    if (options.folder == options.jobs) {
      return usage("tile: expected the manifest to end in .jsonl, or --folder for the tiles");
    }
  }
  options.memory = *byte_size(arguments.memory);
  // One rule for all: tiles that chose grids of their own would leave gaps where they meet.
  if (arguments.grid_step.empty()) {
    options.cook_options = {"--exact"};
  } else {
    options.cook_options = {"--grid-step", arguments.grid_step};
  }
  if (const Result<CookJob> job = job_of_words(options.cook_options); !job) {
    return usage("tile: " + job.error().detail);
  }
  StepPrinter step(!arguments.quiet);
  const Result<TileReport> report =
      tile_world(options, [&](const std::string& text) { step("tile: " + text); });
  step.clear();
  if (!report) return fail(report.error());
  if (report->skipped > 0) {
    warn(fmt::format("{} left out by --skip-bad", counted(report->skipped, "bad face")));
  }
  if (arguments.json) {
    print(Json{{"output", options.jobs.string()},
               {"folder", options.folder.string()},
               {"faces", report->faces},
               {"skipped", report->skipped},
               {"triangles", report->triangles},
               {"tiles", report->tiles},
               {"written", report->written},
               {"largest", report->largest},
               {"readings", report->readings}});
  } else if (!arguments.quiet) {
    fmt::print("{}: {} in {}, {} written; cook them with cook --manifest {}\n",
               shown(options.jobs.string()), counted(report->triangles, "triangle"),
               counted(report->tiles, "tile"), report->written, shown(options.jobs.string()));
  }
  return 0;
}

}  // namespace

void add_tile_command(Command& program, int& status) {
  const auto arguments = std::make_shared<TileArguments>();
  TileOptions& options = arguments->options;
  Command& command = program.add_command(
      "tile",
      "Cut a world that is larger than memory into tiles, as jobs of a manifest\n"
      "Binary STL and PLY files are read as streams, other meshes whole. Each face goes to one "
      "tile, the cell of an octree that has the center of its box; cells are aligned to absolute "
      "coordinates, so an edit changes the tiles that it touches. Faces keep their numbers in the "
      "world: those of the first file, then those of the next.");
  command.add_file("WORLD", options.sources, Values::kMeshes, "Mesh files, one after the other")
      ->required();
  command
      .add_file("-o,--output", options.jobs, Values::kFiles,
                "The manifest to write, for cook --manifest")
      ->required();
  command
      .add_option("--triangles-per-tile", options.triangles_per_tile,
                  "A cell with more is split in eight")
      ->type_name("N")
      ->between(1, 1'000'000'000, "1 to 1000000000")
      ->shows_default();
  command
      .add_file("--folder", options.folder, Values::kFolders,
                "Where the tiles are written, and cooked files go [the name of the manifest "
                "without its ending]")
      ->type_name("FOLDER");
  command
      .add_option("--memory", arguments->memory,
                  "The most that it takes, beside 20 MB of the program")
      ->type_name("BYTES")
      ->check(byte_size_fault)
      ->shows_default();
  command
      .add_option("--grid-step", arguments->grid_step,
                  "Tiles are cooked with this --grid-step, which they have in common [else with "
                  "--exact; other options can be added to the lines of the manifest]")
      ->type_name("2^E");
  command.add_flag("--skip-bad", options.skip_bad,
                   "Leave out faces with NaN, infinite or missing vertices; the others keep their "
                   "numbers");
  command.add_flag("-q,--quiet", arguments->quiet, "Print errors only");
  command.add_flag("--json", arguments->json, "Print one JSON document");
  command.example("Tiles of at most 1000 triangles",
                  "boxtree tile bunny.obj --triangles-per-tile 1000 -o tiles.jsonl");
  command.example("Cooked, any part of them on any machine", "boxtree cook --manifest tiles.jsonl");
  command.callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace boxtree::cooker
