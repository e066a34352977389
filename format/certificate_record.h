// SPDX-License-Identifier: MIT
// What was proven of one tree.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace boxtree {

/// What the cooker proved about the tree after it had written it; `boxtree verify` proves it again.
struct CertificateRecord {
  double max_vertex_error;     // largest distance of a stored from a source vertex, object space
  std::uint32_t depth;         // equals TreeRecord::depth
  std::uint32_t node_count;    // nodes reached from the root
  std::uint32_t leaf_count;    // leaves reached
  std::uint32_t face_count;    // faces reached, each exactly once; duplicates via originals
  std::uint32_t shrink_count;  // nodes with one child
  std::uint32_t degenerate_count;  // triangles without area, kept
  std::array<std::uint64_t, 4> reserved;
};
static_assert(sizeof(CertificateRecord) == 64 && std::is_trivially_copyable_v<CertificateRecord>);
static_assert(offsetof(CertificateRecord, degenerate_count) == 28);

}  // namespace boxtree
