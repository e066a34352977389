// SPDX-License-Identifier: MIT
// Keeps the folder of a cache to its size: the least recently used files go first.
#pragma once

#include <cstdint>
#include <filesystem>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// Counts bytes that were added to a cache and, once all files of ac/ and cas/ have more than
/// `most_bytes`, removes those that were used longest ago, until the rest has nine tenths of that.
/// The count is in the file `size`, under a lock (flock), so that no process has to look at all
/// files for each that it adds; without a valid count they are looked at. Error: kWriteFailed.
Status keep_cache_size(const std::filesystem::path& folder, std::uint64_t added_bytes,
                       std::uint64_t most_bytes);

}  // namespace boxtree::cooker
