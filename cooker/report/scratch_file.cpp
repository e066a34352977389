// SPDX-License-Identifier: MIT
// Memory as a file: no folder is needed, and a process that is killed leaves nothing behind.
#include "cooker/report/scratch_file.h"

#include <string>
#include <utility>

#include "cooker/system/write_all.h"
#include "cooker/system/write_failure.h"

namespace boxtree::cooker {

#ifdef __linux__
Result<ScratchFile> ScratchFile::create(std::span<const std::byte> bytes) {
  static constexpr const char* kTitle = "a temporary file";
  Result<TemporaryFile> file = TemporaryFile::create_in_memory(kTitle);
  if (!file) return file.error();
  if (!write_all(file->descriptor(), bytes))
    return write_failure(std::string(kTitle), "cannot write");
  return ScratchFile(std::move(*file));
}

ScratchFile::ScratchFile(TemporaryFile file)
    : file_(std::move(file)), path_("/proc/self/fd/" + std::to_string(file_.descriptor())) {}
#else
// Files in memory have no path there.
Result<ScratchFile> ScratchFile::create(std::span<const std::byte> /*bytes*/) {
  return Error{Errc::kFeatureUnsupported, "reports are measured on Linux alone; make them there"};
}

ScratchFile::ScratchFile(TemporaryFile file) : file_(std::move(file)) {}
#endif

}  // namespace boxtree::cooker
