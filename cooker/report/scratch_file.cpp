// SPDX-License-Identifier: MIT
// Named after the process, written as every file of ours.
#include <string>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <boxtree/cooker/report/scratch_file.h>
#include <boxtree/cooker/write/atomic_file.h>

namespace boxtree::cooker {

Result<ScratchFile> ScratchFile::create(std::span<const std::byte> bytes) {
  std::error_code error;
  std::filesystem::path path = std::filesystem::temp_directory_path(error);
  if (error) return Error{Errc::kWriteFailed, "no temporary folder: " + error.message()};
  path /= "boxtree-" + std::to_string(::getpid()) + ".bxt";
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  if (Status status = file->write(bytes); !status) return status.error();
  if (Status status = file->commit(); !status) return status.error();
  return ScratchFile(std::move(path));
}

ScratchFile::ScratchFile(ScratchFile&& other) noexcept
    : path_(std::exchange(other.path_, std::filesystem::path())) {}

ScratchFile::~ScratchFile() {
  std::error_code ignored;  // somebody may have cleaned up
  if (!path_.empty()) std::filesystem::remove(path_, ignored);
}

}  // namespace boxtree::cooker
