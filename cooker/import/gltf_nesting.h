// SPDX-License-Identifier: MIT
// Refuses glTF files whose nesting would overflow assimp's stack or take unbounded time: assimp
// visits JSON values and nodes by recursion, and a node once per path to it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// Limits of nested JSON values, of nested nodes, and of repeated visits of nodes (one per path
/// from a node without a parent, minus one per node): some two seconds of assimp's time.
inline constexpr std::uint32_t kMaxJsonDepth = 256;
inline constexpr std::uint32_t kMaxNodeDepth = 1024;
inline constexpr std::uint64_t kMaxRepeatedVisits = std::uint64_t{1} << 18;

/// The document in `text`, glTF 1 or 2; a discarded value if it is not JSON, for the reader to
/// refuse. kImportFailed if it nests deeper than the limits, its nodes form a cycle, or an object
/// has two members of one name. O(bytes log bytes).
Result<nlohmann::json> parse_gltf(std::string_view text);

/// What keeps `text` from being JSON, in words; empty if nothing does. O(bytes).
[[nodiscard]] std::string json_fault(std::string_view text);

}  // namespace boxtree::cooker
