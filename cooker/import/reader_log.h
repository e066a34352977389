// SPDX-License-Identifier: MIT
// What assimp's readers say in its log while they read: there alone they tell of faces that they
// have left out, and of vertices and materials that they have made up.
#pragma once

#include <string>

namespace boxtree::cooker {

/// Listens, while it exists, to the readers that run on this thread. assimp has one log for all
/// threads: the first object replaces the one that the process may have set, for good.
class ReaderLog {
 public:
  ReaderLog();
  ~ReaderLog();
  ReaderLog(const ReaderLog&) = delete;
  ReaderLog& operator=(const ReaderLog&) = delete;

  /// The first message by which geometry of the file is not in the result, or geometry that is not
  /// in the file is, with the error before it, its cause; empty if there was none.
  [[nodiscard]] const std::string& loss() const { return loss_; }
  /// The first message by which faces without a material have another's, if there are any; or
  /// empty.
  [[nodiscard]] const std::string& guessed_material() const { return guessed_material_; }

 private:
  friend class ThreadLogger;
  void hear(const char* message, bool is_error);

  std::string loss_;
  std::string guessed_material_;
  std::string last_;        // of all
  std::string last_error_;  // after which nothing else was said
  ReaderLog* const outer_;
};

}  // namespace boxtree::cooker
