// SPDX-License-Identifier: MIT
// Visits parents before children (Kahn, "Topological sorting of large networks", 1962).
#include "cooker/import/node_nesting.h"

#include <algorithm>
#include <cstddef>

#include <fmt/format.h>

namespace boxtree::cooker {
namespace {

// `parents`: of each node how many were not visited. Whoever has one has a parent that has one, so
// that the way up from there ends in a cycle.
std::uint32_t node_of_cycle(const NodesBelow& children,
                            const std::vector<std::uint32_t>& parents) {
  const auto is_left = [](std::uint32_t count) { return count > 0; };
  std::vector<std::uint32_t> above(children.size(), 0);
  for (std::uint32_t node = 0; node < children.size(); ++node) {
    if (!is_left(parents[node])) continue;
    for (const std::uint32_t child : children[node]) above[child] = node;
  }
  const auto first = std::find_if(parents.begin(), parents.end(), is_left);
  auto node = static_cast<std::uint32_t>(first - parents.begin());
  for (std::size_t step = 0; step < children.size(); ++step) node = above[node];
  std::uint32_t smallest = node;
  for (std::uint32_t at = above[node]; at != node; at = above[at]) {
    smallest = std::min(smallest, at);
  }
  return smallest;
}

}  // namespace

// The nodes of a cycle are never reached.
std::optional<NestingFault> find_nesting_fault(const NodesBelow& children) {
  std::vector<std::uint32_t> parents(children.size(), 0), depth(children.size(), 1);
  std::vector<std::uint64_t> visits(children.size(), 0);
  for (const auto& of_node : children) {
    for (const std::uint32_t child : of_node) ++parents[child];
  }
  std::vector<std::uint32_t> free;
  for (std::uint32_t node = 0; node < children.size(); ++node) {
    if (parents[node] > 0) continue;
    free.push_back(node);
    visits[node] = 1;
  }
  const std::uint64_t most = children.size() + kMaxRepeatedVisits;
  std::uint64_t all_visits = 0;
  for (std::size_t next = 0; next < free.size(); ++next) {
    const std::uint32_t node = free[next];
    all_visits += visits[node];
    if (depth[node] > kMaxNodeDepth) {
      return NestingFault{node, fmt::format("more than {} nodes below each other", kMaxNodeDepth)};
    }
    if (all_visits > most) {
      return NestingFault{
          node, fmt::format("shared by so many parents that more than {} instances arise", most)};
    }
    for (const std::uint32_t child : children[node]) {
      visits[child] = std::min(visits[child] + visits[node], most + 1);
      depth[child] = std::max(depth[child], depth[node] + 1);
      if (--parents[child] == 0) free.push_back(child);
    }
  }
  if (free.size() == children.size()) return std::nullopt;
  return NestingFault{node_of_cycle(children, parents), "it is below itself"};
}

}  // namespace boxtree::cooker
