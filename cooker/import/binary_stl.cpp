// SPDX-License-Identifier: MIT
// 80 bytes of any content, the number of triangles, then 50 bytes each: normal, three corners, two
// bytes of attributes. Always little-endian.
#include "cooker/import/binary_stl.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

#include <fmt/format.h>

#include "cooker/import/file_error.h"

namespace boxtree::cooker {
namespace {

constexpr std::size_t kHeaderBytes = kStlHeaderBytes;
constexpr std::size_t kCountOffset = 80;
constexpr std::size_t kCornerBytes = 12;

// Triangles per block; while some are welded, later ones are prefetched.
constexpr std::size_t kTrianglesAtOnce = 2048;
constexpr std::size_t kAhead = 6;
static_assert(kTrianglesAtOnce * kStlTriangleBytes <= SourceStream::kBufferBytes);

std::uint32_t load_word(const char* at) {
  std::array<unsigned char, 4> bytes;
  std::memcpy(bytes.data(), at, sizeof(bytes));
  return std::uint32_t{bytes[0]} | std::uint32_t{bytes[1]} << 8 | std::uint32_t{bytes[2]} << 16 |
         std::uint32_t{bytes[3]} << 24;
}

std::uint64_t bytes_of(std::uint32_t triangles) {
  return kHeaderBytes + std::uint64_t{kStlTriangleBytes} * triangles;
}

template <class T>
std::array<T, 3> load_corner(const char* triangle, std::size_t corner) {
  std::array<T, 3> position;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const char* const at = triangle + kStlCornersOffset + kCornerBytes * corner + 4 * axis;
    position[axis] = std::bit_cast<float>(load_word(at));
  }
  return position;
}

}  // namespace

bool is_binary_stl(const SourceStream& stream) {
  if (stream.ahead().size() < kHeaderBytes) return false;
  return bytes_of(load_word(stream.ahead().data() + kCountOffset)) == stream.left();
}

template <class T>
Status read_binary_stl(SourceStream& stream, const std::string& file, StlMesh<T>& mesh) {
  const char* const header = stream.take(kHeaderBytes);
  if (header == nullptr) return stream.ended_in("its header");
  const std::uint32_t count = load_word(header + kCountOffset);
  if (bytes_of(count) != kHeaderBytes + stream.left()) {
    const std::uint64_t found = kHeaderBytes + stream.left();
    return Error{Errc::kImportFailed,
                 fmt::format("{}: {} triangles take {} bytes, but the file has {}{}", file, count,
                             bytes_of(count), found, found < bytes_of(count) ? kAsIfCut : "")};
  }
  if (Status status = mesh.begin(count); !status.ok()) return status;
  for (std::uint32_t id = 0; id < count;) {
    const auto step = std::min<std::size_t>(count - id, kTrianglesAtOnce);
    const char* const triangles = stream.take(step * kStlTriangleBytes);
    if (triangles == nullptr) return stream.ended_in(fmt::format("face {} or later", id));
    for (std::size_t i = 0; i < step; ++i, ++id) {
      const char* const triangle = triangles + kStlTriangleBytes * i;
      for (std::size_t corner = 0; i + kAhead < step && corner < 3; ++corner) {
        mesh.prefetch(load_corner<T>(triangle + kStlTriangleBytes * kAhead, corner));
      }
      Status status = mesh.add(
          {load_corner<T>(triangle, 0), load_corner<T>(triangle, 1), load_corner<T>(triangle, 2)});
      if (!status.ok()) return status;
    }
  }
  return mesh.finish();
}

template Status read_binary_stl(SourceStream&, const std::string&, StlMesh<float>&);
template Status read_binary_stl(SourceStream&, const std::string&, StlMesh<double>&);

}  // namespace boxtree::cooker
