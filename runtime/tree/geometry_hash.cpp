// SPDX-License-Identifier: MIT
// Hashes the content of a mesh.
#include <algorithm>
#include <array>
#include <span>

#include "format/message.h"
#include "runtime/file/checksum_stream.h"
#include "runtime/tree/geometry.h"

namespace boxtree {
namespace {

// A checksum of short pieces: they are gathered, because each addition costs more than its bytes.
class GatheredChecksum {
 public:
  // Precondition: a piece is not larger than the buffer.
  void add(Bytes piece) noexcept {
    if (piece.size() > buffer_.size() - used_) flush();
    std::copy(piece.begin(), piece.end(), buffer_.begin() + static_cast<std::ptrdiff_t>(used_));
    used_ += piece.size();
  }
  [[nodiscard]] std::uint64_t value() noexcept {
    flush();
    return stream_.value();
  }

 private:
  void flush() noexcept {
    stream_.add(std::span(buffer_).first(used_));
    used_ = 0;
  }

  ChecksumStream stream_;
  std::array<std::byte, 4096> buffer_;
  std::size_t used_ = 0;
};

}  // namespace

Result<std::uint64_t> geometry_hash(const MeshArrays& mesh) {
  GatheredChecksum sum;
  const std::size_t position_bytes = 3 * (mesh.positions_f64 ? sizeof(double) : sizeof(float));
  for (std::uint32_t f = 0; f < mesh.face_count; ++f) {
    const std::array<std::uint32_t, 4> corner = face_of(mesh, f);
    const std::uint32_t count = corner[3] == kMissingCorner ? 3 : 4;
    sum.add(std::as_bytes(std::span(&count, 1)));
    for (std::size_t i = 0; i < count; ++i) {
      if (corner[i] >= mesh.vertex_count) {
        return error_with(Errc::kVertexOutOfRange, {}, "face # names vertex # of #",
                          {f, corner[i], mesh.vertex_count});
      }
      sum.add({mesh.positions + std::size_t{corner[i]} * mesh.position_stride, position_bytes});
    }
  }
  return sum.value();
}

}  // namespace boxtree
