// SPDX-License-Identifier: MIT
// `boxtree cook`: meshes in, one .bxt file out.
#include <algorithm>
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "cooker/cli/byte_size.h"
#include "cooker/cli/command.h"
#include "cooker/cli/commands.h"
#include "cooker/cli/cook_arguments.h"
#include "cooker/cli/cook_manifest.h"
#include "cooker/cli/cook_report.h"
#include "cooker/cli/farm_arguments.h"
#include "cooker/cli/farm_report.h"
#include "cooker/cli/json_output.h"
#include "cooker/cli/output.h"
#include "cooker/cli/seconds_since.h"
#include "cooker/cli/standard_streams.h"
#include "cooker/cli/step_printer.h"
#include "cooker/cli/worker_threads.h"
#include "cooker/farm/cook_cache.h"
#include "cooker/farm/keyed_cook.h"
#include "cooker/shell/cook_job.h"
#include "cooker/system/process.h"
#include "cooker/write/outputs.h"

namespace boxtree::cooker {
namespace {

using Clock = std::chrono::steady_clock;

struct CookCommandArguments {
  CookArguments cook;
  FarmArguments farm;
  bool why = false;
  bool candidates = false;
  bool json = false;
  bool quiet = false;
  int jobs = kAllThreads;
};

Json report_json(const CookCommandArguments& arguments, const Summary& summary, double seconds) {
  Json json = {{"output", arguments.cook.job.output.string()}};
  if (!arguments.cook.job.reordered.empty())
    json["reordered"] = arguments.cook.job.reordered.string();
  json.update(summary_json(summary));
  json["seconds"] = seconds;
  json["peak_bytes"] = peak_bytes();
  return json;
}

// `output`: the name of what was written.
std::string report_text(const CookCommandArguments& arguments, const std::string& output,
                        const Summary& summary, double seconds) {
  std::string text = summary.scene ? scene_text(summary, arguments.candidates)
                                   : trees_text(summary, arguments.candidates);
  if (arguments.why) text += why_text(summary);
  if (!arguments.cook.job.reordered.empty()) {
    text += fmt::format("wrote {}: face i of the tree is face i of it\n",
                        shown(arguments.cook.job.reordered.string()));
  }
  const std::optional<BlobMethod>& blob = arguments.cook.job.options.blob;
  const char* const whole = !blob ? "" : *blob == BlobMethod::kLzma ? " (xz)" : " (zstd)";
  return text + fmt::format(
                    "wrote {}, {} bytes{}, in {:.2f} s; every triangle proven inside every "
                    "box above it\n",
                    shown(output), summary.file_bytes, whole, seconds);
}

// What is wrong with the command line as a whole; empty if nothing is.
std::string contradiction(CookCommandArguments& arguments) {
  const CookJob& job = arguments.cook.job;
  if (std::string fault = finish_cook_options(arguments.cook); !fault.empty()) return fault;
  if (is_standard_stream(job.output) && arguments.json)
    return "--json and -o - cannot share standard output";
  const bool has_cache = !arguments.farm.cache.empty();
  if (has_cache && (is_standard_stream(job.output) || !job.reordered.empty()))
    return "--cache keeps the one file that -o names: no stream, and none of --write-reordered";
  for (const auto& [output, ending] :
       {std::pair(&job.output, ".bxt"), std::pair(&job.depfile, ".d")}) {
    if (std::string fault = mesh_name_fault(*output, ending); !fault.empty()) return fault;
  }
  return {};
}

// The same of the files that are there.
Status check_files(const CookJob& job) {
  if (Status status = check_job(job); !status) return status;
  if (!job.output_stream) {
    if (Status status = check_replaced(job.output, OutputKind::kCooked); !status) return status;
  }
  return check_replaced(job.depfile, OutputKind::kDepfile);
}

int cook_through_cache(const CookCommandArguments& arguments, const CookCache& cache) {
  const CookJob& job = arguments.cook.job;
  const Clock::time_point start = Clock::now();
  const Result<JobKey> key = key_of(job);
  if (!key) return fail(key.error());
  Result<KeyedOutcome> outcome = Errc::kInternal;
  {
    StepPrinter steps(!arguments.quiet);
    run_on_threads(arguments.jobs, [&] {
      outcome = cook_by_key(job, *key, {&cache, nullptr, arguments.farm.audit, keyed_report},
                            [&steps](const std::string& step) { steps(step); });
    });
  }
  const std::vector<std::string> of_cache = warn_of_cache(&cache);
  if (!outcome) return fail(explained(outcome.error(), job, job.output.string()));
  warn_all(outcome->report);
  if (outcome->difference) return fail_by(*outcome->difference);
  const double seconds = seconds_since(start);
  if (arguments.json) {
    Json document = outcome_json(job.output.string(), key->key, *outcome, seconds);
    add_warnings(of_cache, document);
    print(document);
  } else if (outcome->summary && !arguments.quiet) {
    fmt::print("{}", report_text(arguments, job.output.string(), *outcome->summary, seconds));
  } else if (!arguments.quiet) {
    fmt::print("wrote {}, {} bytes, in {:.2f} s, from the cache\n", shown(job.output.string()),
               outcome->bytes, seconds);
  }
  return 0;
}

int cook_one(CookCommandArguments& arguments) {
  const CookJob& job = arguments.cook.job;
  const Clock::time_point start = Clock::now();
  Result<Summary> cooked = Errc::kInternal;
  {
    StepPrinter steps(!arguments.quiet);
    run_on_threads(arguments.jobs, [&] {
      cooked = cook_job(job, [&steps](const std::string& step) { steps(step); });
    });
  }
  const OutputTarget output(job.output, job.output_stream);
  if (!cooked) return fail(explained(cooked.error(), job, output.title()));
  for (const std::string& warning : warnings_of(*cooked)) warn(warning);
  const double seconds = seconds_since(start);
  if (arguments.json) {
    print(report_json(arguments, *cooked, seconds));
  } else if (!arguments.quiet) {
    tell(output, report_text(arguments, output.title(), *cooked, seconds));
  }
  return 0;
}

// A URL that is none is a fault of the command line.
int cannot_open_cache(const Error& error) {
  if (error.code == Errc::kDocumentInvalid) return usage("cook: --cache: " + error.detail);
  return fail(error);
}

int run(CookCommandArguments& arguments) {
  const FarmArguments& farm = arguments.farm;
  const bool is_one = farm.manifest.empty();
  CookJob& job = arguments.cook.job;
  if (is_url(farm.cache) && farm.cache_size_option->count() > 0)
    return usage("cook: --cache-size is of a folder; a server keeps to a size of its own");
  if (is_one) {
    if (const std::string fault = contradiction(arguments); !fault.empty())
      return usage("cook: " + fault);
    if (Status status = take_standard_mesh(arguments.cook); !status) return fail(status.error());
    const Result<OutputTarget> output = output_target(job.output, "bxt");
    if (!output) return usage("cook: " + output.error().detail);
    job.output = output->path;
    job.output_stream = output->stream;
    if (Status status = check_files(job); !status) return usage("cook: " + status.error().detail);
  }
  std::unique_ptr<CookCache> cache;
  if (!farm.cache.empty()) {
    Result<std::unique_ptr<CookCache>> opened = open_cache(farm.cache, *byte_size(farm.cache_size));
    if (!opened) return cannot_open_cache(opened.error());
    cache = std::move(*opened);
  }
  if (!is_one) {
    return cook_manifest({farm, cache.get(), arguments.jobs, arguments.json, arguments.quiet});
  }
  return cache ? cook_through_cache(arguments, *cache) : cook_one(arguments);
}

}  // namespace

void add_cook_command(Command& program, int& status) {
  const auto arguments = std::make_shared<CookCommandArguments>();
  Command& command = program.add_command(
      "cook",
      "Cook meshes into one .bxt file\n"
      "Positions may be rounded: beside every bit of them auto tries a grid of 24 bits over the "
      "largest extent, and says how far a vertex moved; --exact forbids it.");
  declare_cook_options(command, arguments->cook);
  declare_manifest(command, arguments->farm);
  Option* const manifest = arguments->farm.manifest_option;
  arguments->cook.output->needed(manifest);
  Option* why = command.add_flag(
      "--why", arguments->why,
      "Print each part of the file, its bytes, and what decided that it is there, or not");
  Option* candidates =
      command.add_flag("--candidates", arguments->candidates,
                       "Print all that was tried for each tree, not only what was chosen");
  command.add_option("-j,--jobs", arguments->jobs, "Threads; the bytes do not depend on it [all]")
      ->type_name("N")
      ->between(1, 1024);
  declare_farm_options(command, arguments->farm);
  command.add_flag("--json", arguments->json,
                   "Print one JSON document, of a manifest one line for each job");
  command.add_flag("-q,--quiet", arguments->quiet, "Print errors and warnings only");
  // What a line of a manifest says for itself, and what only a cook of its own knows.
  manifest->excludes(arguments->cook.inputs)->excludes(why)->excludes(candidates);
  for (Option* option : arguments->cook.all) manifest->excludes(option);
  for (Option* option : {why, candidates}) option->excludes(arguments->farm.cache_option);
  command.example("One mesh", "boxtree cook bunny.obj -o bunny.bxt");
  command.example("Vertices may move by 0.001, for the fewest bytes",
                  "boxtree cook bunny.obj -o small.bxt --tolerance 0.001 --for memory");
  command.example("The mesh in the order of the tree, instead of face ids",
                  "boxtree cook bunny.obj -o bunny.bxt --write-reordered ordered.obj");
  command.example("A scene, with what each part takes",
                  "boxtree cook level.gltf -o level.bxt --why");
  command.example("A scene by its profile", "boxtree cook --profile scene.toml -o profiled.bxt");
  command.example("Through a pipe", "boxtree cook - --format obj -o - < bunny.obj > piped.bxt");
  command.example("Many meshes, each once, wherever it was cooked before",
                  "boxtree cook --manifest jobs.jsonl --cache cooked");
  command.callback([arguments, &status] {
    if (arguments->farm.manifest.empty()) require_source(arguments->cook);
    status = run(*arguments);
  });
}

}  // namespace boxtree::cooker
