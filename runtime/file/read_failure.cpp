// SPDX-License-Identifier: MIT
#include "runtime/file/read_failure.h"

#include <cerrno>
#include <system_error>

namespace boxtree {

Error read_failure(const std::string& path, int reason, const std::string& named_in) {
  if (reason == ENOENT || reason == ENOTDIR) {
    const std::string missing = path + ": no such file; ";
    if (!named_in.empty()) {
      return {Errc::kFileNotFound,
              missing + "names in " + named_in + " are relative to its folder"};
    }
    const bool is_relative = path.empty() || path[0] != '/';
    return {Errc::kFileNotFound,
            missing + "check the name" +
                (is_relative ? ", which is relative to the current folder" : "")};
  }
  return {reason == ENOMEM ? Errc::kOutOfMemory : Errc::kFileUnreadable,
          path + ": " + std::generic_category().message(reason)};
}

}  // namespace boxtree
