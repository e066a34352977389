// SPDX-License-Identifier: MIT
// Whether a tile is of its sources as they are now: an edit that is not cooked yet is found.
#pragma once

#include <cstdint>
#include <string>

#include <boxtree/error.h>
#include <boxtree/file.h>

#include "cooker/shell/cook_job.h"

namespace boxtree::cooker {

/// How a cooked file compares with the sources of its job.
struct SourceComparison {
  enum class Result : std::uint8_t { kSame, kDiffers, kUnknown };
  Result result = Result::kSame;
  std::string difference;  // "it was cooked from other bytes than a.ply has now"
};

/// Compares the cook record of a file, the output of `job`, with the options of the job and with
/// the bytes of its sources. kUnknown: the file has no record (--strip), the job has a profile, or
/// a source is not here, as after a cook elsewhere. Reads each source once, in chunks. Errors:
/// those of list_source_files and hash_source_files, kFileNotFound aside.
Result<SourceComparison> compare_with_sources(const CookJob& job, const File& file);

}  // namespace boxtree::cooker
