// SPDX-License-Identifier: MIT
// `boxtree merge`: one scene over cooked tiles.
#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/cli/command.h"
#include "cooker/cli/commands.h"
#include "cooker/cli/exit_status.h"
#include "cooker/cli/json_output.h"
#include "cooker/cli/manifest_jobs.h"
#include "cooker/cli/open_file.h"
#include "cooker/cli/output.h"
#include "cooker/cli/standard_streams.h"
#include "cooker/cli/step_printer.h"
#include "cooker/text/counted.h"
#include "cooker/tile/merge_world.h"
#include "cooker/tile/stale_tile.h"
#include "cooker/write/outputs.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

struct MergeArguments {
  std::vector<fs::path> files;
  fs::path manifest;
  fs::path output;
  bool quiet = false;
  bool json = false;
};

// A blob is refused: trees are queried where they are mapped.
Result<File> open_tile(const fs::path& path) {
  Result<OpenedFile> opened = open_file(path);
  if (!opened) return opened.error();
  if (opened->blob_bytes == 0) return std::move(opened->file);
  return Error{Errc::kFeatureUnsupported,
               input_name(path) +
                   ": expected a file that can be mapped, found a compressed one; "
                   "cook it with another codec"};
}

Status check_output(const MergeArguments& arguments, const OutputTarget& output) {
  if (output.stream) return {};
  if (const std::string fault = mesh_name_fault(output.path, ".bxt"); !fault.empty()) {
    return Error{Errc::kWriteFailed, fault};
  }
  std::vector<fs::path> inputs = arguments.files;
  if (!arguments.manifest.empty()) inputs.push_back(arguments.manifest);
  if (Status status = check_outputs(std::array{Output{output.path}}, inputs); !status) {
    return status;
  }
  return check_replaced(output.path, OutputKind::kCooked);
}

std::string cook_command(const MergeArguments& arguments) {
  return "boxtree cook --manifest " + shown(arguments.manifest.string());
}

// Adds what makes a tile of the manifest that is missing.
Error explained(const MergeArguments& arguments, const Error& error) {
  if (arguments.manifest.empty() || error.code != Errc::kFileNotFound) return error;
  return {error.code, error.detail + "; " + cook_command(arguments) + " makes it"};
}

// Refuses a tile that is not of its sources as they are now. The number of those that cannot be
// compared.
Result<std::size_t> check_sources(const MergeArguments& arguments, const ManifestJobs& jobs,
                                  StepPrinter& step) {
  using Comparison = SourceComparison::Result;
  std::size_t unchecked = 0;
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    step(fmt::format("merge: sources of file {} of {}", i + 1, jobs.size()));
    const CookJob job = jobs.job(i);
    const Result<File> tile = open_tile(job.output);
    if (!tile) return tile.error();
    const Result<SourceComparison> compared = compare_with_sources(job, *tile);
    if (!compared) return compared.error();
    if (compared->result == Comparison::kDiffers) {
      return Error{Errc::kFileUnreadable,
                   fmt::format("{}: {}: {}; cook it again: {}", jobs.place(i), job.output.string(),
                               compared->difference, cook_command(arguments))};
    }
    if (compared->result == Comparison::kUnknown) ++unchecked;
  }
  return unchecked;
}

int run(MergeArguments& arguments) {
  if (is_standard_stream(arguments.output) && arguments.json) {
    return usage("merge: --json and -o - cannot share standard output");
  }
  std::optional<ManifestJobs> jobs;
  if (!arguments.manifest.empty()) {
    Result<ManifestJobs> read = ManifestJobs::read(arguments.manifest);
    if (!read) return fail(read.error());
    jobs.emplace(std::move(*read));
    for (std::size_t i = 0; i < jobs->size(); ++i) arguments.files.push_back(jobs->job(i).output);
  }
  if (arguments.files.empty()) return usage("merge: expected tiles, found none");
  const Result<OutputTarget> output = output_target(arguments.output, "bxt");
  if (!output) return usage("merge: " + output.error().detail);
  if (Status status = check_output(arguments, *output); !status) {
    return usage("merge: " + status.error().detail);
  }
  StepPrinter step(!arguments.quiet);
  std::size_t unchecked = arguments.files.size();
  if (jobs) {
    const Result<std::size_t> checked = check_sources(arguments, *jobs, step);
    step.clear();
    if (!checked) return fail(explained(arguments, checked.error()));
    unchecked = *checked;
    if (unchecked > 0) {
      warn(
          fmt::format("{}: {} of {} not compared with the sources, which are not here, or the "
                      "tile has no cook record (--strip)",
                      input_name(arguments.manifest), unchecked, counted(jobs->size(), "tile")));
    }
  }
  const Result<MergeReport> report =
      merge_world(*output, arguments.files, open_tile,
                  [&](const std::string& text) { step("merge: " + text); });
  step.clear();
  if (!report) return fail(explained(arguments, report.error()));
  if (arguments.json) {
    print(Json{{"output", output->title()},
               {"bytes", report->bytes},
               {"trees", report->trees},
               {"faces", report->faces},
               {"triangles", report->triangles},
               {"unchecked", unchecked}});
  } else if (!arguments.quiet) {
    tell(*output, fmt::format("{}: {} in {}, {} bytes\n", shown(output->title()),
                              counted(report->triangles, "triangle"),
                              counted(report->trees, "tree"), report->bytes));
  }
  return 0;
}

}  // namespace

void add_merge_command(Command& program, int& status) {
  const auto arguments = std::make_shared<MergeArguments>();
  Command& command = program.add_command(
      "merge",
      "Make one scene of the tiles of a world, without cooking\n"
      "The output is a .bxt file with all trees of the tiles, and a scene that has each of them "
      "where it is. Queries of the scene answer what those of one tree of the world would: faces "
      "have their numbers in the world, and of several at one distance the smallest counts. "
      "Nothing is read of a tile that no query reaches.");
  Option* const files = command.add_file("FILE", arguments->files, Values::kCookedFiles,
                                         "Cooked tiles; @LIST: those that the lines of LIST name");
  Option* const manifest =
      command.add_file("--manifest", arguments->manifest, Values::kFiles,
                       "The outputs of this manifest, as tile has written it, in their order");
  files->one_is_needed();
  manifest->one_is_needed()->excludes(files);
  command
      .add_file("-o,--output", arguments->output, Values::kFiles,
                "What to write, or - for standard output")
      ->required();
  command.add_flag("-q,--quiet", arguments->quiet, "Print errors only");
  command.add_flag("--json", arguments->json, "Print one JSON document");
  command.example("The tiles of a manifest", "boxtree merge --manifest tiles.jsonl -o world.bxt");
  command.callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace boxtree::cooker
