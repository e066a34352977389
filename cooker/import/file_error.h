// SPDX-License-Identifier: MIT
// Errors of what looks at a text, made errors of its file.
#pragma once

#include <filesystem>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// The same error, its words behind the name of the file.
[[nodiscard]] inline Error in_file(const std::filesystem::path& path, const Error& error) {
  return {error.code, path.string() + ": " + error.detail};
}

}  // namespace boxtree::cooker
