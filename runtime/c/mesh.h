// SPDX-License-Identifier: MIT
// Arrays of C callers for trees with external geometry.
#pragma once

#include <boxtree_c.h>
#include <cstddef>
#include <optional>

#include <boxtree/tree.h>

#include "runtime/c/call.h"

namespace boxtree::c {

/// Reads them. False if the size of the struct is none.
[[nodiscard]] inline bool read_mesh(const bxt_mesh* given,
                                    std::optional<MeshArrays>& mesh) noexcept {
  bxt_mesh read = {};
  if (given == nullptr || !read_struct(given, read)) return false;
  mesh = MeshArrays{.positions = static_cast<const std::byte*>(read.positions),
                    .position_stride = static_cast<std::size_t>(read.position_stride),
                    .positions_f64 = read.positions_are_double,
                    .vertex_count = read.vertex_count,
                    .corners = static_cast<const std::byte*>(read.corners),
                    .corner_bytes = read.corner_bytes,
                    .corners_per_face = read.corners_per_face,
                    .face_count = read.face_count};
  return true;
}

}  // namespace boxtree::c
