// SPDX-License-Identifier: MIT
// Makes the error for an input that cannot be read.
#pragma once

#include <filesystem>
#include <string>
#include <system_error>

#include "runtime/file/read_failure.h"

namespace boxtree::cooker {

/// read_failure(), and of a missing file whose name counts from the current folder which one that
/// is: a build's is not its user's.
[[nodiscard]] inline Error input_failure(const std::string& path, int reason,
                                         const std::string& named_in = {}) {
  Error error = read_failure(path, reason, named_in);
  const bool is_relative = named_in.empty() && !path.empty() && !path.starts_with('/');
  if (error.code != Errc::kFileNotFound || !is_relative) return error;
  std::error_code unknown;
  const std::filesystem::path folder = std::filesystem::current_path(unknown);
  if (!unknown) error.detail += ", " + folder.string();
  return error;
}

}  // namespace boxtree::cooker
