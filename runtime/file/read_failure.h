// SPDX-License-Identifier: MIT
// Makes the error for a file that cannot be read, so that a missing one has the same name and
// message wherever it is looked for.
#pragma once

#include <string>

#include <boxtree/error.h>

namespace boxtree {

/// The error for `path` by the system's `reason`, a value of errno: kFileNotFound if there is no
/// such file, also if something on the way to it is no folder; kOutOfMemory; else kFileUnreadable.
/// `named_in`: the file that names it, relative to its folder; by default the user does.
[[nodiscard]] Error read_failure(const std::string& path, int reason,
                                 const std::string& named_in = {});

/// The error `code` for `path`, with the system's `reason`; kOutOfMemory where that is the reason.
[[nodiscard]] Error system_failure(Errc code, const std::string& path, int reason);

}  // namespace boxtree
