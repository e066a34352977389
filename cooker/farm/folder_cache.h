// SPDX-License-Identifier: MIT
// A folder of cooked files by their keys, shared by as many processes as like to.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include <boxtree/error.h>

#include "cooker/farm/cook_cache.h"

namespace boxtree::cooker {

/// Two kinds of files, as in Bazel's caches: ac/KK/KEY is an entry, which says which output a key
/// has, and cas/DD/DIGEST is an output, under the SHA-256 of its bytes. KK and DD are the first two
/// digits. Files appear whole (rename) and are never changed; whoever reads one that is removed
/// still has it. An entry that is damaged, or whose output is missing or has other bytes than its
/// name says, is none. So no lock is needed but for the size, and nothing is synced to the disk.
class FolderCache final : public CookCache {
 public:
  /// Makes the folder if it is not there. `most_bytes`: of all files together. Error: kWriteFailed.
  static Result<FolderCache> open(const std::filesystem::path& folder, std::uint64_t most_bytes);

 protected:
  /// What it finds becomes the most recently used.
  [[nodiscard]] Result<std::optional<Entry>> find(
      const Digest& key, const std::filesystem::path& output) const override;
  /// Then removes the least recently used files, if all together have more than `most_bytes`, until
  /// they have nine tenths of it.
  Result<Entry> keep(const Digest& key, const std::filesystem::path& output,
                     const std::string& report) const override;

 private:
  FolderCache(std::filesystem::path folder, std::uint64_t most_bytes)
      : folder_(std::move(folder)), most_bytes_(most_bytes) {}

  [[nodiscard]] std::filesystem::path entry_path(const Digest& key) const;
  [[nodiscard]] std::filesystem::path output_path(const Digest& output) const;
  [[nodiscard]] std::optional<Entry> read_entry(const Digest& key) const;
  void note_damage(const std::filesystem::path& file, const std::string& expected) const;

  std::filesystem::path folder_;
  std::uint64_t most_bytes_;
};

}  // namespace boxtree::cooker
