// SPDX-License-Identifier: MIT
// 80 bytes of anything, the number of triangles, then 50 bytes each: normal, three corners, two
// bytes of attributes. Always little-endian, whatever the machine.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <string>

#include <fmt/format.h>

#include <boxtree/cooker/import/binary_stl.h>
#include <boxtree/cooker/import/direct_import.h>
#include <boxtree/cooker/import/source_stream.h>
#include <boxtree/cooker/import/stl_mesh.h>
#include <boxtree/cooker/import/text_tokens.h>

namespace boxtree::cooker {
namespace {

constexpr std::size_t kHeaderBytes = 84;
constexpr std::size_t kCountOffset = 80;
constexpr std::size_t kTriangleBytes = 50;
constexpr std::size_t kCornersOffset = 12;
constexpr std::size_t kCornerBytes = 12;

// Triangles at once; while some are welded, those some places further on are fetched.
constexpr std::size_t kTrianglesAtOnce = 2048;
constexpr std::size_t kAhead = 6;
static_assert(kTrianglesAtOnce * kTriangleBytes <= SourceStream::kBufferBytes);

std::uint32_t load_word(const char* at) {
  std::array<unsigned char, 4> bytes;
  std::memcpy(bytes.data(), at, sizeof(bytes));
  return std::uint32_t{bytes[0]} | std::uint32_t{bytes[1]} << 8 | std::uint32_t{bytes[2]} << 16 |
         std::uint32_t{bytes[3]} << 24;
}

template <class T>
std::array<T, 3> load_corner(const char* triangle, std::size_t corner) {
  std::array<T, 3> position;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const char* const at = triangle + kCornersOffset + kCornerBytes * corner + 4 * axis;
    position[axis] = std::bit_cast<float>(load_word(at));
  }
  return position;
}

// Whether it is a text as far as the header of a binary file would go. Those may begin with
// "solid", too, but no text holds a zero.
bool is_text(std::string_view start) {
  const std::string_view header = start.substr(0, kHeaderBytes);
  const std::size_t word = header.find_first_not_of(" \t");
  return word != std::string_view::npos && begins_with_solid(header.substr(word)) &&
         header.find('\0') == std::string_view::npos;
}

template <class T>
Status read_triangles(SourceStream& stream, std::uint32_t count, StlMesh<T>& mesh) {
  if (Status status = mesh.begin(count); !status.ok()) return status;
  for (std::uint32_t id = 0; id < count;) {
    const auto step = std::min<std::size_t>(count - id, kTrianglesAtOnce);
    const char* const triangles = stream.take(step * kTriangleBytes);
    if (triangles == nullptr) return stream.ended_in(fmt::format("face {} or later", id));
    for (std::size_t i = 0; i < step; ++i, ++id) {
      const char* const triangle = triangles + kTriangleBytes * i;
      for (std::size_t corner = 0; i + kAhead < step && corner < 3; ++corner) {
        mesh.prefetch(load_corner<T>(triangle + kTriangleBytes * kAhead, corner));
      }
      const Status status = mesh.add(
          {load_corner<T>(triangle, 0), load_corner<T>(triangle, 1), load_corner<T>(triangle, 2)});
      if (!status.ok()) return status;
    }
  }
  return mesh.finish();
}

}  // namespace

Result<bool> import_binary_stl(const std::filesystem::path& path, const ImportOptions& options,
                               Imported& out) {
  Result<SourceStream> stream = SourceStream::open(path);
  if (!stream.ok()) return stream.error();
  const std::string_view start = stream->ahead();
  if (start.size() < kHeaderBytes) return false;
  const std::uint32_t count = load_word(start.data() + kCountOffset);
  const std::uint64_t bytes = kHeaderBytes + std::uint64_t{kTriangleBytes} * count;
  if (bytes != stream->left()) {
    if (is_text(start)) return false;
    return Error{Errc::kImportFailed,
                 fmt::format("{}: {} triangles take {} bytes, but the file has {}", path.string(),
                             count, bytes, stream->left())};
  }
  if (count == 0) return false;
  static_cast<void>(stream->take(kHeaderBytes));

  return read_into(*stream, path, options, out, [&]<class T>(std::vector<T>& positions) {
    StlMesh<T> mesh(path.string(), options, positions, out);
    return read_triangles(*stream, count, mesh);
  });
}

}  // namespace boxtree::cooker
