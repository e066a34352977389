// SPDX-License-Identifier: MIT
// Refuses glTF files whose nesting would overflow assimp's stack or take unbounded time: assimp
// visits JSON values and nodes by recursion, and a node once per path to it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <boxtree/error.h>

#include "cooker/import/node_nesting.h"
#include "cooker/text/json.h"

namespace boxtree::cooker {

/// Limit of nested JSON values. Those of nodes are in node_nesting.h.
inline constexpr std::uint32_t kMaxJsonDepth = 256;

/// The document in `text`, glTF 1 or 2; null if it is not JSON, for the reader to refuse.
/// kImportFailed if it nests deeper than the limits, its nodes form a cycle, or an object has two
/// members of one name. O(bytes log bytes).
Result<Json> parse_gltf(std::string_view text);

/// What keeps `text` from being JSON, in words; empty if nothing does. O(bytes log bytes).
[[nodiscard]] std::string json_fault(std::string_view text);

}  // namespace boxtree::cooker
