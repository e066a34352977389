// SPDX-License-Identifier: MIT
// Sizes as people write them: 8G.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace boxtree::cooker {

/// "512", "64K", "8G", "1.5T": powers of 1024. Nothing for another text, for 0, and beyond 64 bits.
[[nodiscard]] std::optional<std::uint64_t> byte_size(std::string_view text);

/// What is wrong with a text that is none; empty if it is one.
[[nodiscard]] std::string byte_size_fault(const std::string& text);

}  // namespace boxtree::cooker
