// SPDX-License-Identifier: MIT
// Compiled on Windows, this is nothing: see stores_windows.cpp.
#ifndef _WIN32
#include "cooker/farm/cache_size.h"

#include <algorithm>
#include <array>
#include <fcntl.h>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <sys/file.h>
#include <system_error>
#include <unistd.h>
#include <vector>

#include "cooker/farm/sha256.h"
#include "cooker/system/write_all.h"
#include "cooker/system/write_failure.h"
#include "cooker/text/number_of.h"
#include "cooker/write/temporary_file.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// The file with the count, locked while this exists.
class Count {
 public:
  explicit Count(const fs::path& path)
      : descriptor_(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kNewFileMode)) {}
  Count(const Count&) = delete;
  Count& operator=(const Count&) = delete;
  ~Count() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  [[nodiscard]] bool lock() const { return descriptor_ >= 0 && ::flock(descriptor_, LOCK_EX) == 0; }

  // Nothing if no process has written it, or not to its end.
  [[nodiscard]] std::optional<std::uint64_t> read() const {
    std::array<char, 32> text{};
    const ssize_t got = ::pread(descriptor_, text.data(), text.size(), 0);
    if (got <= 0 || text[static_cast<std::size_t>(got) - 1] != '\n') return std::nullopt;
    return number_of<std::uint64_t>({text.data(), static_cast<std::size_t>(got) - 1});
  }

  [[nodiscard]] bool write(std::uint64_t bytes) const {
    const std::string text = std::to_string(bytes) + "\n";
    return ::lseek(descriptor_, 0, SEEK_SET) == 0 && ::ftruncate(descriptor_, 0) == 0 &&
           write_all(descriptor_, std::as_bytes(std::span(text)));
  }

 private:
  const int descriptor_;
};

struct CachedFile {
  fs::path path;
  std::uint64_t bytes;
  fs::file_time_type used;
};

// Those that are called by a digest: what else lies there is not the cache's. Other processes may
// remove files at the same time: what is gone is left out.
std::vector<CachedFile> list_files(const fs::path& folder) {
  std::vector<CachedFile> files;
  for (const char* kind : {"ac", "cas"}) {
    std::error_code error;
    for (fs::recursive_directory_iterator entry(folder / kind, error), end; entry != end && !error;
         entry.increment(error)) {
      std::error_code gone;
      // Those above the folders of two digits are on their way in.
      if (entry.depth() == 0 || !digest_of(entry->path().filename().string())) continue;
      if (!entry->is_regular_file(gone) || gone) continue;
      const std::uint64_t bytes = entry->file_size(gone);
      const fs::file_time_type used = entry->last_write_time(gone);
      if (!gone) files.push_back({entry->path(), bytes, used});
    }
  }
  return files;
}

// The bytes that are left.
std::uint64_t remove_oldest(const fs::path& folder, std::uint64_t most_bytes) {
  std::vector<CachedFile> files = list_files(folder);
  std::uint64_t bytes = 0;
  for (const CachedFile& file : files) bytes += file.bytes;
  if (bytes <= most_bytes) return bytes;
  std::sort(files.begin(), files.end(),
            [](const CachedFile& a, const CachedFile& b) { return a.used < b.used; });
  const std::uint64_t wanted = most_bytes - most_bytes / 10;
  for (const CachedFile& file : files) {
    if (bytes <= wanted) break;
    std::error_code error;
    fs::remove(file.path, error);
    if (!error) bytes -= file.bytes;
  }
  return bytes;
}

}  // namespace

Status keep_cache_size(const fs::path& folder, std::uint64_t added_bytes,
                       std::uint64_t most_bytes) {
  const fs::path path = folder / "size";
  const Count count(path);
  if (!count.lock()) return write_failure(path, "lock");
  const std::optional<std::uint64_t> before = count.read();
  const bool fits = before && *before <= most_bytes && added_bytes <= most_bytes - *before;
  const std::uint64_t bytes = fits ? *before + added_bytes : remove_oldest(folder, most_bytes);
  if (!count.write(bytes)) return write_failure(path, "write");
  return {};
}

}  // namespace boxtree::cooker
#endif
