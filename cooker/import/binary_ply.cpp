// SPDX-License-Identifier: MIT
// Walks the elements of the file once: vertices and faces go into the mesh, everything else is
// skipped.
#include "cooker/import/binary_ply.h"

#include <array>
#include <bit>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/import/file_error.h"

namespace boxtree::cooker {
namespace {

// Corners read at once: a polygon may have any number of them.
constexpr std::size_t kCornersAtOnce = 4096;
static_assert(8 * kCornersAtOnce <= SourceStream::kBufferBytes);

// The least number of bytes of one `element`: lists may be empty.
std::size_t least_bytes(const PlyElement& element) {
  std::size_t bytes = 0;
  for (const PlyProperty& property : element.properties) {
    bytes += size_of(property.length.value_or(property.type));
  }
  return bytes;
}

// Offsets of x, y and z in the record of a vertex. Precondition: it has no lists.
std::array<std::size_t, 3> find_offsets(const PlyLayout& layout) {
  std::array<std::size_t, 3> offsets{};
  std::size_t offset = 0;
  for (const PlyProperty& property : layout.vertex->properties) {
    for (std::size_t k = 0; k < 3; ++k) {
      if (layout.xyz[k] == &property) offsets[k] = offset;
    }
    offset += size_of(property.type);
  }
  return offsets;
}

// T is the type of the positions.
template <class T>
class BinaryPlyReader {
 public:
  BinaryPlyReader(SourceStream& stream, const PlyLayout& layout, const std::string& file,
                  IndexedMesh<T>& mesh)
      : stream_(stream),
        layout_(layout),
        swapped_((layout.header.form == PlyHeader::Form::kBigEndian) ==
                 (std::endian::native == std::endian::little)),
        file_(file),
        mesh_(mesh) {}

  Status read();

 private:
  [[nodiscard]] bool is_padding();
  Status read_element(const PlyElement& element);
  Status read_vertices();
  Status read_faces();
  Status read_strips();
  Status read_record(const PlyElement& element, std::uint64_t number);
  Status read_list(const PlyElement& element, const PlyProperty& list, std::uint64_t number);
  [[nodiscard]] Error ended_in(const PlyElement& element, std::uint64_t number) const {
    return stream_.ended_in(fmt::format("{} {} of {}", element.name, number, element.count));
  }

  SourceStream& stream_;
  const PlyLayout& layout_;
  const bool swapped_;
  const std::string& file_;
  IndexedMesh<T>& mesh_;
  std::vector<std::uint32_t> corners_;      // of the current face or strip
  std::array<double, 3> position_{};        // of the current vertex
  std::optional<std::uint32_t> user_data_;  // of the current face, if it is wanted
  std::int64_t face_id_ = 0;                // likewise
};

template <class T>
Status BinaryPlyReader<T>::read() {
  for (const PlyElement& element : layout_.header.elements) {
    // Checked before memory is reserved: the header may state any count.
    const std::size_t least = least_bytes(element);
    if (least > 0 && element.count > stream_.left() / least) {
      return Error{
          Errc::kImportFailed,
          fmt::format("{}: {} elements '{}' cannot be in the {} bytes that are left, which "
                      "hold {} at most{}",
                      file_, element.count, element.name, stream_.left(), stream_.left() / least,
                      kAsIfCut)};
    }
    if (Status status = read_element(element); !status.ok()) return status;
    if (&element == layout_.vertex) mesh_.end_vertices();
  }
  const std::uint64_t left_over = stream_.left();
  if (!is_padding()) mesh_.add_left_over("byte", left_over);
  return mesh_.finish();
}

// Whether what is left is blanks and zero bytes, of which no face can be made: their lists have
// lengths.
template <class T>
bool BinaryPlyReader<T>::is_padding() {
  constexpr std::string_view kPadding("\0 \t\r\n\x1a", 6);
  const std::uint64_t left = stream_.left();
  if (left > SourceStream::kBufferBytes) return false;
  const char* const bytes = stream_.take(static_cast<std::size_t>(left));
  return bytes == nullptr ||
         std::string_view(bytes, static_cast<std::size_t>(left)).find_first_not_of(kPadding) ==
             std::string_view::npos;
}

template <class T>
Status BinaryPlyReader<T>::read_element(const PlyElement& element) {
  if (&element == layout_.vertex) return read_vertices();
  if (&element == layout_.face) return read_faces();
  if (&element == layout_.tristrips) return read_strips();
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
Status BinaryPlyReader<T>::read_vertices() {
  const std::uint64_t count = layout_.vertex->count;
  if (Status status = mesh_.begin_vertices(count); !status.ok()) return status;
  const std::size_t stride = least_bytes(*layout_.vertex);
  if (layout_.vertex->has_lists() || stride > SourceStream::kBufferBytes) {
    for (std::uint64_t i = 0; i < count; ++i) {
      if (Status status = read_record(*layout_.vertex, i); !status.ok()) return status;
      for (const double x : position_) mesh_.add_coordinate(x);
    }
    return {};
  }
  const std::array<std::size_t, 3> offsets = find_offsets(layout_);
  for (std::uint64_t i = 0; i < count; ++i) {
    const char* const vertex = stream_.take(stride);
    if (vertex == nullptr) return ended_in(*layout_.vertex, i);
    for (std::size_t k = 0; k < 3; ++k) {
      mesh_.add_coordinate(load_ply_value(vertex + offsets[k], layout_.xyz[k]->type, swapped_));
    }
  }
  return {};
}

template <class T>
Status BinaryPlyReader<T>::read_faces() {
  const std::uint64_t count = layout_.face->count;
  if (Status status = mesh_.reserve_faces(count); !status.ok()) return status;
  for (std::uint64_t i = 0; i < count; ++i) {
    if (Status status = read_record(*layout_.face, i); !status.ok()) return status;
    if (layout_.face_ids != nullptr) {
      if (Status status = mesh_.number_next_face(face_id_); !status.ok()) return status;
    }
    if (Status status = mesh_.add_face(corners_, user_data_); !status.ok()) return status;
  }
  return {};
}

template <class T>
Status BinaryPlyReader<T>::read_strips() {
  for (std::uint64_t i = 0; i < layout_.tristrips->count; ++i) {
    if (Status status = read_record(*layout_.tristrips, i); !status.ok()) return status;
    if (Status status = mesh_.add_strips(corners_); !status.ok()) return status;
  }
  return {};
}

// Reads one record of an element with lists; keeps the corners of a face or strip, user data of a
// face, and the position of a vertex.
template <class T>
Status BinaryPlyReader<T>::read_record(const PlyElement& element, std::uint64_t number) {
  for (const PlyProperty& property : element.properties) {
    if (property.length) {
      if (Status status = read_list(element, property, number); !status.ok()) return status;
      continue;
    }
    const char* const at = stream_.take(size_of(property.type));
    if (at == nullptr) return ended_in(element, number);
    for (std::size_t k = 0; k < 3; ++k) {
      if (layout_.xyz[k] == &property) position_[k] = load_ply_value(at, property.type, swapped_);
    }
    if (layout_.face_ids == &property) face_id_ = load_ply_integer(at, property.type, swapped_);
    if (layout_.user_data == &property) {
      user_data_ = static_cast<std::uint32_t>(load_ply_integer(at, property.type, swapped_));
    }
  }
  return {};
}

template <class T>
Status BinaryPlyReader<T>::read_list(const PlyElement& element, const PlyProperty& list,
                                     std::uint64_t number) {
  const char* const at = stream_.take(size_of(*list.length));
  if (at == nullptr) return ended_in(element, number);
  const std::int64_t stated = load_ply_integer(at, *list.length, swapped_);
  const std::size_t size = size_of(list.type);
  if (stated < 0 || static_cast<std::uint64_t>(stated) > stream_.left() / size) {
    return Error{
        Errc::kImportFailed,
        fmt::format("{}: {} {} of {}: a list of {} cannot be in the {} bytes that are left{}",
                    file_, element.name, number, element.count, stated, stream_.left(),
                    stated < 0 ? "" : kAsIfCut)};
  }
  auto count = static_cast<std::size_t>(stated);
  if (&list != layout_.corners && &list != layout_.strip) {
    return stream_.skip(std::uint64_t{count} * size) ? Status() : ended_in(element, number);
  }
  corners_.resize(count);
  std::uint32_t* to = corners_.data();
  while (count > 0) {
    const std::size_t step = std::min(count, kCornersAtOnce);
    const char* from = stream_.take(step * size);
    if (from == nullptr) return ended_in(element, number);
    // Negative numbers become large ones, as in other formats; both are out of range.
    for (std::size_t i = 0; i < step; ++i, from += size) {
      *to++ = static_cast<std::uint32_t>(load_ply_integer(from, list.type, swapped_));
    }
    count -= step;
  }
  return {};
}

}  // namespace

template <class T>
Status read_binary_ply(SourceStream& stream, const PlyLayout& layout, const std::string& file,
                       IndexedMesh<T>& mesh) {
  static_cast<void>(stream.take(layout.header.bytes));
  return BinaryPlyReader<T>(stream, layout, file, mesh).read();
}

template Status read_binary_ply(SourceStream&, const PlyLayout&, const std::string&,
                                IndexedMesh<float>&);
template Status read_binary_ply(SourceStream&, const PlyLayout&, const std::string&,
                                IndexedMesh<double>&);

}  // namespace boxtree::cooker
