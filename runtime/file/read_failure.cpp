// SPDX-License-Identifier: MIT
#include "runtime/file/read_failure.h"

#include <cerrno>
#include <system_error>

#include "format/message.h"

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
  if (path.empty()) {
    return {Errc::kFileNotFound, "expected the name of a file, found an empty one"};
  }
  if (path.starts_with("\211BXT")) {  // as kMagic does: not what a log should be given
    return {Errc::kFileNotFound,
            "expected the name of a file, found the bytes of one: pass them as Bytes"};
  }
  if (reason == ENOENT || reason == ENOTDIR) {
    if (!named_in.empty()) {
      return error_at(error_with(Errc::kFileNotFound, path, ": no such file; names in ").detail,
                      error_with(Errc::kFileNotFound, named_in, " are relative to its folder"));
    }
    return error_with(Errc::kFileNotFound, path,
                      begins_at_root(path)
                          ? ": no such file; check the name"
                          : ": no such file; check the name, which is relative to the current "
                            "folder");
  }
  return system_failure(Errc::kFileUnreadable, path, reason);
}

Error system_failure(Errc code, const std::string& path, int reason) {
  return error_in(path, {reason == ENOMEM ? Errc::kOutOfMemory : code,
                         std::generic_category().message(reason)});
}

}  // namespace boxtree
