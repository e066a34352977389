// SPDX-License-Identifier: MIT
// `boxtree key`: what a cook depends on, without cooking: for caches and build systems.
#include <algorithm>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <oneapi/tbb/blocked_range.h>
#include <oneapi/tbb/parallel_for.h>

#include "cooker/cli/command.h"
#include "cooker/cli/commands.h"
#include "cooker/cli/cook_arguments.h"
#include "cooker/cli/farm_arguments.h"
#include "cooker/cli/farm_report.h"
#include "cooker/cli/json_output.h"
#include "cooker/cli/manifest_jobs.h"
#include "cooker/cli/output.h"
#include "cooker/cli/worker_threads.h"
#include "cooker/farm/cook_key.h"
#include "cooker/import/file_error.h"

namespace boxtree::cooker {
namespace {

struct KeyArguments {
  CookArguments cook;
  FarmArguments farm;
  int jobs = kAllThreads;
  bool inputs = false;
  bool explain = false;
  bool json = false;
};

Json key_json(const CookJob& job, const JobKey& key) {
  Json json = {{"key", hex_of(key.key)}};
  json["output"] = job.output.empty() ? Json(nullptr) : Json(job.output.string());
  json["inputs"] = Json::array();
  for (const auto& [file, digest] : key.files) {
    json["inputs"].push_back({{"file", file.path.string()}, {"sha256", hex_of(digest)}});
  }
  return json;
}

// "KEY OUTPUT INPUT...", with tabs between them, since names have blanks.
void print_line(const CookJob& job, const JobKey& key) {
  std::string line = hex_of(key.key) + "\t" + shown(job.output.string());
  for (const KeyedFile& each : key.files) line += "\t" + shown(each.file.path.string());
  fmt::print("{}\n", line);
}

int print_files(const CookJob& job) {
  const Result<std::vector<JobFile>> files = list_job_files(job);
  if (!files) return fail(files.error());
  for (const JobFile& file : *files) fmt::print("{}\n", shown(file.path.string()));
  return 0;
}

int key_of_one(KeyArguments& arguments) {
  const CookJob& job = arguments.cook.job;
  if (const std::string fault = finish_cook_options(arguments.cook); !fault.empty())
    return usage("key: " + fault);
  if (Status status = take_standard_mesh(arguments.cook); !status) return fail(status.error());
  if (arguments.inputs) return print_files(job);
  const Result<JobKey> key = key_of(job);
  if (!key) return fail(key.error());
  if (arguments.explain) {
    fmt::print("{}", key_text(job, key->files));
  } else if (arguments.json) {
    print(Json{{"jobs", Json::array({key_json(job, *key)})}});
  } else {
    print_line(job, *key);
  }
  return 0;
}

Result<JobKey> key_at(const ManifestJobs& jobs, std::size_t i) {
  try {
    return key_of(jobs.job(i));
  } catch (...) {
    return error_of_job();
  }
}

// The keys of a part of a manifest, side by side.
class Keys {
 public:
  Keys(const ManifestJobs& jobs, std::span<const std::size_t> of) {
    results_.resize(of.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, of.size(), 1), [&](const auto& part) {
      for (std::size_t i = part.begin(); i < part.end(); ++i) results_[i] = key_at(jobs, of[i]);
    });
  }
  const Result<JobKey>& operator[](std::size_t i) const { return *results_[i]; }

 private:
  std::vector<std::optional<Result<JobKey>>> results_;
};

int keys_of_manifest(const KeyArguments& arguments) {
  const Result<ManifestJobs> jobs = ManifestJobs::read(arguments.farm.manifest);
  if (!jobs) return fail(jobs.error());
  // Was checked when it was parsed.
  const std::vector<std::size_t> ours = jobs->of_shard(*shard_from(arguments.farm.shard));
  constexpr std::size_t kPart = 256;  // so that what waits to be printed stays small
  int status = 0;
  Json documents = Json::array();
  for (std::size_t first = 0; first < ours.size(); first += kPart) {
    const std::span<const std::size_t> part =
        std::span(ours).subspan(first, std::min(kPart, ours.size() - first));
    const Keys keys(*jobs, part);
    for (std::size_t i = 0; i < part.size(); ++i) {
      const Result<JobKey>& key = keys[i];
      const std::size_t job = part[i];
      if (!key) {
        const int failed = fail(in_file(jobs->place(job), key.error()));
        if (status == 0) status = failed;
      } else if (arguments.json) {
        documents.push_back(key_json(jobs->job(job), *key));
      } else {
        print_line(jobs->job(job), *key);
      }
    }
  }
  if (arguments.json) print(Json{{"jobs", std::move(documents)}});
  return status;
}

}  // namespace

void add_key_command(Command& program, int& status) {
  const auto arguments = std::make_shared<KeyArguments>();
  Command& command = program.add_command(
      "key",
      "Print what a cook depends on, without cooking\n"
      "One line: the key, which is a SHA-256 of all that can change a byte of the output, of names "
      "of inputs (without folders), of --require-files and of nothing else, the output, and the "
      "files that the cook reads, with tabs between them. Equal keys: equal outputs.");
  declare_cook_options(command, arguments->cook);
  declare_manifest(command, arguments->farm);
  declare_shard(command, arguments->farm);
  Option* const manifest = arguments->farm.manifest_option;
  Option* inputs = command.add_flag("--inputs", arguments->inputs,
                                    "Print the files that the cook reads alone, one a line");
  Option* explain = command.add_flag(
      "--explain", arguments->explain,
      "Print the text that the key is the SHA-256 of, to compare that of another key with");
  explain->excludes(inputs);
  command.add_option("-j,--jobs", arguments->jobs, "Threads; the keys do not depend on it [all]")
      ->type_name("N")
      ->between(1, 1024);
  command.add_flag("--json", arguments->json, "Print one JSON document")
      ->excludes(inputs)
      ->excludes(explain);
  manifest->excludes(arguments->cook.inputs)->excludes(inputs)->excludes(explain);
  for (Option* option : arguments->cook.all) manifest->excludes(option);
  command.example("Of one cook", "boxtree key bunny.obj -o bunny.bxt --tolerance 0.001");
  command.example("What a scene is made of", "boxtree key --profile scene.toml --inputs");
  command.callback([arguments, &status] {
    const bool of_manifest = !arguments->farm.manifest.empty();
    if (!of_manifest) require_source(arguments->cook);
    run_on_threads(arguments->jobs, [&] {
      status = of_manifest ? keys_of_manifest(*arguments) : key_of_one(*arguments);
    });
  });
}

}  // namespace boxtree::cooker
