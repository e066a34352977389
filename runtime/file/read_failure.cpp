// SPDX-License-Identifier: MIT
#include "runtime/file/read_failure.h"

#include <cerrno>
#include <system_error>

namespace boxtree {

Error read_failure(const std::string& path, int reason) {
  if (reason == ENOENT || reason == ENOTDIR) {
    const bool is_relative = path.empty() || path[0] != '/';
    return {Errc::kFileNotFound,
            path + ": no such file; check the name" +
                (is_relative ? ", which is relative to the current folder" : "")};
  }
  return {reason == ENOMEM ? Errc::kOutOfMemory : Errc::kFileUnreadable,
          path + ": " + std::generic_category().message(reason)};
}

}  // namespace boxtree
