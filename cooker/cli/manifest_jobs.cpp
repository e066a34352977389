// SPDX-License-Identifier: MIT
#include "cooker/cli/manifest_jobs.h"

#include <utility>

#include <fmt/format.h>

#include "cooker/cli/job_words.h"
#include "cooker/cli/output.h"
#include "cooker/cli/standard_streams.h"
#include "cooker/farm/sha256.h"
#include "cooker/import/whole_file.h"

namespace boxtree::cooker {
namespace {

Result<std::string> text_of_manifest(const std::filesystem::path& manifest) {
  if (!is_standard_stream(manifest)) return read_whole_file(manifest, kMaxManifestBytes);
  const Result<Bytes> bytes = standard_input();
  if (!bytes) return bytes.error();
  return std::string(reinterpret_cast<const char*>(bytes->data()), bytes->size());
}

}  // namespace

Result<ManifestJobs> ManifestJobs::read(const std::filesystem::path& manifest) {
  ManifestJobs jobs;
  jobs.name_ = input_name(manifest);
  const Result<std::string> text = text_of_manifest(manifest);
  if (!text) return text.error();
  Result<std::vector<ManifestLine>> lines = parse_manifest(*text, jobs.name_);
  if (!lines) return lines.error();
  jobs.lines_ = std::move(*lines);
  for (std::size_t i = 0; i < jobs.lines_.size(); ++i) {
    const ManifestLine& line = jobs.lines_[i];
    const auto refused = [&](const std::string& fault) {
      return Error{Errc::kDocumentInvalid, jobs.place(i) + ": " + fault};
    };
    if (const std::string fault = mesh_name_fault(line.output, ".bxt"); !fault.empty())
      return refused(fault);
    const OptionSet set(!line.profile.empty(), line.options);
    if (!jobs.by_options_.contains(set)) {
      Result<CookJob> job = job_of_words(set.second, set.first);
      if (!job) return refused("options: " + job.error().detail);
      jobs.by_options_.emplace(set, std::move(*job));
    }
    const CookJob& options = jobs.by_options_.at(set);
    if (!options.profile.empty()) {
      return refused("options: expected \"profile\" as a member of the line, found --profile");
    }
    // Each job has its own, which no two lines with the same options have.
    if (!options.depfile.empty() || !options.reordered.empty()) {
      return refused("options: --depfile and --write-reordered are for single cooks");
    }
  }
  return jobs;
}

std::string ManifestJobs::place(std::size_t i) const {
  return fmt::format("{}:{}", name_, lines_[i].line);
}

std::vector<std::size_t> ManifestJobs::of_shard(const Shard& shard) const {
  std::vector<std::size_t> ours;
  for (std::size_t i = 0; i < lines_.size(); ++i) {
    const Digest digest = sha256_of(lines_[i].output.string());
    if (shard_of(digest, shard.count) == shard.number) ours.push_back(i);
  }
  return ours;
}

CookJob ManifestJobs::job(std::size_t i) const {
  const ManifestLine& line = lines_[i];
  CookJob job = by_options_.at({!line.profile.empty(), line.options});
  job.inputs = line.inputs;
  job.output = line.output;
  job.profile = line.profile;
  return job;
}

}  // namespace boxtree::cooker
