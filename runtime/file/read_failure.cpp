// SPDX-License-Identifier: MIT
#include "runtime/file/read_failure.h"

#include <cerrno>
#include <system_error>

namespace boxtree {
namespace {

bool begins_at_root(const std::string& path) {
#ifdef _WIN32
  if (path.size() > 1 && path[1] == ':') return true;
  if (!path.empty() && path[0] == '\\') return true;
#endif
  return !path.empty() && path[0] == '/';
}

}  // namespace

Error read_failure(const std::string& path, int reason, const std::string& named_in) {
  if (reason == ENOENT || reason == ENOTDIR) {
    const std::string missing = path + ": no such file; ";
    if (!named_in.empty()) {
      return {Errc::kFileNotFound,
              missing + "names in " + named_in + " are relative to its folder"};
    }
    const bool is_relative = !begins_at_root(path);
    return {Errc::kFileNotFound,
            missing + "check the name" +
                (is_relative ? ", which is relative to the current folder" : "")};
  }
  return {reason == ENOMEM ? Errc::kOutOfMemory : Errc::kFileUnreadable,
          path + ": " + std::generic_category().message(reason)};
}

}  // namespace boxtree
