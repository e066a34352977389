// SPDX-License-Identifier: MIT
// A folder of cooked files by their keys, shared by as many processes as like to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include <boxtree/error.h>

#include "cooker/farm/sha256.h"

namespace boxtree::cooker {

/// Two kinds of files, as in Bazel's caches: ac/KK/KEY is an entry, which says which output a key
/// has, and cas/DD/DIGEST is an output, under the SHA-256 of its bytes. KK and DD are the first two
/// digits. Files appear whole (rename) and are never changed; whoever reads one that is removed
/// still has it. An entry that is damaged, or whose output is missing or has other bytes than its
/// name says, is none. So no lock is needed but for the size, and nothing is synced to the disk.
/// This is of damage, not of intent: who can write into the folder decides what a key gives. Safe
/// for several threads.
class CookCache {
 public:
  struct Entry {
    Digest output;
    std::uint64_t bytes = 0;  // of the output
    std::string report;       // what the cook had to say of it
  };

  /// Makes the folder if it is not there. `most_bytes`: of all files together. Error: kWriteFailed.
  static Result<CookCache> open(const std::filesystem::path& folder, std::uint64_t most_bytes);

  /// The entry of a key, if there is one, with its output written to `output`, which is replaced as
  /// AtomicFile does unless it has these bytes already. Both become the most recently used. Error:
  /// kWriteFailed for the output; whatever is wrong with the cache is a miss.
  [[nodiscard]] Result<std::optional<Entry>> fetch(const Digest& key,
                                                   const std::filesystem::path& output) const;

  /// Stores a cooked file under its key, in place of what is there. Then removes the least recently
  /// used files, if all together have more than `most_bytes`, until they have nine tenths of it.
  /// The entry. Errors: kWriteFailed; kFileUnreadable.
  Result<Entry> store(const Digest& key, const std::filesystem::path& output,
                      const std::string& report) const;

 private:
  CookCache(std::filesystem::path folder, std::uint64_t most_bytes)
      : folder_(std::move(folder)), most_bytes_(most_bytes) {}

  [[nodiscard]] std::filesystem::path entry_path(const Digest& key) const;
  [[nodiscard]] std::filesystem::path output_path(const Digest& output) const;
  [[nodiscard]] std::optional<Entry> read_entry(const Digest& key) const;

  std::filesystem::path folder_;
  std::uint64_t most_bytes_;
};

}  // namespace boxtree::cooker
