// SPDX-License-Identifier: MIT
// Which temporary files a folder was left with, without reading the folder again for each file that
// is made in it: a run that fills a folder with n files would read n^2 names.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace boxtree::cooker {

/// Names of files as their system has them: of bytes, on Windows of UTF-16.
using FileName = std::filesystem::path::string_type;
using FileNameView = std::basic_string_view<FileName::value_type>;

/// What a folder was found to hold.
struct FolderNames {
  std::size_t count = 0;
  std::vector<FileName> unfinished;  // those that may be of temporary files, of any target

  /// Counts a name, and keeps it if it may be of a temporary file.
  void add(FileNameView name);
};

/// The folders in which this process makes files. Thread-safe.
class FolderSweep {
 public:
  /// Reading this many names takes some 10 us, a tenth of what it takes to make a file.
  static constexpr std::size_t kNamesPerFile = 64;

  using Read = std::function<FolderNames()>;
  using Belongs = std::function<bool(const FileName& unfinished)>;

  /// For a new file in `folder`: names of unfinished files that belong to its target. They are
  /// given once, as of the last time when the folder was read; `read` reads it where it is small,
  /// and a large one again once a file was made for every kNamesPerFile names that it had then. So
  /// n files take O(n) names; what is left in between is found by a later reading or another
  /// process.
  [[nodiscard]] std::vector<FileName> take(const std::filesystem::path& folder,
                                           const Belongs& belongs, const Read& read);

 private:
  struct Known {
    FolderNames names;
    std::size_t files = 0;  // made since
  };

  std::mutex mutex_;
  std::unordered_map<FileName, Known> folders_;  // large ones alone
};

/// That of this process.
[[nodiscard]] FolderSweep& folder_sweep();

}  // namespace boxtree::cooker
