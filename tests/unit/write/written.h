// SPDX-License-Identifier: MIT
// What tests of writing share.
#pragma once

#include <cstddef>
#include <filesystem>
#include <iterator>
#include <span>
#include <string_view>

#include "format/bytes.h"

namespace boxtree::test {

[[nodiscard]] inline Bytes bytes_of(std::string_view text) {
  return std::as_bytes(std::span(text));
}

/// How many files and folders a folder has.
[[nodiscard]] inline std::size_t entries(const std::filesystem::path& folder) {
  return static_cast<std::size_t>(std::distance(std::filesystem::directory_iterator(folder), {}));
}

}  // namespace boxtree::test
