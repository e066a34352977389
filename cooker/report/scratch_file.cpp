// SPDX-License-Identifier: MIT
// The file has no name. Its path is that of its descriptor, so no other process, in any namespace,
// can find it.
#include "cooker/report/scratch_file.h"

#include <string>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "cooker/system/write_all.h"
#include "cooker/system/write_failure.h"

namespace boxtree::cooker {

Result<ScratchFile> ScratchFile::create(std::span<const std::byte> bytes) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) return Error{Errc::kWriteFailed, "no temporary folder: " + error.message()};
  constexpr mode_t kOwnerOnly = 0600;
  Result<TemporaryFile> file = TemporaryFile::create(folder, "boxtree-scratch", kOwnerOnly);
  if (!file) return file.error();
  file->remove_name();
  const int descriptor = file->descriptor();
  // Pages that are not on disk cannot be dropped, and the measurements need cold reads.
  if (!write_all(descriptor, bytes) || ::fsync(descriptor) != 0) {
    return write_failure(folder, "cannot write a temporary file");
  }
  return ScratchFile(std::move(*file));
}

ScratchFile::ScratchFile(TemporaryFile file)
    : file_(std::move(file)), path_("/proc/self/fd/" + std::to_string(file_.descriptor())) {}

}  // namespace boxtree::cooker
