// SPDX-License-Identifier: MIT
// Write, fsync, rename, fsync of the directory; all steps that can fail come before the rename.
#include "cooker/write/atomic_file.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include "cooker/system/write_all.h"
#include "cooker/system/write_failure.h"
#include "runtime/file/mapping.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kMode = 0666;  // restricted by the umask
constexpr mode_t kModeBits = 07777;

fs::path directory_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

// Errors of file systems, old kernels and sandboxes that cannot exchange names, and the error if
// the old file no longer exists.
bool cannot_exchange(int error) {
  return error == EINVAL || error == ENOSYS || error == EOPNOTSUPP || error == EPERM ||
         error == ENOENT;
}

}  // namespace

Result<fs::path> follow_links(const fs::path& target) {
  fs::path path = target;
  constexpr int kMostLinks = 40;  // as in the kernel
  for (int links = 0; links < kMostLinks; ++links) {
    std::error_code error;
    const fs::file_status status = fs::symlink_status(path, error);
    if (status.type() == fs::file_type::none) {
      return Error{Errc::kWriteFailed, path.string() + ": " + error.message()};
    }
    if (!fs::is_symlink(status)) return path;
    const fs::path to = fs::read_symlink(path, error);
    if (error) return Error{Errc::kWriteFailed, path.string() + ": " + error.message()};
    path = to.is_absolute() ? to : directory_of(path) / to;
  }
  return Error{Errc::kWriteFailed, target.string() + ": too many links lead on from it"};
}

AtomicFile::AtomicFile(TemporaryFile temporary, fs::path target, bool replaces)
    : temporary_(std::move(temporary)), target_(std::move(target)), replaces_(replaces) {}

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : temporary_(std::move(other.temporary_)),
      target_(std::move(other.target_)),
      stream_(std::move(other.stream_)),
      replaces_(other.replaces_),
      directory_(std::exchange(other.directory_, -1)) {}

AtomicFile::~AtomicFile() {
  if (directory_ >= 0) ::close(directory_);
}

Result<AtomicFile> AtomicFile::create(const OutputTarget& to) {
  if (to.stream) {
    Result<TemporaryFile> memory = TemporaryFile::create_in_memory(to.title());
    if (!memory) return memory.error();
    AtomicFile file(std::move(*memory), to.title(), false);
    file.stream_ = to.stream;
    return file;
  }
  const fs::path& given = to.path;
  const Result<fs::path> target = follow_links(given);
  if (!target) return target.error();
  struct stat old {};
  const bool exists = ::stat(target->c_str(), &old) == 0;
  if (!exists && errno != ENOENT) return write_failure(given, "cannot tell whether it exists");
  if (exists && S_ISDIR(old.st_mode)) {
    return Error{Errc::kWriteFailed, given.string() + ": is a folder; expected the name of a file"};
  }
  if (exists && !S_ISREG(old.st_mode)) {
    return Error{Errc::kWriteFailed, given.string() + ": exists and is not a regular file"};
  }
  if (!target->has_filename()) return Error{Errc::kWriteFailed, "a file without a name"};
  const fs::path directory = directory_of(*target);
  Result<TemporaryFile> temporary =
      TemporaryFile::create(directory, target->filename().string(), kMode);
  if (!temporary) return temporary.error();
  AtomicFile file(std::move(*temporary), *target, exists);
  // Needed after the rename, when it is too late to fail.
  file.directory_ = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file.directory_ < 0) return write_failure(given, "cannot open its directory");
  if (exists && ::fchmod(file.descriptor(), old.st_mode & kModeBits) != 0) {
    return write_failure(given, "cannot keep its mode");
  }
  // Only root may set owners.
  if (exists) static_cast<void>(!::fchown(file.descriptor(), old.st_uid, old.st_gid));
  return file;
}

Status AtomicFile::write(Bytes bytes) {
  return write_all(descriptor(), bytes) ? Status() : write_failure(target_, "cannot write");
}

bool AtomicFile::loses_bytes() const {
  std::error_code error;
  if (!replaces_ || (fs::file_size(target_, error) == 0 && !error)) return false;
  const Result<Mapping> before = Mapping::map(target_.string());
  const Result<Mapping> after = Mapping::map(descriptor(), target_.string());
  return !before || !after || !std::ranges::equal(before->bytes(), after->bytes());
}

// The old file keeps a name until the new one is durable. Where names cannot be exchanged, it loses
// its name, and cannot be restored.
Status AtomicFile::commit() {
  if (stream_) return send();
  if (::fsync(descriptor()) != 0) return write_failure(target_, "cannot flush");
  if (Status status = temporary_.add_name(); !status) return status;
  const char* const temporary = temporary_.path().c_str();
  const bool is_exchanged = replaces_ && ::renameat2(AT_FDCWD, temporary, AT_FDCWD, target_.c_str(),
                                                     RENAME_EXCHANGE) == 0;
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
  if (::fsync(directory_) == 0) {
    temporary_.remove_name();  // of the old file, if names were exchanged
    return {};
  }
  const Error error = write_failure(target_, "cannot flush the directory");
  if (is_exchanged) {
    static_cast<void>(
        !::renameat2(AT_FDCWD, temporary, AT_FDCWD, target_.c_str(), RENAME_EXCHANGE));
  } else if (!replaces_) {
    ::unlink(target_.c_str());
  }
  return error;
}

Status AtomicFile::send() const {
  const Result<Mapping> collected = Mapping::map(descriptor(), stream_->title);
  if (!collected) return collected.error();
  if (write_all(stream_->descriptor, collected->bytes())) return {};
  return write_failure(stream_->title, "cannot be written");
}

}  // namespace boxtree::cooker
