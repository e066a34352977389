// SPDX-License-Identifier: MIT
// Write, fsync, rename, fsync of the directory; all steps that can fail come before the rename.
// Compiled on Windows, this is nothing: see atomic_file_windows.cpp.
#ifndef _WIN32
#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

#include "cooker/system/posix.h"
#include "cooker/system/write_failure.h"
#include "cooker/write/atomic_file.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kNewFileModeBits = 07777;

// Errors of file systems, old kernels and sandboxes that cannot exchange names, and the error if
// the old file no longer exists.
bool cannot_exchange(int error) {
  return error == EINVAL || error == ENOSYS || error == EOPNOTSUPP || error == EPERM ||
         error == ENOENT;
}

}  // namespace

Result<AtomicFile> AtomicFile::create_beside(const fs::path& given) {
  struct stat old {};
  // By the name that was given: /proc has links to what has no other name.
  if (::stat(given.c_str(), &old) == 0 && !S_ISREG(old.st_mode) && !S_ISDIR(old.st_mode)) {
    return Error{Errc::kWriteFailed, given.string() + ": exists and is not a regular file"};
  }
  const Result<fs::path> target = follow_links(given);
  if (!target) return target.error();
  const bool exists = ::stat(target->c_str(), &old) == 0;
  if (!exists && errno != ENOENT) return write_failure(given, "cannot tell whether it exists");
  if (exists && S_ISDIR(old.st_mode)) {
    return Error{Errc::kWriteFailed, given.string() + ": is a folder; expected the name of a file"};
  }
  if (!target->has_filename()) return Error{Errc::kWriteFailed, "a file without a name"};
  const fs::path directory = folder_of(*target);
  Result<TemporaryFile> temporary =
      TemporaryFile::create(directory, target->filename().string(), kNewFileMode);
  if (!temporary) return temporary.error();
  AtomicFile file(std::move(*temporary), *target, exists);
  // Needed after the rename, when it is too late to fail.
  file.directory_ = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file.directory_ < 0) return write_failure(given, "cannot open its directory");
  if (exists && ::fchmod(file.descriptor(), old.st_mode & kNewFileModeBits) != 0) {
    return write_failure(given, "cannot keep its mode");
  }
  // Only root may set owners.
  if (exists) static_cast<void>(!::fchown(file.descriptor(), old.st_uid, old.st_gid));
  return file;
}

// The old file keeps a name until the new one is durable. Where names cannot be exchanged, it loses
// its name, and cannot be restored.
Status AtomicFile::replace_target() {
  if (!flush_to_disk(descriptor())) return write_failure(target_, "cannot flush");
  if (Status status = temporary_.add_name(); !status) return status;
  const char* const temporary = temporary_.path().c_str();
  const bool is_exchanged = replaces_ && exchange_names(temporary, target_.c_str());
  // After other errors the names may have been exchanged: a rename would restore the old file.
  if (replaces_ && !is_exchanged && !cannot_exchange(errno)) {
    return write_failure(target_, "cannot rename");
  }
  if (!is_exchanged) {
    if (::rename(temporary, target_.c_str()) != 0) {
      return write_failure(target_, "cannot rename");
    }
    temporary_.release_name();
  }
  if (flush_to_disk(directory_)) {
    temporary_.remove_name();  // of the old file, if names were exchanged
    return {};
  }
  const Error error = write_failure(target_, "cannot flush the directory");
  if (is_exchanged) {
    static_cast<void>(exchange_names(temporary, target_.c_str()));
  } else if (!replaces_) {
    ::unlink(target_.c_str());
  }
  return error;
}

}  // namespace boxtree::cooker
#endif
