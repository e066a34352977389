// SPDX-License-Identifier: MIT
// 80 bytes of anything, the number of triangles, then 50 bytes each: normal, three corners, two
// bytes of attributes. Always little-endian, whatever the machine.
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>

#include <fmt/format.h>

#include <boxtree/cooker/import/binary_stl.h>
#include <boxtree/cooker/import/direct_import.h>
#include <boxtree/cooker/import/face_intake.h>
#include <boxtree/cooker/import/source_stream.h>
#include <boxtree/cooker/import/weld.h>

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

template <class T>
bool is_finite(const std::array<T, 3>& position) {
  return std::isfinite(position[0]) && std::isfinite(position[1]) && std::isfinite(position[2]);
}

// Whether it is a text as far as the header of a binary file would go. Those may begin with
// "solid", too, but no text holds a zero.
bool is_text(std::string_view start) {
  const std::string_view header = start.substr(0, kHeaderBytes);
  const std::size_t word = header.find_first_not_of(" \t");
  return word != std::string_view::npos && header.substr(word).starts_with("solid") &&
         header.find('\0') == std::string_view::npos;
}

// T is the type of the positions.
template <class T>
class Reader {
 public:
  Reader(SourceStream& stream, std::string file, const ImportOptions& options,
         std::vector<T>& positions, Imported& out)
      : stream_(stream),
        file_(std::move(file)),
        options_(options),
        positions_(positions),
        report_(out.report),
        welder_(positions),
        intake_(positions, out),
        out_(out) {}

  Status read(std::uint32_t count);

 private:
  Status take_triangle(const char* triangle, std::uint32_t face_id);

  SourceStream& stream_;
  const std::string file_;
  const ImportOptions& options_;
  std::vector<T>& positions_;
  ImportReport& report_;
  Welder<T> welder_;
  FaceIntake<T> intake_;
  Imported& out_;
};

template <class T>
Status Reader<T>::read(std::uint32_t count) {
  if (Status status = check_face_count(count, file_); !status.ok()) return status;
  out_.mesh.faces.reserve(count);
  welder_.reserve(count / 2 + count / 32);  // a closed surface has half a vertex a triangle
  for (std::uint32_t id = 0; id < count;) {
    const auto step = std::min<std::size_t>(count - id, kTrianglesAtOnce);
    const char* const triangles = stream_.take(step * kTriangleBytes);
    if (triangles == nullptr) return stream_.ended_in(fmt::format("face {} or later", id));
    for (std::size_t i = 0; i < step; ++i, ++id) {
      const char* const triangle = triangles + kTriangleBytes * i;
      for (std::size_t corner = 0; i + kAhead < step && corner < 3; ++corner) {
        welder_.prefetch(load_corner<T>(triangle + kTriangleBytes * kAhead, corner));
      }
      if (Status status = take_triangle(triangle, id); !status.ok()) return status;
    }
  }
  report_.source_faces = count;
  report_.source_vertices = std::size_t{3} * count;
  report_.vertices_unused = 3 * report_.skipped.size();
  report_.vertices_welded = report_.source_vertices - report_.vertices_unused - welder_.size();
  return check_taken(file_, out_);
}

template <class T>
Status Reader<T>::take_triangle(const char* triangle, std::uint32_t face_id) {
  std::array<std::array<T, 3>, 3> corners;
  for (std::size_t corner = 0; corner < 3; ++corner) {
    corners[corner] = load_corner<T>(triangle, corner);
    const auto& [x, y, z] = corners[corner];
    if (is_finite(corners[corner])) continue;
    // Every corner is a vertex of its own in such a file.
    const std::string name = fmt::format("vertex {}", std::uint64_t{3} * face_id + corner);
    return report_fault(vertex_not_finite(name, {x, y, z}), face_id, file_, options_, report_);
  }
  const std::uint32_t a = welder_.add(corners[0]);
  const std::uint32_t b = welder_.add(corners[1]);
  const std::uint32_t c = welder_.add(corners[2]);
  intake_.add_triangle(face_id, {a, b, c});
  return {};
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
    return Reader<T>(*stream, path.string(), options, positions, out).read(count);
  });
}

}  // namespace boxtree::cooker
