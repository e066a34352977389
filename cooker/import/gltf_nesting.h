// SPDX-License-Identifier: MIT
// glTF files whose nesting would take assimp's stack or all time there is: it goes down JSON values
// and nodes by recursion, and visits a node once for each way that leads to it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string_view>

#include <boxtree/format/result.h>

namespace boxtree::cooker {

/// JSON values inside each other; nodes below each other; visits of nodes, one for each path from a
/// node without a parent, beyond one for each node: some two seconds of assimp's time.
inline constexpr std::uint32_t kMaxJsonDepth = 256;
inline constexpr std::uint32_t kMaxNodeDepth = 1024;
inline constexpr std::uint64_t kMaxRepeatedVisits = std::uint64_t{1} << 18;

/// Refuses a JSON text, glTF 1 or 2, that nests deeper, or whose nodes are below themselves:
/// kImportFailed. Other faults pass. O(bytes log bytes).
Status check_gltf_nesting(std::string_view json);

/// The same of a .gltf or .glb file; others pass.
Status check_gltf_nesting(const std::filesystem::path& path);

}  // namespace boxtree::cooker
