// SPDX-License-Identifier: MIT
// Each owner holds a lock on its file; files that can be locked have no owner and are removed.
#include "cooker/write/temporary_file.h"

#include <cerrno>
#include <cstdint>
#include <dirent.h>
#include <fcntl.h>
#include <memory>
#include <optional>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

#include "cooker/system/write_failure.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kSuffix = ".cooking";
constexpr std::size_t kRandomDigits = 16;
constexpr std::size_t kLongestName = 200;  // of the target: a file name has at most 255 bytes

std::string prefix_of(std::string_view name) {
  return fmt::format(".{}.", name.substr(0, kLongestName));
}

bool is_temporary(std::string_view name, std::string_view prefix) {
  if (name.size() != prefix.size() + kRandomDigits + kSuffix.size()) return false;
  const std::string_view digits = name.substr(prefix.size(), kRandomDigits);
  return name.starts_with(prefix) && name.ends_with(kSuffix) &&
         digits.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

std::optional<std::string> random_digits() {
  std::uint64_t random = 0;
  if (::getrandom(&random, sizeof(random), 0) != sizeof(random)) return std::nullopt;
  return fmt::format("{:016x}", random);
}

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
int open_to_lock(int folder, const char* name) {
  constexpr int kFlags = O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC;
  const int file = ::openat(folder, name, O_RDWR | kFlags);
  return file >= 0 ? file : ::openat(folder, name, O_RDONLY | kFlags);
}

// Uses readdir(), because std::filesystem aborts if memory runs out and throws if a folder cannot
// be read to its end. Files that cannot be removed stay. Locks work across containers.
void sweep(const fs::path& folder, std::string_view name) {
  const std::string prefix = prefix_of(name);
  const std::unique_ptr<DIR, CloseDirectory> entries(::opendir(folder.c_str()));
  if (!entries) return;
  const int at = ::dirfd(entries.get());
  // NOLINTNEXTLINE(concurrency-mt-unsafe): the folder is read by nobody else
  while (const dirent* entry = ::readdir(entries.get())) {
    if (!is_temporary(entry->d_name, prefix)) continue;
    const int file = open_to_lock(at, entry->d_name);
    if (file < 0) continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlinkat(at, entry->d_name, 0);
    ::close(file);
  }
}

}  // namespace

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
    : folder_(std::move(other.folder_)),
      name_(std::move(other.name_)),
      path_(std::move(other.path_)),
      is_named_(std::exchange(other.is_named_, false)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

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
  file.descriptor_ = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, mode);
  if (file.descriptor_ >= 0) {
    if (Status status = file.choose_name(); !status) return status.error();
    // Without locks, sweeps remove too much or nothing; a writer whose file is removed fails.
    static_cast<void>(::flock(file.descriptor_, LOCK_EX | LOCK_NB));
  } else if (Status status = file.create_named(mode); !status) {
    return status.error();
  }
  return file;
}

Result<TemporaryFile> TemporaryFile::create_in_memory(const std::string& title) {
  TemporaryFile file;
  file.descriptor_ = ::memfd_create("boxtree", MFD_CLOEXEC);
  if (file.descriptor_ < 0) return write_failure(title, "cannot be collected in memory");
  return file;
}

Status TemporaryFile::choose_name() {
  const std::optional<std::string> digits = random_digits();
  if (!digits) return write_failure(folder_ / name_, "no random numbers");
  path_ = folder_ / (prefix_of(name_) + *digits + std::string(kSuffix));
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

// Linking by descriptor needs a privilege or /proc. A call that fails may have been done here, too.
Status TemporaryFile::add_name() {
  if (is_named_) return {};
  is_named_ = true;
  if (::linkat(descriptor_, "", AT_FDCWD, path_.c_str(), AT_EMPTY_PATH) != 0) {
    const std::string self = "/proc/self/fd/" + std::to_string(descriptor_);
    if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, path_.c_str(), AT_SYMLINK_FOLLOW) != 0) {
      return write_failure(folder_ / name_, "cannot name the finished file");
    }
  }
  return {};
}

void TemporaryFile::remove_name() {
  if (is_named_ && (::unlink(path_.c_str()) == 0 || errno == ENOENT)) is_named_ = false;
}

}  // namespace boxtree::cooker
