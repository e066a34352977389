// SPDX-License-Identifier: MIT
// Looks edges up by their ends.
#include "runtime/tree/active_edges.h"

#include <algorithm>
#include <array>
#include <span>

#include "runtime/file/checksum.h"
#include "runtime/primitive/normal.h"

namespace boxtree {

std::uint64_t hash_of_edge(const Triangle& triangle, std::uint32_t i,
                           const ActiveEdgesHeader& header) noexcept {
  std::array<double, 10> key{static_cast<double>(header.seed)};
  for (std::uint32_t corner = 0; corner < 3; ++corner) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      // -0 + 0 is 0
      key[1 + 3 * corner + k] =
          triangle.corner[(i + corner) % 3][static_cast<Eigen::Index>(k)] + 0.0;
    }
  }
  if (header.is_by_face != 0) return checksum(std::as_bytes(std::span(key)));
  const auto first = key.begin() + 1, second = key.begin() + 4, third = key.begin() + 7;
  if (std::lexicographical_compare(second, third, first, second)) {
    std::swap_ranges(first, second, second);
  }
  return checksum(std::as_bytes(std::span(key).first<7>()));
}

std::uint32_t active_edges_of(const ActiveEdgesView& edges, std::uint32_t face,
                              const Triangle& triangle) noexcept {
  if (!edges) return kAllEdges;
  const LeafEdges leaf = edges.leaf_of(face);
  if (leaf == LeafEdges::kAll || unit_normal(triangle).isZero(0)) return kAllEdges;
  if (leaf == LeafEdges::kNone) return 0;
  const ActiveEdgesHeader header = edges.header();
  std::uint32_t active = 0;
  for (std::uint32_t i = 0; i < 3; ++i) {
    if (edges.bit_of(hash_of_edge(triangle, i, header))) active |= 1u << i;
  }
  return active;
}

}  // namespace boxtree
