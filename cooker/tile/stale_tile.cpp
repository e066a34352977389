// SPDX-License-Identifier: MIT
#include "cooker/tile/stale_tile.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "cooker/cook_record.h"
#include "cooker/import/import.h"
#include "cooker/import/source_files.h"
#include "runtime/file/open_file.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// As cook_job() has them when it writes the record.
CookOptions options_of(const CookJob& job) {
  CookOptions options = job.options;
  options.number_by_tree |= !job.reordered.empty();
  if (!job.costs.empty()) options.costs.resize(1);  // the record says no more than that
  return options;
}

using Comparison = SourceComparison::Result;

SourceComparison differs(const std::string& how) {
  return {Comparison::kDiffers, "it was cooked " + how};
}

}  // namespace

Result<SourceComparison> compare_with_sources(const CookJob& job, const File& file) {
  if (!job.profile.empty() || job.options.import.bytes) {
    return SourceComparison{Comparison::kUnknown, {}};
  }
  const Bytes record = OpenFile::of(file).section(SectionKind::kCookRecord);
  const std::optional<RecordedCook> cook =
      recorded_cook({reinterpret_cast<const char*>(record.data()), record.size()});
  if (!cook) return SourceComparison{Comparison::kUnknown, {}};
  if (cook->options != recorded_options(options_of(job))) {
    return differs("with other options than the manifest has now");
  }
  if (cook->sources.size() != job.inputs.size()) {
    return differs("from other sources than the manifest has now");
  }
  for (std::size_t i = 0; i < job.inputs.size(); ++i) {
    const Result<std::vector<fs::path>> files =
        list_source_files(job.inputs[i], job.options.import);
    const Result<std::uint64_t> hash =
        files ? hash_source_files(*files) : Result<std::uint64_t>(files.error());
    if (!hash && hash.code() == Errc::kFileNotFound) {
      return SourceComparison{Comparison::kUnknown, {}};
    }
    if (!hash) return hash.error();
    if (recorded_hash(*hash) == cook->sources[i]) continue;
    return differs("from other bytes than " + job.inputs[i].string() + " has now");
  }
  return SourceComparison{};
}

}  // namespace boxtree::cooker
