// SPDX-License-Identifier: MIT
// The record of how a file was made: JSON for humans and build systems, stored in the file.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "cooker/cook.h"

namespace boxtree::cooker {

/// One input, as the record names it: free of folders.
struct RecordedSource {
  std::string name;
  std::uint64_t content_hash;
  std::size_t faces;
};

/// Tool, options and sources; `profile`: hash of the profile that was used, 0 without one.
[[nodiscard]] std::string make_cook_record(const CookOptions& options,
                                           std::span<const RecordedSource> sources,
                                           std::uint64_t profile = 0);

}  // namespace boxtree::cooker
