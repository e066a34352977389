// SPDX-License-Identifier: MIT
// Cooked files by their keys, in a place that many processes share.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <boxtree/error.h>

#include "cooker/farm/sha256.h"

namespace boxtree::cooker {

/// What a key gives is verified before it is used: a cache that is damaged, full or not there costs
/// time, and never a byte of an output. This is of damage, not of intent: who can write into a
/// cache decides what a key gives. Safe for several threads.
class CookCache {
 public:
  struct Entry {
    Digest output;
    std::uint64_t bytes = 0;  // of the output
    std::string report;       // what the cook had to say of it
  };

  CookCache(CookCache&&) noexcept = default;
  CookCache& operator=(CookCache&&) = delete;
  CookCache(const CookCache&) = delete;
  CookCache& operator=(const CookCache&) = delete;
  virtual ~CookCache() = default;

  /// The entry of a key, if there is one, with its output written to `output`, which is replaced as
  /// AtomicFile does unless it has these bytes already. Error: kWriteFailed for the output;
  /// whatever is wrong with the cache is a miss.
  [[nodiscard]] Result<std::optional<Entry>> fetch(const Digest& key,
                                                   const std::filesystem::path& output) const {
    return find(key, output);
  }

  /// Stores a cooked file under its key, in place of what is there. The entry. Errors: kWriteFailed
  /// if the cache does not take it; those of read_chunks for the output.
  Result<Entry> store(const Digest& key, const std::filesystem::path& output,
                      const std::string& report) const;

  /// What has gone wrong since the last call, for people: the first fault of the cache's life, and
  /// what it does about many. Later faults of the same kind cost the same and are not told.
  [[nodiscard]] std::vector<std::string> take_warnings() const;

 protected:
  CookCache() = default;

  [[nodiscard]] virtual Result<std::optional<Entry>> find(
      const Digest& key, const std::filesystem::path& output) const = 0;
  virtual Result<Entry> keep(const Digest& key, const std::filesystem::path& output,
                             const std::string& report) const = 0;

  /// Makes a fault a warning if it is the first one.
  void note(const Error& fault) const;
  void warn(std::string warning) const;

 private:
  struct Warnings {
    std::mutex mutex;  // of the others
    std::vector<std::string> texts;
    bool has_fault = false;
  };
  std::unique_ptr<Warnings> warnings_ = std::make_unique<Warnings>();
};

/// Whether a file has the bytes that an entry is of.
[[nodiscard]] bool has_output(const std::filesystem::path& file, const CookCache::Entry& entry);

/// Whether the name of a cache is a URL and not that of a folder: it begins with letters and "://".
[[nodiscard]] bool is_url(const std::string& place);

/// Opens the cache of that name: a URL for an HttpCache, else a folder for a FolderCache, which
/// keeps to `most_bytes`. Errors: those of their open().
Result<std::unique_ptr<CookCache>> open_cache(const std::string& place, std::uint64_t most_bytes);

}  // namespace boxtree::cooker
