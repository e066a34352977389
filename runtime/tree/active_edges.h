// SPDX-License-Identifier: MIT
// Which edges of a triangle of a tree are active.
#pragma once

#include <cstdint>

#include "format/active_edges.h"
#include "runtime/primitive/triangle.h"

namespace boxtree {

/// By what the bit of edge `i` of a triangle, in tree space, is found: the ends of the edge,
/// whichever comes first, or, by face, the ends in the order of the face and its third corner.
[[nodiscard]] std::uint64_t hash_of_edge(const Triangle& triangle, std::uint32_t i,
                                         const ActiveEdgesHeader& header) noexcept;

inline constexpr std::uint32_t kAllEdges = 7;

/// Bit i: the edge from corner i of a triangle, in tree space, to the next one. All without a
/// section, and of triangles without an area. Precondition: the face exists.
[[nodiscard]] std::uint32_t active_edges_of(const ActiveEdgesView& edges, std::uint32_t face,
                                            const Triangle& triangle) noexcept;

}  // namespace boxtree
