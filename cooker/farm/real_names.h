// SPDX-License-Identifier: MIT
// Names by which files of many lines are compared: one for each file, whatever links lead to it.
#pragma once

#include <filesystem>
#include <string>
#include <unordered_map>
#include <unordered_set>

namespace boxtree::cooker {

/// Real names, at the cost of looking once at each folder: a list of files in a few folders takes
/// little more than the texts.
class RealNames {
 public:
  /// The absolute name of a file without links, "." and "..", whether it is there or not; what
  /// cannot be looked up stays as it is.
  [[nodiscard]] std::string of(const std::filesystem::path& file);

 private:
  struct Folder {
    std::filesystem::path real;
    bool is_there = true;
    std::unordered_set<std::string> links;  // symbolic ones in it
  };
  const Folder& folder(const std::filesystem::path& path);

  std::unordered_map<std::string, Folder> folders_;
};

}  // namespace boxtree::cooker
