// SPDX-License-Identifier: MIT
// A file without a name, found under the descriptor that holds it: whatever kills the process, the
// system removes it, and no other process, of whatever namespace, comes upon it.
#include "cooker/report/scratch_file.h"

#include <cerrno>
#include <cstdlib>
#include <fcntl.h>
#include <string>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "cooker/system/write_all.h"

namespace boxtree::cooker {
namespace {

Error failure(const std::filesystem::path& folder) {
  return Error{Errc::kWriteFailed, folder.string() + ": cannot write a temporary file: " +
                                       std::generic_category().message(errno)};
}

int create_unnamed(const std::filesystem::path& folder) {
  const int file = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (file >= 0) return file;
  std::string name = (folder / "boxtree-XXXXXX").string();
  const int named = ::mkostemp(name.data(), O_CLOEXEC);
  if (named >= 0) ::unlink(name.c_str());
  return named;
}

}  // namespace

Result<ScratchFile> ScratchFile::create(std::span<const std::byte> bytes) {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  if (error) return Error{Errc::kWriteFailed, "no temporary folder: " + error.message()};
  ScratchFile scratch(create_unnamed(folder));
  if (scratch.descriptor_ < 0) return failure(folder);
  if (!write_all(scratch.descriptor_, bytes)) return failure(folder);
  // Pages that are not on disk cannot be dropped, and cold reads are what is measured.
  if (::fsync(scratch.descriptor_) != 0) return failure(folder);
  return scratch;
}

ScratchFile::ScratchFile(int descriptor)
    : descriptor_(descriptor), path_("/proc/self/fd/" + std::to_string(descriptor)) {}

ScratchFile::ScratchFile(ScratchFile&& other) noexcept
    : descriptor_(std::exchange(other.descriptor_, -1)), path_(std::move(other.path_)) {}

ScratchFile::~ScratchFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace boxtree::cooker
