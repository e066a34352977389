// SPDX-License-Identifier: MIT
#include "cooker/farm/keyed_cook.h"

#include <algorithm>
#include <filesystem>
#include <random>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/shell/depfile.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

Error changed(const JobKey& before, const JobKey& after) {
  for (std::size_t i = 0; i < std::min(before.files.size(), after.files.size()); ++i) {
    if (before.files[i].digest == after.files[i].digest) continue;
    return {Errc::kFileUnreadable,
            before.files[i].file.path.string() + ": has changed while it was cooked; cook again"};
  }
  return {Errc::kFileUnreadable, "what it reads has changed while it was cooked; cook again"};
}

std::vector<fs::path> paths_of(const JobKey& key) {
  std::vector<fs::path> paths;
  for (const KeyedFile& each : key.files) paths.push_back(each.file.path);
  return paths;
}

// An output that is older than what it is made of is out of date for make and ninja, whatever its
// bytes, and at each build again: one that is right gets the time of now, as if it had been cooked.
// Of a file system without times, or a file of another user, it does not.
void renew_time(const fs::path& output, const std::vector<fs::path>& read) {
  std::error_code unknown;
  const fs::file_time_type made = fs::last_write_time(output, unknown);
  if (unknown) return;
  const bool is_older = std::any_of(read.begin(), read.end(), [&](const fs::path& path) {
    std::error_code error;
    const fs::file_time_type changed = fs::last_write_time(path, error);
    return !error && changed > made;
  });
  if (is_older) fs::last_write_time(output, fs::file_time_type::clock::now(), unknown);
}

class KeyedCook {
 public:
  KeyedCook(const CookJob& job, const JobKey& key, const KeyedStores& stores,
            const Progress& progress)
      : job_(job), key_(key), stores_(stores), progress_(progress) {}

  Result<KeyedOutcome> run() {
    const std::vector<fs::path> read = paths_of(key_);
    if (Status status = check_job(job_, read); !status) return status.error();
    if (stores_.journal != nullptr) {
      if (const auto there = stores_.journal->find(job_.output, key_.key, stores_.trusts_states)) {
        KeyedOutcome outcome;
        outcome.how = KeyedOutcome::How::kThere;
        outcome.bytes = there->bytes;
        renew_time(job_.output, read);
        return with_depfile(read, std::move(outcome));
      }
    }
    if (stores_.cache == nullptr) return cook();
    Result<std::optional<CookCache::Entry>> hit = stores_.cache->fetch(key_.key, job_.output);
    if (!hit) return hit.error();
    if (!*hit) return cook();
    if (is_audited()) return audit(**hit);
    KeyedOutcome outcome;
    outcome.how = KeyedOutcome::How::kFromCache;
    outcome.bytes = (*hit)->bytes;
    outcome.report = std::move((*hit)->report);
    renew_time(job_.output, read);
    if (Status status = note((*hit)->output, outcome.bytes); !status) return status.error();
    return with_depfile(read, std::move(outcome));
  }

 private:
  // Not by the key, which would audit the same entries each time.
  [[nodiscard]] bool is_audited() const {
    if (stores_.audit_share <= 0) return false;
    std::random_device random;
    return std::uniform_real_distribution<>(0, 1)(random) < stores_.audit_share;
  }

  Result<KeyedOutcome> cook() {
    Result<Summary> cooked = cook_job(job_, progress_);
    if (!cooked) return cooked.error();
    for (const fs::path& read : cooked->files_read) {
      const bool is_keyed =
          std::any_of(key_.files.begin(), key_.files.end(),
                      [&](const KeyedFile& each) { return each.file.path == read; });
      if (is_keyed) continue;
      return Error{Errc::kInternal,
                   read.string() + ": was read, and is not in the key of the cook"};
    }
    const Result<JobKey> after = key_of(job_);
    if (!after) return after.error();
    if (after->key != key_.key) return changed(key_, *after);
    KeyedOutcome outcome;
    outcome.bytes = cooked->file_bytes;
    outcome.report = stores_.report ? stores_.report(*cooked) : std::string();
    outcome.summary = std::move(*cooked);
    if (Status status = keep(outcome); !status) return status.error();
    return outcome;
  }

  // A cache that takes nothing more costs time, and no output; it has a warning of it.
  Status keep(const KeyedOutcome& outcome) {
    std::optional<Digest> output;
    if (stores_.cache != nullptr) {
      const Result<CookCache::Entry> entry =
          stores_.cache->store(key_.key, job_.output, outcome.report);
      if (entry) output = entry->output;
    }
    if (stores_.journal == nullptr) return {};
    if (!output) {
      const Result<Digest> digest = sha256_of_file(job_.output);
      if (!digest) return digest.error();
      output = *digest;
    }
    return note(*output, outcome.bytes);
  }

  Status note(const Digest& output, std::uint64_t bytes) {
    if (stores_.journal == nullptr) return {};
    return stores_.journal->add(job_.output, {key_.key, output, bytes});
  }

  Result<KeyedOutcome> with_depfile(const std::vector<fs::path>& read, KeyedOutcome outcome) {
    if (!job_.depfile.empty()) {
      if (Status status = write_depfile(job_.depfile, job_.output, read); !status)
        return status.error();
    }
    return outcome;
  }

  Result<KeyedOutcome> audit(const CookCache::Entry& hit) {
    Result<KeyedOutcome> cooked = cook();
    if (!cooked) return cooked.error();
    cooked->is_audited = true;
    const Result<Digest> output = sha256_of_file(job_.output);
    if (!output) return output.error();
    if (*output == hit.output) return cooked;
    cooked->difference =
        Error{Errc::kInternal,
              fmt::format("{}: audit: under the key {} the cache had an output of {} bytes with "
                          "the SHA-256 {}, a cook makes one of {} bytes with {}, which is there "
                          "now; the cooker has a fault, or the machine, or who wrote "
                          "into the cache",
                          job_.output.string(), hex_of(key_.key), hit.bytes, hex_of(hit.output),
                          cooked->bytes, hex_of(*output))};
    return cooked;
  }

  const CookJob& job_;
  const JobKey& key_;
  const KeyedStores& stores_;
  const Progress& progress_;
};

}  // namespace

bool has_keyed_output(const CookJob& job) {
  return !job.output_stream && job.reordered.empty();
}

Result<KeyedOutcome> cook_by_key(const CookJob& job, const JobKey& key, const KeyedStores& stores,
                                 const Progress& progress) {
  return KeyedCook(job, key, stores, progress).run();
}

}  // namespace boxtree::cooker
