// SPDX-License-Identifier: MIT
#include "cooker/cli/cook_manifest.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdio>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/cli/byte_size.h"
#include "cooker/cli/cook_report.h"
#include "cooker/cli/exit_status.h"
#include "cooker/cli/farm_report.h"
#include "cooker/cli/json_output.h"
#include "cooker/cli/manifest_jobs.h"
#include "cooker/cli/output.h"
#include "cooker/cli/seconds_since.h"
#include "cooker/cli/standard_streams.h"
#include "cooker/cli/step_printer.h"
#include "cooker/cli/worker_threads.h"
#include "cooker/farm/job_memory.h"
#include "cooker/farm/keyed_cook.h"
#include "cooker/farm/run_within.h"
#include "cooker/import/file_error.h"
#include "cooker/system/path.h"
#include "cooker/system/process.h"
#include "cooker/write/outputs.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using How = KeyedOutcome::How;

std::uint64_t memory_of(const FarmArguments& farm) {
  if (!farm.memory.empty()) return *byte_size(farm.memory);  // was checked when it was parsed
  return memory_bytes() / 2;
}

// Each shard has one, since a journal is one process's at a time. Empty: there is none.
fs::path journal_of(const FarmArguments& farm, const Shard& shard) {
  if (!farm.journal.empty()) return farm.journal;
  if (is_standard_stream(farm.manifest)) return {};
  fs::path journal = farm.manifest;
  if (shard.count > 1) journal += fmt::format(".{}-of-{}", shard.number, shard.count);
  journal += ".done";
  return journal;
}

// A journal is added to: what is none would be damaged. Error: kWriteFailed.
Status check_journal(const fs::path& journal, const fs::path& manifest) {
  if (Status status = check_replaced(journal, OutputKind::kJournal); !status) return status;
  const Output output{journal};
  return check_outputs({&output, 1}, {&manifest, 1});
}

// What became of one job.
struct Line {
  std::size_t job;
  double seconds = 0;
  std::optional<Digest> key;
  std::optional<KeyedOutcome> outcome;
  Error error;
  bool differs = false;  // the error is what an audit has found

  [[nodiscard]] int status() const {
    return differs ? kExitDifference : error_info(error.code).exit_status;
  }
};

class Counts {
 public:
  void add(const Line& line) {
    if (!line.outcome) {
      ++failed_;
      statuses_[static_cast<std::size_t>(line.status())] = true;
      may_pass_ = may_pass_ || may_pass(line.error);
    } else {
      ++of_[static_cast<std::size_t>(line.outcome->how)];
      if (line.outcome->is_audited) ++audited_;
    }
  }

  [[nodiscard]] std::size_t done() const { return of_[0] + of_[1] + of_[2] + failed_; }

  [[nodiscard]] std::size_t audited() const { return audited_; }

  // What an audit has found comes first: another run finds it no more. Then errors that may pass:
  // another run does their jobs.
  [[nodiscard]] int exit_status() const {
    if (statuses_[kExitDifference]) return kExitDifference;
    if (may_pass_) return kExitInputOutput;
    for (const int status : {kExitInternal, kExitBadInput, kExitUnsupported, kExitUsage}) {
      if (statuses_[static_cast<std::size_t>(status)]) return status;
    }
    // For a reason that stays.
    return statuses_[kExitInputOutput] ? kExitBadInput : 0;
  }

  [[nodiscard]] std::string text() const {
    return fmt::format("{} cooked, {} from the cache, {} there already, {} failed",
                       of_[static_cast<std::size_t>(How::kCooked)],
                       of_[static_cast<std::size_t>(How::kFromCache)],
                       of_[static_cast<std::size_t>(How::kThere)], failed_);
  }

 private:
  std::array<std::size_t, 3> of_{};  // by KeyedOutcome::How
  std::size_t failed_ = 0;
  std::size_t audited_ = 0;
  std::array<bool, kExitDifference + 1> statuses_{};
  bool may_pass_ = false;
};

class Run {
 public:
  Run(const ManifestRun& run, const ManifestJobs& jobs, const Shard& shard, Journal* journal)
      : run_(run), jobs_(jobs), ours_(jobs.of_shard(shard)), steps_(!run.quiet) {
    stores_.cache = run.cache;
    stores_.journal = journal;
    stores_.trusts_states = !run.farm.reread;
    stores_.audit_share = run.farm.audit;
    stores_.report = keyed_report;
  }

  int work() {
    run_on_threads(run_.threads, [this] {
      run_within({ours_.size(), memory_of(run_.farm),
                  [this](std::size_t i) { return estimated_memory(jobs_.job(ours_[i])); },
                  [this](std::size_t i) { cook(ours_[i]); },
                  [this] { return run_.farm.fail_fast && has_failed_; }});
    });
    return counts_.exit_status();
  }

  [[nodiscard]] std::string text() const {
    const std::string audit =
        run_.farm.audit > 0 ? fmt::format(", {} audited and alike", counts_.audited()) : "";
    return fmt::format("{}: {}{} in {:.2f} s\n", shown(input_name(run_.farm.manifest)),
                       counts_.text(), audit, seconds_since(start_));
  }

 private:
  // Called by any thread.
  void cook(std::size_t number) {
    const Clock::time_point start = Clock::now();
    Line line{number};
    try {
      cook_into(line);
    } catch (...) {
      line.error = error_of_job();
    }
    line.seconds = seconds_since(start);
    const std::lock_guard lock(telling_);
    counts_.add(line);
    tell(line);
    show_progress();
  }

  void cook_into(Line& line) {
    const CookJob job = jobs_.job(line.job);
    const Result<JobKey> key = key_of_job(job);
    if (key) line.key = key->key;
    if (!key) {
      line.error = key.error();
      return;
    }
    if (Status status = check_replaced(job.output, OutputKind::kCooked); !status) {
      line.error = status.error();
      return;
    }
    // As many folders as the sources have. What fails fails again, with words, at the output.
    std::error_code ignored;
    make_folders(job.output.parent_path(), ignored);
    Result<KeyedOutcome> outcome = cook_by_key(job, *key, stores_);
    if (outcome && outcome->difference) {
      line.error = *outcome->difference;
      line.differs = true;
    } else if (outcome) {
      line.outcome = std::move(*outcome);
      line.outcome->summary.reset();
    } else {
      line.error = explained(outcome.error(), job, job.output.string());
    }
  }

  // By what the journal remembers of the inputs if the output is there, too. Else by reading them:
  // what is cooked, or taken from a cache, depends on bytes alone.
  [[nodiscard]] Result<JobKey> key_of_job(const CookJob& job) const {
    Journal* const journal = stores_.journal;
    if (journal == nullptr || run_.farm.reread) return key_of(job);
    bool is_remembered = false;
    const auto digest_of = [&](const fs::path& file) {
      return journal->digest_of(file, &is_remembered);
    };
    const auto list_files = [&](const fs::path& mesh, const ImportOptions& options) {
      if (!may_refer_to_files(mesh)) return list_source_files(mesh, options);
      const auto find = [&] { return find_source_files(mesh, options); };
      return journal->files_of(mesh, find, &is_remembered);
    };
    Result<JobKey> key = key_of(job, digest_of, list_files);
    if (key && is_remembered && !journal->find(job.output, key->key, true)) return key_of(job);
    return key;
  }

  void tell(const Line& line) {
    const std::string place = jobs_.place(line.job);
    steps_.clear();
    const std::vector<std::string> of_cache = warn_of_cache(run_.cache);
    if (!line.outcome) {
      has_failed_ = true;
      const Error error = in_file(place, line.error);
      if (line.differs) {
        static_cast<void>(fail_by(error));
      } else {
        complain(error.message());
      }
    } else {
      warn_all(line.outcome->report, place);
    }
    if (!run_.json) return;
    Json document = to_json(line);
    add_warnings(of_cache, document);
    fmt::print("{}\n", line_of(std::move(document)));
    static_cast<void>(std::fflush(stdout));  // a run that is killed has said what it did
  }

  [[nodiscard]] Json to_json(const Line& line) const {
    const ManifestLine& stated = jobs_.line(line.job);
    const std::string output = stated.output.string();
    Json json = {{"schema", kJsonSchema}, {"line", stated.line}};
    json.update(line.outcome
                    ? outcome_json(output, line.key, *line.outcome, line.seconds)
                    : error_json(output, line.key, line.error, line.status(), line.seconds));
    return json;
  }

  void show_progress() {
    const std::size_t done = counts_.done();  // this one at least
    const double seconds = seconds_since(start_);
    const double share = static_cast<double>(done) / static_cast<double>(ours_.size());
    steps_(fmt::format("{} of {} jobs, {:.0f} a second, {:.0f} s left", done, ours_.size(),
                       static_cast<double>(done) / seconds, seconds / share - seconds),
           share);
  }

  const ManifestRun& run_;
  const ManifestJobs& jobs_;
  std::vector<std::size_t> ours_;  // the jobs of this shard
  KeyedStores stores_;
  const Clock::time_point start_ = Clock::now();
  std::mutex telling_;  // of all below
  StepPrinter steps_;
  Counts counts_;
  std::atomic<bool> has_failed_ = false;
};

}  // namespace

int cook_manifest(const ManifestRun& run) {
  const Result<ManifestJobs> jobs = ManifestJobs::read(run.farm.manifest);
  if (!jobs) return fail(jobs.error());
  if (jobs->size() == 0) warn(input_name(run.farm.manifest) + ": the manifest has no job");
  const Shard shard = *shard_from(run.farm.shard);  // was checked when it was parsed
  std::optional<Journal> journal;
  if (const fs::path path = journal_of(run.farm, shard); !path.empty()) {
    if (Status status = check_journal(path, run.farm.manifest); !status) {
      return usage("cook: --journal " + status.error().detail);
    }
    Result<Journal> opened = Journal::open(path);
    if (!opened) {
      Error error = opened.error();
      if (run.farm.journal.empty()) error.detail += "; --journal FILE names another place for it";
      return fail(error);
    }
    journal.emplace(std::move(*opened));
  }
  int status = 0;
  std::string text;
  {
    Run all(run, *jobs, shard, journal ? &*journal : nullptr);
    status = all.work();
    text = all.text();
  }
  if (!run.quiet && !run.json) fmt::print("{}", text);
  return status;
}

}  // namespace boxtree::cooker
