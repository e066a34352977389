// SPDX-License-Identifier: MIT
// Decoding of one leaf of the grid store (encoder: cooker/encode/grid_geometry.cpp).
#include "format/grid.h"

#include "format/bits.h"
#include "format/grid_leaf.h"

namespace boxtree {
namespace {

void read_positions(const GridOffsets& offsets, const std::byte* bytes, const GridLeafFaces& faces,
                    GridLeaf& out) {
  for (std::uint32_t i = 0; i < faces.vertex_count; ++i) {
    std::uint64_t at = offsets.start + std::uint64_t{faces.vertex[i]} * offsets.stride;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint64_t offset = read_bits(bytes, at, offsets.width[k]);
      // Unsigned, so that corrupt sums wrap.
      out.position[i][k] = static_cast<std::int32_t>(static_cast<std::uint32_t>(offsets.origin[k]) +
                                                     static_cast<std::uint32_t>(offset));
      at += offsets.width[k];
    }
    out.position[i][3] = 0;
  }
}

}  // namespace

bool decode_grid_leaf(const GridView& grid, std::uint32_t leaf, GridLeaf& out) noexcept {
  GridLeafFaces faces;
  GridOffsets offsets;
  if (!read_grid_faces(grid, leaf, grid.corners_per_face == 4, faces, offsets)) return false;
  out.vertex_count = faces.vertex_count;
  out.face_count = faces.face_count;
  out.corner = faces.corner;
  read_positions(offsets, grid.bytes.data(), faces, out);
  return true;
}

}  // namespace boxtree
