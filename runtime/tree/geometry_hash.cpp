// SPDX-License-Identifier: MIT
// Hashes the content of a mesh.
#include <span>
#include <string>

#include "runtime/file/checksum_stream.h"
#include "runtime/tree/geometry.h"

namespace boxtree {

Result<std::uint64_t> geometry_hash(const MeshArrays& mesh) {
  ChecksumStream stream;
  const std::size_t position_bytes = 3 * (mesh.positions_f64 ? sizeof(double) : sizeof(float));
  for (std::uint32_t f = 0; f < mesh.face_count; ++f) {
    const std::array<std::uint32_t, 4> corner = face_of(mesh, f);
    const std::uint32_t count = corner[3] == kMissingCorner ? 3 : 4;
    stream.add(std::as_bytes(std::span(&count, 1)));
    for (std::size_t i = 0; i < count; ++i) {
      if (corner[i] >= mesh.vertex_count) {
        return Error{Errc::kVertexOutOfRange, "face " + std::to_string(f) + " names vertex " +
                                                  std::to_string(corner[i]) + " of " +
                                                  std::to_string(mesh.vertex_count)};
      }
      stream.add({mesh.positions + std::size_t{corner[i]} * mesh.position_stride, position_bytes});
    }
  }
  return stream.value();
}

}  // namespace boxtree
