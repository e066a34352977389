// SPDX-License-Identifier: MIT
// Each owner holds a lock on its file; files that can be locked have no owner and are removed.
// Compiled on Windows, this is nothing: see temporary_file_windows.cpp.
#ifndef _WIN32
#include <cerrno>
#include <dirent.h>
#include <fcntl.h>
#include <memory>
#include <sys/file.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

#include "cooker/system/posix.h"
#include "cooker/system/write_failure.h"
#include "cooker/write/folder_sweep.h"
#include "cooker/write/temporary_file.h"
#include "cooker/write/temporary_name.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// Of the file folder/name, by errno.
Error cannot_create(const fs::path& folder, const std::string& name) {
  const int reason = errno;
  struct stat status {};
  if (reason == ENOENT && ::stat(folder.c_str(), &status) != 0 && errno == ENOENT) {
    return {Errc::kWriteFailed,
            fmt::format("{}: the folder {} is not there; make it first, as by mkdir -p",
                        (folder / name).string(), folder.string())};
  }
  errno = reason;
  return write_failure(folder / name, "cannot create");
}

struct CloseDirectory {
  void operator()(DIR* directory) const { ::closedir(directory); }
};

// NFS locks exclusively only what is open for writing; others may have files that only can be read.
int open_to_lock(const char* path) {
  constexpr int kFlags = O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
  const int file = ::open(path, O_RDWR | kFlags);
  return file >= 0 ? file : ::open(path, O_RDONLY | kFlags);
}

// Uses readdir(), because std::filesystem aborts if memory runs out and throws if a folder cannot
// be read to its end.
FolderNames read_folder(const fs::path& folder) {
  FolderNames names;
  const std::unique_ptr<DIR, CloseDirectory> entries(::opendir(folder.c_str()));
  if (!entries) return names;
  // NOLINTNEXTLINE(concurrency-mt-unsafe): the folder is read by nobody else
  while (const dirent* entry = ::readdir(entries.get())) names.add(entry->d_name);
  return names;
}

// Files that cannot be removed stay. Locks work across containers.
void sweep(const fs::path& folder, std::string_view name) {
  const std::string prefix = temporary_prefix(name);
  const auto is_left = [&](const FileName& found) { return is_temporary_name(found, prefix); };
  for (const FileName& left :
       folder_sweep().take(folder, is_left, [&] { return read_folder(folder); })) {
    const fs::path path = folder / left;
    const int file = open_to_lock(path.c_str());
    if (file < 0) continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlink(path.c_str());
    ::close(file);
  }
}

}  // namespace

TemporaryFile::~TemporaryFile() {
  remove_name();
  if (descriptor_ >= 0) ::close(descriptor_);
}

Result<TemporaryFile> TemporaryFile::create(const fs::path& folder, std::string_view name,
                                            mode_t mode) {
  sweep(folder, name);
  TemporaryFile file;
  file.folder_ = folder;
  file.name_ = name;
  file.descriptor_ = open_unnamed(folder.c_str(), mode);
  if (file.descriptor_ >= 0) {
    if (Status status = file.choose_name(); !status) return status.error();
    // Without locks, sweeps remove too much or nothing; a writer whose file is removed fails.
    static_cast<void>(::flock(file.descriptor_, LOCK_EX | LOCK_NB));
  } else if (Status status = file.create_named(mode); !status) {
    return status.error();
  }
  return file;
}

Status TemporaryFile::choose_name() {
  const std::string name = temporary_name(name_);
  if (name.empty()) return write_failure(folder_ / name_, "no random numbers");
  path_ = folder_ / name;
  return {};
}

// Until the file is locked, another owner's sweep may remove it as abandoned; then the next name is
// tried. Each failed attempt is one such sweep, so a few attempts suffice. On a network file system
// a call may fail although it was done, except when the name existed before.
Status TemporaryFile::create_named(mode_t mode) {
  constexpr int kAttempts = 100;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (Status status = choose_name(); !status) return status;
    descriptor_ = ::open(path_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, mode);
    is_named_ = descriptor_ >= 0 || errno != EEXIST;
    if (descriptor_ < 0) return cannot_create(folder_, name_);
    const bool is_swept = ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) return write_failure(folder_ / name_, "cannot create");
    if (!is_swept && status.st_nlink > 0) return {};
    remove_name();
    ::close(std::exchange(descriptor_, -1));
  }
  errno = EAGAIN;
  return write_failure(folder_ / name_, "cannot create");
}

// A call that fails may have been done here, too.
Status TemporaryFile::add_name() {
  if (is_named_) return {};
  is_named_ = true;
  if (!name_unnamed(descriptor_, path_.c_str())) {
    return write_failure(folder_ / name_, "cannot name the finished file");
  }
  return {};
}

void TemporaryFile::remove_name() {
  if (is_named_ && (::unlink(path_.c_str()) == 0 || errno == ENOENT)) is_named_ = false;
}

}  // namespace boxtree::cooker
#endif
