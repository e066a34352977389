// SPDX-License-Identifier: MIT
// Makes the error for a file that could not be written.
#pragma once

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// kWriteFailed with the name of the file or stream, the failed operation, and the reason in errno;
/// kOutOfMemory if it is that.
[[nodiscard]] inline Error write_failure(const std::string& name, const char* what) {
  const int reason = errno;  // before another call changes it
  return {reason == ENOMEM ? Errc::kOutOfMemory : Errc::kWriteFailed,
          name + ": " + what + ": " + std::generic_category().message(reason)};
}
[[nodiscard]] inline Error write_failure(const std::filesystem::path& path, const char* what) {
  return write_failure(path.string(), what);
}

}  // namespace boxtree::cooker
