// SPDX-License-Identifier: MIT
#include "cooker/farm/file_state.h"

#include <algorithm>
#include <chrono>
#include <sys/stat.h>

namespace boxtree::cooker {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kLongestStep = 2 * kSecond;  // of times, which FAT has

#ifndef _WIN32
std::uint64_t nanoseconds(const timespec& time) {
  return static_cast<std::uint64_t>(static_cast<std::int64_t>(time.tv_sec) * kSecond +
                                    time.tv_nsec);
}
#endif

}  // namespace

bool FileState::is_settled(std::int64_t now) const {
  const auto modified = static_cast<std::int64_t>(numbers[3]);
  const auto changed = static_cast<std::int64_t>(numbers[4]);
  return std::max(modified, changed) < now - kLongestStep;
}

std::optional<FileState> state_of(const std::filesystem::path& file) {
#ifdef _WIN32
  static_cast<void>(file);
  return std::nullopt;
#else
  struct stat status {};
  if (::stat(file.c_str(), &status) != 0) return std::nullopt;
#ifdef __APPLE__
  const timespec modified = status.st_mtimespec, changed = status.st_ctimespec;
#else
  const timespec modified = status.st_mtim, changed = status.st_ctim;
#endif
  return FileState{
      {static_cast<std::uint64_t>(status.st_dev), static_cast<std::uint64_t>(status.st_ino),
       static_cast<std::uint64_t>(status.st_size), nanoseconds(modified), nanoseconds(changed)}};
#endif
}

std::int64_t now_nanoseconds() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(now).count();
}

}  // namespace boxtree::cooker
