// SPDX-License-Identifier: MIT
// A cook by its key: what is there already, or in a cache, is not cooked again.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include <boxtree/error.h>

#include "cooker/farm/cook_cache.h"
#include "cooker/farm/cook_key.h"
#include "cooker/farm/journal.h"
#include "cooker/shell/cook_job.h"

namespace boxtree::cooker {

/// Where outputs are looked for; both may be missing.
struct KeyedStores {
  const CookCache* cache = nullptr;
  Journal* journal = nullptr;
  /// [0] [0 to 1] The share of what the cache has that is cooked again, by chance, and compared.
  double audit_share = 0;
  /// What to keep with an output, for those who get it from the cache.
  std::function<std::string(const Summary& summary)> report;
  /// Whether the journal need not read an output again that has not changed since (FileState).
  bool trusts_states = false;
};

struct KeyedOutcome {
  enum class How : std::uint8_t {
    kCooked,
    kFromCache,
    kThere,  // the output has been there, by the journal
  };
  How how = How::kCooked;
  bool is_audited = false;         // was in the cache, and was cooked all the same
  std::uint64_t bytes = 0;         // of the output
  std::string report;              // empty if the output has been there
  std::optional<Summary> summary;  // of what was cooked
  /// What an audit has found: other bytes in the cache than the cook made, which are now in the
  /// cache, and the output. The cooker has a fault, or the machine, or who wrote into the cache.
  std::optional<Error> difference;
};

/// Whether outputs of a job can be kept under its key: not those of streams, nor those of two
/// files.
[[nodiscard]] bool has_keyed_output(const CookJob& job);

/// Makes the output of a job, and its depfile, from the journal, from the cache or by cooking it.
/// An output that is there and right, but older than a file that it is made of, gets a new time.
/// Kept under the key are only bytes of files that did not change while they were cooked, and that
/// the key names: after a cook the key is computed anew. Safe for several threads with different
/// outputs. Precondition: has_keyed_output(job), and `key` is what key_of(job) has just returned.
///
/// Errors: those of cook_job and Journal::add; kFileUnreadable for files that changed while they
/// were cooked, which passes. kInternal for a file that was read and is not in the key.
Result<KeyedOutcome> cook_by_key(const CookJob& job, const JobKey& key, const KeyedStores& stores,
                                 const Progress& progress = {});

}  // namespace boxtree::cooker
