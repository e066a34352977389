// SPDX-License-Identifier: MIT
// Entries of a cache as Bazel's servers have them: a message ActionResult of the Remote Execution
// API (build/bazel/remote/execution/v2), in the wire format of protocol buffers.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "cooker/farm/cook_cache.h"

namespace boxtree::cooker {

/// The output is the one output file, the report what the action printed on standard error. The
/// file is called by a seal, a SHA-256 over the key and all of the entry, which tells damage, and
/// an entry that is there under another key.
[[nodiscard]] std::string action_result_of(const Digest& key, const CookCache::Entry& entry);

/// What action_result_of has written, also after a server that has parsed it has written it anew,
/// with fields of its own. Nothing of any other bytes.
[[nodiscard]] std::optional<CookCache::Entry> entry_in_action_result(std::string_view bytes,
                                                                     const Digest& key);

}  // namespace boxtree::cooker
