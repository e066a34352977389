// SPDX-License-Identifier: MIT
// Write, fsync, rename, fsync of the directory.
#include <cerrno>
#include <csignal>
#include <fcntl.h>
#include <string_view>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

#include <fmt/format.h>

#include <boxtree/cooker/write/atomic_file.h>

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

constexpr mode_t kMode = 0666;  // the umask takes away what the user does not want
constexpr std::string_view kSuffix = ".cooking";

Error failure(const fs::path& path, const char* what) {
  return Error{Errc::kWriteFailed,
               path.string() + ": " + what + ": " + std::generic_category().message(errno)};
}

fs::path directory_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

// ".NAME.PID.cooking": hidden, and tells whether its writer still runs.
std::string prefix_of(const fs::path& target) {
  return fmt::format(".{}.", target.filename().string());
}

// Removes what killed writers of the same target left. A pid that was given to another process
// keeps its litter until that one ends; nothing is ever taken from a living writer.
void sweep(const fs::path& target) {
  std::error_code ignored;
  const std::string prefix = prefix_of(target);
  for (const fs::directory_entry& entry : fs::directory_iterator(directory_of(target), ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(prefix) || !name.ends_with(kSuffix)) continue;
    if (name.size() <= prefix.size() + kSuffix.size()) continue;
    const std::string pid =
        name.substr(prefix.size(), name.size() - prefix.size() - kSuffix.size());
    if (pid.find_first_not_of("0123456789") != std::string::npos || pid.size() > 9) continue;
    const bool alive = ::kill(static_cast<pid_t>(std::stol(pid)), 0) == 0 || errno != ESRCH;
    if (!alive) fs::remove(entry.path(), ignored);
  }
}

}  // namespace

AtomicFile::AtomicFile(AtomicFile&& other) noexcept
    : target_(std::move(other.target_)),
      temporary_(std::move(other.temporary_)),
      named_(std::exchange(other.named_, false)),
      descriptor_(std::exchange(other.descriptor_, -1)) {}

AtomicFile::~AtomicFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
  if (named_) ::unlink(temporary_.c_str());
}

Result<AtomicFile> AtomicFile::create(const fs::path& target) {
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    return Error{Errc::kWriteFailed, target.string() + ": exists and is not a regular file"};
  }
  sweep(target);
  AtomicFile file;
  file.target_ = target;
  file.temporary_ = directory_of(target) /
                    (prefix_of(target) + std::to_string(::getpid()) + std::string(kSuffix));
  file.descriptor_ = ::open(directory_of(target).c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, kMode);
  if (file.descriptor_ < 0) {
    ::unlink(file.temporary_.c_str());  // of an earlier process with our pid
    file.descriptor_ =
        ::open(file.temporary_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, kMode);
    if (file.descriptor_ < 0) return failure(target, "cannot create");
    file.named_ = true;
  }
  return file;
}

Status AtomicFile::write(Bytes bytes) {
  while (!bytes.empty()) {
    const ssize_t wrote = ::write(descriptor_, bytes.data(), bytes.size());
    if (wrote < 0 && errno == EINTR) continue;
    if (wrote < 0) return failure(target_, "cannot write");
    bytes = bytes.subspan(static_cast<std::size_t>(wrote));
  }
  return {};
}

// Gives the anonymous file its temporary name. Linking by descriptor needs a privilege or /proc.
Status AtomicFile::link_anonymous() {
  ::unlink(temporary_.c_str());
  if (::linkat(descriptor_, "", AT_FDCWD, temporary_.c_str(), AT_EMPTY_PATH) != 0) {
    const std::string self = "/proc/self/fd/" + std::to_string(descriptor_);
    if (::linkat(AT_FDCWD, self.c_str(), AT_FDCWD, temporary_.c_str(), AT_SYMLINK_FOLLOW) != 0) {
      return failure(target_, "cannot name the finished file");
    }
  }
  named_ = true;
  return {};
}

Status AtomicFile::commit() {
  if (::fsync(descriptor_) != 0) return failure(target_, "cannot flush");
  if (!named_) {
    if (Status status = link_anonymous(); !status) return status;
  }
  if (::rename(temporary_.c_str(), target_.c_str()) != 0) return failure(target_, "cannot rename");
  named_ = false;
  const int directory = ::open(directory_of(target_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (directory < 0) return failure(target_, "cannot open the directory");
  const int flushed = ::fsync(directory);
  ::close(directory);
  return flushed == 0 ? Status{} : Status{failure(target_, "cannot flush the directory")};
}

}  // namespace boxtree::cooker
