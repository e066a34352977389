// SPDX-License-Identifier: MIT
// Whether nodes of a scene nest so that assimp, which visits a node by recursion and once per path
// to it, would overflow its stack or take unbounded time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace boxtree::cooker {

/// Limits of nested nodes, and of repeated visits of nodes (one per path from a node without a
/// parent, minus one per node): some two seconds of assimp's time.
inline constexpr std::uint32_t kMaxNodeDepth = 1024;
inline constexpr std::uint64_t kMaxRepeatedVisits = std::uint64_t{1} << 18;

/// Numbers of the nodes below each node.
using NodesBelow = std::vector<std::vector<std::uint32_t>>;

struct NestingFault {
  std::uint32_t node;
  std::string what;
};

/// A node that is below itself, or is where a limit is passed; empty if there is none. Time: linear
/// in nodes and children.
[[nodiscard]] std::optional<NestingFault> find_nesting_fault(const NodesBelow& children);

}  // namespace boxtree::cooker
