// SPDX-License-Identifier: MIT
// glTF files whose nesting would take assimp's stack or all time there is: it goes down JSON values
// and nodes by recursion, and visits a node once for each way that leads to it.
#pragma once

#include <cstdint>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include <boxtree/error.h>

namespace boxtree::cooker {

/// JSON values inside each other; nodes below each other; visits of nodes, one for each path from a
/// node without a parent, beyond one for each node: some two seconds of assimp's time.
inline constexpr std::uint32_t kMaxJsonDepth = 256;
inline constexpr std::uint32_t kMaxNodeDepth = 1024;
inline constexpr std::uint64_t kMaxRepeatedVisits = std::uint64_t{1} << 18;

/// The document that a text, glTF 1 or 2, holds; a discarded value if it is no JSON, for the reader
/// to refuse. kImportFailed if it nests deeper, or its nodes are below themselves. O(bytes log
/// bytes).
Result<nlohmann::json> parse_gltf(std::string_view text);

}  // namespace boxtree::cooker
