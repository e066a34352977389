// SPDX-License-Identifier: MIT
// Write, fsync, rename, fsync of the directory; whatever can fail is tried before the rename.
#include "cooker/write/atomic_file.h"

#include <array>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <dirent.h>
#include <fcntl.h>
#include <memory>
#include <optional>
#include <string_view>
#include <sys/file.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

#include "cooker/system/write_all.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kMode = 0666;  // the umask takes away what the user does not want
constexpr mode_t kModeBits = 07777;
constexpr std::string_view kSuffix = ".cooking";
constexpr std::size_t kRandomDigits = 16;
constexpr std::size_t kLongestName =
    200;  // of a target in the name of a temporary: 255 bytes in all

Error failure(const fs::path& path, const char* what) {
  return Error{Errc::kWriteFailed,
               path.string() + ": " + what + ": " + std::generic_category().message(errno)};
}

fs::path directory_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

// ".NAME.RANDOM.cooking"
std::string prefix_of(const fs::path& target) {
  return fmt::format(".{}.", target.filename().string().substr(0, kLongestName));
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

struct CloseDirectory {
  void operator()(DIR* directory) const { ::closedir(directory); }
};

// What file systems, old kernels and sandboxes say where names cannot be exchanged, and what is
// said when the old file has gone meanwhile.
bool cannot_exchange(int error) {
  return error == EINVAL || error == ENOSYS || error == EOPNOTSUPP || error == EPERM ||
         error == ENOENT;
}

// Removes what killed writers of the same target left. A writer holds a lock on its temporary as
// long as it lives, in whatever container: what can be locked is nobody's.
// By readdir(), as std::filesystem aborts where memory runs out, and throws where a folder cannot
// be read to its end: what cannot be swept stays.
void sweep(const fs::path& target) {
  const std::string prefix = prefix_of(target);
  const std::unique_ptr<DIR, CloseDirectory> folder(::opendir(directory_of(target).c_str()));
  if (!folder) return;
  const int at = ::dirfd(folder.get());
  // NOLINTNEXTLINE(concurrency-mt-unsafe): the folder is read by nobody else
  while (const dirent* entry = ::readdir(folder.get())) {
    if (!is_temporary(entry->d_name, prefix)) continue;
    const int file = ::openat(at, entry->d_name, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (file < 0) continue;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) ::unlinkat(at, entry->d_name, 0);
    ::close(file);
  }
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

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : target_(std::move(other.target_)),
      temporary_(std::move(other.temporary_)),
      named_(std::exchange(other.named_, false)),
      replaces_(other.replaces_),
      descriptor_(std::exchange(other.descriptor_, -1)),
      directory_(std::exchange(other.directory_, -1)) {}

AtomicFile::~AtomicFile() {
  if (named_) ::unlink(temporary_.c_str());
  if (descriptor_ >= 0) ::close(descriptor_);
  if (directory_ >= 0) ::close(directory_);
}

Result<AtomicFile> AtomicFile::create(const fs::path& given) {
  const Result<fs::path> target = follow_links(given);
  if (!target) return target.error();
  struct stat old {};
  const bool exists = ::stat(target->c_str(), &old) == 0;
  if (!exists && errno != ENOENT) return failure(given, "cannot tell whether it exists");
  if (exists && !S_ISREG(old.st_mode)) {
    return Error{Errc::kWriteFailed, given.string() + ": exists and is not a regular file"};
  }
  if (!target->has_filename()) return Error{Errc::kWriteFailed, "a file without a name"};
  sweep(*target);
  AtomicFile file;
  file.target_ = *target;
  file.replaces_ = exists;
  const fs::path directory = directory_of(*target);
  // Needed after the rename, when it is too late to fail.
  file.directory_ = ::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file.directory_ < 0) return failure(given, "cannot open its directory");
  file.descriptor_ = ::open(directory.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kMode);
  if (file.descriptor_ >= 0) {
    if (Status status = file.choose_name(); !status) return status.error();
    // File systems without locks sweep too much or nothing; a writer whose temporary goes fails.
    static_cast<void>(::flock(file.descriptor_, LOCK_EX | LOCK_NB));
  } else if (Status status = file.create_named(); !status) {
    return status.error();
  }
  if (exists && ::fchmod(file.descriptor_, old.st_mode & kModeBits) != 0) {
    return failure(given, "cannot keep its mode");
  }
  // Only root may give files away.
  if (exists) static_cast<void>(!::fchown(file.descriptor_, old.st_uid, old.st_gid));
  return file;
}

Status AtomicFile::choose_name() {
  const std::optional<std::string> digits = random_digits();
  if (!digits) return failure(target_, "no random numbers");
  temporary_ = directory_of(target_) / (prefix_of(target_) + *digits + std::string(kSuffix));
  return {};
}

// Before it is locked, another writer's sweep may take the file for a dead writer's: then the next
// one is tried. Each attempt that fails is somebody else's sweep, of which there are not many.
Status AtomicFile::create_named() {
  constexpr int kAttempts = 100;
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (Status status = choose_name(); !status) return status;
    descriptor_ = ::open(temporary_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, kMode);
    if (descriptor_ < 0) return failure(target_, "cannot create");
    named_ = true;
    const bool is_swept = ::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
    struct stat status {};
    if (::fstat(descriptor_, &status) != 0) return failure(target_, "cannot create");
    if (!is_swept && status.st_nlink > 0) return {};
    ::unlink(temporary_.c_str());
    ::close(std::exchange(descriptor_, -1));
    named_ = false;
  }
  errno = EAGAIN;
  return failure(target_, "cannot create");
}

Status AtomicFile::write(Bytes bytes) {
  return write_all(descriptor_, bytes) ? Status() : failure(target_, "cannot write");
}

// Gives the anonymous file its temporary name. Linking by descriptor needs a privilege or /proc.
// A call that fails may have been done all the same, on a network: the name is removed either way.
Status AtomicFile::link_anonymous() {
  named_ = true;
  if (::linkat(descriptor_, "", AT_FDCWD, temporary_.c_str(), AT_EMPTY_PATH) != 0) {
    const std::string self = "/proc/self/fd/" + std::to_string(descriptor_);
    if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, temporary_.c_str(), AT_SYMLINK_FOLLOW) != 0) {
      return failure(target_, "cannot name the finished file");
    }
  }
  return {};
}

// The old file keeps a name until the new one is known to stay. Where names cannot be exchanged, it
// does not; and then nothing is left to bring back.
Status AtomicFile::commit() {
  if (::fsync(descriptor_) != 0) return failure(target_, "cannot flush");
  if (!named_) {
    if (Status status = link_anonymous(); !status) return status;
  }
  const bool is_exchanged = replaces_ && ::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD,
                                                     target_.c_str(), RENAME_EXCHANGE) == 0;
  // After other errors they may have been exchanged: a rename would bring the old file back.
  if (replaces_ && !is_exchanged && !cannot_exchange(errno)) {
    return failure(target_, "cannot rename");
  }
  if (!is_exchanged) {
    if (::rename(temporary_.c_str(), target_.c_str()) != 0) {
      return failure(target_, "cannot rename");
    }
    named_ = false;
  }
  if (::fsync(directory_) == 0) {
    if (named_) ::unlink(temporary_.c_str());  // the old file
    named_ = false;
    return {};
  }
  const Error error = failure(target_, "cannot flush the directory");
  if (is_exchanged) {
    static_cast<void>(
        !::renameat2(AT_FDCWD, temporary_.c_str(), AT_FDCWD, target_.c_str(), RENAME_EXCHANGE));
  } else if (!replaces_) {
    ::unlink(target_.c_str());
  }
  return error;
}

}  // namespace boxtree::cooker
