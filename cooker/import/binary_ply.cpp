// SPDX-License-Identifier: MIT
// One walk over the elements of the file: vertices into the mesh, faces into it with the numbers of
// the file, everything else passed over; then vertices are welded and corners get their new
// numbers.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <boxtree/cooker/import/binary_ply.h>
#include <boxtree/cooker/import/direct_import.h>
#include <boxtree/cooker/import/face_intake.h>
#include <boxtree/cooker/import/ply_header.h>
#include <boxtree/cooker/import/source_stream.h>
#include <boxtree/cooker/import/weld.h>

namespace boxtree::cooker {
namespace {

// Corners read at once: a polygon may have any number of them.
constexpr std::size_t kCornersAtOnce = 4096;
static_assert(8 * kCornersAtOnce <= SourceStream::kBufferBytes);

constexpr std::uint64_t kMaxVertices = 0xfffffffeu;  // corners of faces are 32 bits, one is special

struct Coordinate {
  std::size_t offset = 0;  // in the record of a vertex
  PlyType type = PlyType::kFloat32;
};

struct Layout {
  PlyHeader header;
  const PlyElement* vertex = nullptr;
  const PlyElement* face = nullptr;
  const PlyProperty* corners = nullptr;  // of faces: which of their lists
  std::array<Coordinate, 3> xyz;
  bool swapped = false;
};

// Bytes that one of `element` takes at least: lists may be empty.
std::size_t least_bytes(const PlyElement& element) {
  std::size_t bytes = 0;
  for (const PlyProperty& property : element.properties) {
    bytes += size_of(property.length.value_or(property.type));
  }
  return bytes;
}

bool find_coordinates(Layout& layout) {
  constexpr std::array<std::string_view, 3> kNames = {"x", "y", "z"};
  std::array<int, 3> found{};
  std::size_t offset = 0;
  for (const PlyProperty& property : layout.vertex->properties) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (property.name != kNames[k]) continue;
      layout.xyz[k] = {offset, property.type};
      ++found[k];
    }
    offset += size_of(property.type);
  }
  return found == std::array{1, 1, 1} && offset <= SourceStream::kBufferBytes;
}

bool find_corners(Layout& layout) {
  for (const PlyProperty& property : layout.face->properties) {
    if (property.name != "vertex_indices" && property.name != "vertex_index") continue;
    if (layout.corners != nullptr || !property.length || !is_integer(property.type)) return false;
    layout.corners = &property;
  }
  return layout.corners != nullptr;
}

// Elements and properties that we can read as assimp means to. Points into the header, so that a
// Layout must stay where it is.
bool find_parts(Layout& layout) {
  if (!layout.header.is_plain || layout.header.form == PlyHeader::Form::kText) return false;
  layout.swapped = (layout.header.form == PlyHeader::Form::kBigEndian) ==
                   (std::endian::native == std::endian::little);
  for (const PlyElement& element : layout.header.elements) {
    if (!element.is_understood || element.name == "tristrips") return false;
    for (const PlyProperty& property : element.properties) {
      if (property.length && !is_integer(*property.length)) return false;
    }
    if (element.name == "vertex") {
      if (layout.vertex != nullptr) return false;
      layout.vertex = &element;
    } else if (element.name == "face") {
      if (layout.face != nullptr || layout.vertex == nullptr) return false;
      layout.face = &element;
    }
  }
  return layout.vertex != nullptr && layout.face != nullptr && layout.vertex->count > 0 &&
         layout.face->count > 0 && !layout.vertex->has_lists() && find_coordinates(layout) &&
         find_corners(layout);
}

// T is the type of the positions.
template <class T>
class Reader {
 public:
  Reader(SourceStream& stream, const Layout& layout, std::string file, const ImportOptions& options,
         std::vector<T>& positions, Imported& out)
      : stream_(stream),
        layout_(layout),
        file_(std::move(file)),
        options_(options),
        positions_(positions),
        out_(out),
        intake_(positions, out) {}

  Status read();

 private:
  Status read_element(const PlyElement& element);
  Status read_vertices();
  Status read_faces();
  Status read_record(const PlyElement& element, std::uint64_t number);
  Status read_list(const PlyElement& element, const PlyProperty& list, std::uint64_t number);
  Status take_face();
  [[nodiscard]] std::optional<FaceFault> fault_of_face() const;
  [[nodiscard]] bool is_finite(std::size_t vertex) const;
  [[nodiscard]] RoundedCorner rounded_corner(std::size_t corner) const;
  void weld();
  [[nodiscard]] Error ended_in(const PlyElement& element, std::uint64_t number) const {
    return stream_.ended_in(fmt::format("{} {}", element.name, number));
  }

  SourceStream& stream_;
  const Layout& layout_;
  const std::string file_;
  const ImportOptions& options_;
  std::vector<T>& positions_;
  Imported& out_;
  FaceIntake<T> intake_;
  std::vector<std::uint32_t> numbers_;  // of vertices, for weld_in_place
  std::vector<std::uint32_t> corners_;  // of the face at hand
  bool all_finite_ = true;
  std::uint32_t next_face_id_ = 0;
};

template <class T>
Status Reader<T>::read() {
  for (const PlyElement& element : layout_.header.elements) {
    // Before anything is made room for: counts are whatever the header says.
    const std::size_t least = least_bytes(element);
    if (least > 0 && element.count > stream_.left() / least) {
      return Error{Errc::kImportFailed,
                   fmt::format("{}: {} elements '{}' cannot be in {} bytes", file_, element.count,
                               element.name, stream_.left())};
    }
    if (Status status = read_element(element); !status.ok()) return status;
  }
  weld();
  return check_taken(file_, out_);
}

template <class T>
Status Reader<T>::read_element(const PlyElement& element) {
  if (&element == layout_.vertex) return read_vertices();
  if (&element == layout_.face) return read_faces();
  if (!element.has_lists()) {
    return stream_.skip(element.count * least_bytes(element)) ? Status()
                                                              : ended_in(element, element.count);
  }
  for (std::uint64_t i = 0; i < element.count; ++i) {
    if (Status status = read_record(element, i); !status.ok()) return status;
  }
  return {};
}

template <class T>
Status Reader<T>::read_vertices() {
  const std::uint64_t count = layout_.vertex->count;
  if (count > kMaxVertices) {
    return Error{Errc::kMeshTooLarge,
                 fmt::format("{}: {} vertices, more than {}", file_, count, kMaxVertices)};
  }
  const std::size_t stride = least_bytes(*layout_.vertex);
  positions_.resize(3 * count);
  T* to = positions_.data();
  for (std::uint64_t i = 0; i < count; ++i) {
    const char* const vertex = stream_.take(stride);
    if (vertex == nullptr) return ended_in(*layout_.vertex, i);
    for (const Coordinate& coordinate : layout_.xyz) {
      const double value =
          load_ply_value(vertex + coordinate.offset, coordinate.type, layout_.swapped);
      *to = static_cast<T>(value);
      all_finite_ = all_finite_ && std::isfinite(*to);
      ++to;
    }
  }
  numbers_.assign(count, kWeldUnused);
  out_.report.source_vertices = count;
  return {};
}

template <class T>
Status Reader<T>::read_faces() {
  const std::uint64_t count = layout_.face->count;
  if (Status status = check_face_count(count, file_); !status.ok()) return status;
  out_.mesh.faces.reserve(count);
  for (std::uint64_t i = 0; i < count; ++i) {
    if (Status status = read_record(*layout_.face, i); !status.ok()) return status;
    if (Status status = take_face(); !status.ok()) return status;
  }
  return {};
}

// One record of an element with lists; of a face the corners are kept.
template <class T>
Status Reader<T>::read_record(const PlyElement& element, std::uint64_t number) {
  for (const PlyProperty& property : element.properties) {
    if (property.length) {
      if (Status status = read_list(element, property, number); !status.ok()) return status;
    } else if (stream_.take(size_of(property.type)) == nullptr) {
      return ended_in(element, number);
    }
  }
  return {};
}

template <class T>
Status Reader<T>::read_list(const PlyElement& element, const PlyProperty& list,
                            std::uint64_t number) {
  const char* const at = stream_.take(size_of(*list.length));
  if (at == nullptr) return ended_in(element, number);
  const std::int64_t stated = load_ply_integer(at, *list.length, layout_.swapped);
  const std::size_t size = size_of(list.type);
  if (stated < 0 || static_cast<std::uint64_t>(stated) > stream_.left() / size) {
    return Error{Errc::kImportFailed,
                 fmt::format("{}: {} {}: a list of {} cannot be in the {} bytes that are left",
                             file_, element.name, number, stated, stream_.left())};
  }
  auto count = static_cast<std::size_t>(stated);
  if (&list != layout_.corners) {
    return stream_.skip(std::uint64_t{count} * size) ? Status() : ended_in(element, number);
  }
  corners_.resize(count);
  std::uint32_t* to = corners_.data();
  while (count > 0) {
    const std::size_t step = std::min(count, kCornersAtOnce);
    const char* from = stream_.take(step * size);
    if (from == nullptr) return ended_in(element, number);
    // Negative numbers become large ones, as in other formats: out of range in any case.
    for (std::size_t i = 0; i < step; ++i, from += size) {
      *to++ = static_cast<std::uint32_t>(load_ply_integer(from, list.type, layout_.swapped));
    }
    count -= step;
  }
  return {};
}

template <class T>
Status Reader<T>::take_face() {
  if (corners_.size() < 3) {
    count_no_face(corners_.size(), out_.report);
    return {};
  }
  const std::uint32_t face_id = next_face_id_++;
  ++out_.report.source_faces;
  if (std::optional<FaceFault> fault = fault_of_face()) {
    return report_fault(std::move(*fault), face_id, file_, options_, out_.report);
  }
  for (const std::uint32_t corner : corners_) numbers_[corner] = kWeldUsed;
  if (corners_.size() == 3) {
    intake_.add_triangle(face_id, {corners_[0], corners_[1], corners_[2]});
  } else if (corners_.size() == 4) {
    intake_.add_quad(face_id, {corners_[0], corners_[1], corners_[2], corners_[3]},
                     {rounded_corner(0), rounded_corner(1), rounded_corner(2), rounded_corner(3)});
  } else {
    intake_.add_polygon(face_id, corners_);
  }
  return {};
}

template <class T>
std::optional<FaceFault> Reader<T>::fault_of_face() const {
  for (std::size_t i = 0; i < corners_.size(); ++i) {
    const std::uint32_t vertex = corners_[i];
    if (vertex >= numbers_.size()) {
      return vertex_out_of_range(i, vertex_text(vertex), numbers_.size());
    }
    if (all_finite_ || is_finite(vertex)) continue;
    const T* p = &positions_[std::size_t{3} * vertex];
    return vertex_not_finite(vertex_text(vertex), {p[0], p[1], p[2]});
  }
  return std::nullopt;
}

template <class T>
bool Reader<T>::is_finite(std::size_t vertex) const {
  const T* p = &positions_[3 * vertex];
  return std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2]);
}

// Rounded when the file was written, or now.
template <class T>
RoundedCorner Reader<T>::rounded_corner(std::size_t corner) const {
  const Eigen::Vector3d at = intake_.position(corners_[corner]);
  return {at, {rounding_of<T>(at[0]), rounding_of<T>(at[1]), rounding_of<T>(at[2])}};
}

template <class T>
void Reader<T>::weld() {
  ImportReport& report = out_.report;
  const auto used =
      static_cast<std::size_t>(std::count(numbers_.begin(), numbers_.end(), kWeldUsed));
  report.vertices_unused = numbers_.size() - used;
  // Files without shared vertices hold three a face; a closed surface needs half of one.
  weld_in_place(positions_, std::span(numbers_), std::min(used, out_.mesh.faces.size()));
  report.vertices_welded = used - positions_.size() / 3;
  for (Face& face : out_.mesh.faces) {
    for (std::uint32_t& corner : face.corner) {
      if (corner != kNoCorner) corner = numbers_[corner];
    }
  }
}

}  // namespace

Result<bool> import_binary_ply(const std::filesystem::path& path, const ImportOptions& options,
                               Imported& out) {
  Result<SourceStream> stream = SourceStream::open(path);
  if (!stream.ok()) return stream.error();
  if (!has_ply_header_end(stream->ahead())) {
    return Error{Errc::kImportFailed, path.string() + ": a PLY file without an end of its header"};
  }
  std::optional<PlyHeader> header = read_ply_header(stream->ahead());
  if (!header) return false;
  Layout layout;
  layout.header = std::move(*header);
  if (!find_parts(layout)) return false;
  static_cast<void>(stream->take(layout.header.bytes));

  return read_into(*stream, path, options, out, [&]<class T>(std::vector<T>& positions) {
    return Reader<T>(*stream, layout, path.string(), options, positions, out).read();
  });
}

}  // namespace boxtree::cooker
