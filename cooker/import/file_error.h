// SPDX-License-Identifier: MIT
// Converts errors about a text to errors about its file.
#pragma once

#include <filesystem>
#include <string>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// Ends the message about a file that ends too early.
inline constexpr const char* kAsIfCut = ", as if the file was cut short";

/// The same error, its message preceded by the name of the file, or of what stands for one.
[[nodiscard]] inline Error in_file(const std::string& name, const Error& error) {
  return {error.code, name + ": " + error.detail};
}
[[nodiscard]] inline Error in_file(const std::filesystem::path& path, const Error& error) {
  return in_file(path.string(), error);
}

}  // namespace boxtree::cooker
