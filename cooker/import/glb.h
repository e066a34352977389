// SPDX-License-Identifier: MIT
// Finds the JSON of a binary glTF file: after a 12-byte header, in the first chunk, which has a
// length, a type and bytes. Version 1 has the same fields at the same places.
#pragma once

#include <cstdint>
#include <cstring>
#include <optional>
#include <string_view>

namespace boxtree::cooker {

/// The number of bytes that the header states; empty if there is no such header.
[[nodiscard]] inline std::optional<std::uint32_t> glb_size(std::string_view file) {
  constexpr std::size_t kSizeAt = 8;
  std::uint32_t size = 0;
  if (!file.starts_with("glTF") || file.size() < kSizeAt + sizeof(size)) return std::nullopt;
  std::memcpy(&size, file.data() + kSizeAt, sizeof(size));
  return size;
}

/// The JSON; empty if the file is too short.
[[nodiscard]] inline std::string_view glb_json(std::string_view file) {
  constexpr std::size_t kLengthAt = 12, kJsonAt = 20;
  std::uint32_t length = 0;
  if (file.size() < kJsonAt) return {};
  std::memcpy(&length, file.data() + kLengthAt, sizeof(length));
  return file.substr(kJsonAt, length);
}

}  // namespace boxtree::cooker
