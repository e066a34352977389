// SPDX-License-Identifier: MIT
// A manifest with its options read: jobs that can be cooked.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <boxtree/error.h>

#include "cooker/farm/manifest.h"
#include "cooker/farm/shard.h"
#include "cooker/shell/cook_job.h"

namespace boxtree::cooker {

class ManifestJobs {
 public:
  /// Reads and checks all lines. Errors: those of read_whole_file and parse_manifest;
  /// kDocumentInvalid for options that are none, or contradict each other.
  static Result<ManifestJobs> read(const std::filesystem::path& manifest);

  [[nodiscard]] std::size_t size() const { return lines_.size(); }
  [[nodiscard]] const ManifestLine& line(std::size_t i) const { return lines_[i]; }
  /// Where the job is, "jobs.jsonl:3".
  [[nodiscard]] std::string place(std::size_t i) const;
  [[nodiscard]] CookJob job(std::size_t i) const;
  /// Numbers of the jobs of a shard, by the names of their outputs: see shard_of().
  [[nodiscard]] std::vector<std::size_t> of_shard(const Shard& shard) const;

 private:
  // Whether there is a profile, and the options.
  using OptionSet = std::pair<bool, std::vector<std::string>>;

  std::string name_;
  std::vector<ManifestLine> lines_;
  std::map<OptionSet, CookJob> by_options_;  // most lines have the same ones
};

}  // namespace boxtree::cooker
