// SPDX-License-Identifier: MIT
// Reads whole files up to a size limit per kind: a device never ends.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// Largest files of each kind that people write or programs make for the cooker.
inline constexpr std::uint64_t kMaxProfileBytes = std::uint64_t{16} << 20;
inline constexpr std::uint64_t kMaxFaceListBytes = std::uint64_t{256} << 20;
inline constexpr std::uint64_t kMaxCostsBytes = std::uint64_t{1} << 20;
inline constexpr std::uint64_t kMaxResultsBytes = std::uint64_t{256} << 20;
inline constexpr std::uint64_t kAnyBytes = std::numeric_limits<std::uint64_t>::max();

/// Passes the bytes of `path` to `sink` in chunks. `named_in`: as for read_failure. Errors:
/// kFileNotFound; kFileUnreadable, also for a file of more than `most` bytes.
Status read_chunks(const std::filesystem::path& path, std::uint64_t most,
                   const std::function<void(const char* bytes, std::size_t count)>& sink,
                   const std::string& named_in = {});

/// The whole file. Errors: the same.
Result<std::string> read_whole_file(const std::filesystem::path& path, std::uint64_t most,
                                    const std::string& named_in = {});

}  // namespace boxtree::cooker
