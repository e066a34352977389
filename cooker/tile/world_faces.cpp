// SPDX-License-Identifier: MIT
#include "cooker/tile/world_faces.h"

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/farm/job_memory.h"
#include "cooker/import/binary_stl.h"
#include "cooker/import/face_intake.h"
#include "cooker/import/file_error.h"
#include "cooker/import/import.h"
#include "cooker/import/ply_layout.h"
#include "cooker/import/source_stream.h"
#include "cooker/import/text_tokens.h"
#include "cooker/system/input_failure.h"
#include "cooker/system/positioned.h"
#include "format/limits.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// Bad faces: errors, or counted and left out.
class BadFaces {
 public:
  BadFaces(const std::string& file, bool skips) : file_(file), skips_(skips) {}

  Status take(std::uint64_t face, const FaceFault& fault) {
    if (!skips_) return error_of_face(file_, face, fault, "tile");
    ++count_;
    return {};
  }
  [[nodiscard]] std::uint32_t count() const { return count_; }

 private:
  const std::string& file_;
  bool skips_;
  std::uint32_t count_ = 0;
};

bool is_finite(const WorldCorner& corner) {
  return std::isfinite(corner[0]) && std::isfinite(corner[1]) && std::isfinite(corner[2]);
}

std::array<double, 3> in_double(const WorldCorner& corner) {
  return {double{corner[0]}, double{corner[1]}, double{corner[2]}};
}

Result<WorldFaces> read_stl(SourceStream& stream, const std::string& file, BadFaces& bad,
                            const WorldFaceSink& sink) {
  static_cast<void>(stream.take(kStlHeaderBytes));
  const std::uint64_t count = stream.left() / kStlTriangleBytes;  // is_binary_stl has compared it
  if (Status status = check_face_count(count, file); !status) return status.error();
  std::array<WorldCorner, 3> corners;
  for (std::uint32_t id = 0; id < count; ++id) {
    const char* const triangle = stream.take(kStlTriangleBytes);
    if (triangle == nullptr) return stream.ended_in(fmt::format("face {}", id));
    for (std::size_t i = 0; i < 9; ++i) {
      corners[i / 3][i % 3] =
          static_cast<float>(load_ply_value(triangle + kStlCornersOffset + 4 * i, PlyType::kFloat32,
                                            std::endian::native != std::endian::little));
    }
    const auto found = std::find_if_not(corners.begin(), corners.end(), is_finite);
    Status status;
    if (found == corners.end()) {
      status = sink({id, corners, corners});
    } else {
      const auto vertex =
          std::uint64_t{3} * id + static_cast<std::uint64_t>(found - corners.begin());
      status = bad.take(id, vertex_not_finite(fmt::format("vertex {}", vertex), in_double(*found)));
    }
    if (!status) return status.error();
  }
  return WorldFaces{static_cast<std::uint32_t>(count), bad.count()};
}

// Bytes of an element without lists.
std::uint64_t fixed_bytes(const PlyElement& element) {
  std::uint64_t bytes = 0;
  for (const PlyProperty& property : element.properties) bytes += size_of(property.type);
  return bytes;
}

// Whether faces can be reached, and vertices found, without reading what is before them.
bool is_streamable(const PlyLayout& layout) {
  if (layout.header.form == PlyHeader::Form::kText || layout.face == nullptr) return false;
  if (layout.tristrips != nullptr && layout.tristrips->count > 0) return false;
  for (const PlyElement& element : layout.header.elements) {
    if (&element == layout.face) return true;
    if (element.has_lists()) return false;
  }
  return false;
}

// Vertices by their numbers, a block of them at a time. As many blocks as memory allows; which was
// not used for longest makes room, but for a second chance.
class VertexBlocks {
 public:
  VertexBlocks(const PlyLayout& layout, std::uint64_t offset, FileHandle handle, std::string file,
               std::uint64_t memory)
      : layout_(layout),
        offset_(offset),
        stride_(static_cast<std::size_t>(fixed_bytes(*layout.vertex))),
        swapped_((layout.header.form == PlyHeader::Form::kBigEndian) ==
                 (std::endian::native == std::endian::little)),
        handle_(std::move(handle)),
        file_(std::move(file)) {
    const std::uint64_t blocks = (layout.vertex->count + kVertices - 1) / kVertices;
    const std::uint64_t room = std::max<std::uint64_t>(memory / sizeof(Block), 2);
    slot_of_.assign(static_cast<std::size_t>(blocks), kNoSlot);
    most_ = static_cast<std::size_t>(std::min(blocks, room));
    blocks_.reserve(most_);  // so that none moves, and no room is kept for more
    std::size_t at = 0;
    for (const PlyProperty& property : layout.vertex->properties) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (layout.xyz[k] == &property) offsets_[k] = at;
      }
      at += size_of(property.type);
    }
  }

  /// Precondition: the vertex exists.
  Result<WorldCorner> operator[](std::uint32_t vertex) {
    const std::uint32_t block = vertex / kVertices;
    std::uint32_t slot = slot_of_[block];
    if (slot == kNoSlot) {
      const Result<std::uint32_t> loaded = load(block);
      if (!loaded) return loaded.error();
      slot = *loaded;
    }
    used_[slot] = true;
    return blocks_[slot][vertex % kVertices];
  }

 private:
  static constexpr std::uint32_t kVertices = 4096;
  static constexpr std::uint32_t kNoSlot = 0xffffffffu;
  using Block = std::array<WorldCorner, kVertices>;

  std::uint32_t free_slot() {
    if (blocks_.size() < most_) {
      blocks_.emplace_back();
      block_in_.push_back(0);
      used_.push_back(false);
      return static_cast<std::uint32_t>(blocks_.size() - 1);
    }
    while (used_[next_]) {
      used_[next_] = false;
      next_ = (next_ + 1) % blocks_.size();
    }
    const std::size_t slot = next_;
    next_ = (next_ + 1) % blocks_.size();
    slot_of_[block_in_[slot]] = kNoSlot;
    return static_cast<std::uint32_t>(slot);
  }

  Result<std::uint32_t> load(std::uint32_t block) {
    const std::uint64_t first = std::uint64_t{block} * kVertices;
    const auto count =
        static_cast<std::size_t>(std::min<std::uint64_t>(kVertices, layout_.vertex->count - first));
    bytes_.resize(count * stride_);
    if (!read_at(descriptor_of(handle_.get()), offset_ + first * stride_, bytes_)) {
      return input_failure(file_, errno);
    }
    const std::uint32_t slot = free_slot();
    for (std::size_t i = 0; i < count; ++i) {
      const char* const record = reinterpret_cast<const char*>(bytes_.data()) + i * stride_;
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = load_ply_value(record + offsets_[k], layout_.xyz[k]->type, swapped_);
        const auto rounded = static_cast<float>(x);
        if (layout_.xyz[k]->type == PlyType::kFloat64 && double{rounded} != x && !std::isnan(x)) {
          return Error{Errc::kMeshUnsupported,
                       fmt::format("{}: vertex {}: expected coordinates that f32 holds, found {}; "
                                   "tiles have f32: write the file with floats",
                                   file_, first + i, x)};
        }
        blocks_[slot][i][k] = rounded;
      }
    }
    block_in_[slot] = block;
    slot_of_[block] = slot;
    return slot;
  }

  const PlyLayout& layout_;
  const std::uint64_t offset_;  // of the first vertex in the file
  const std::size_t stride_;
  const bool swapped_;
  const FileHandle handle_;
  const std::string file_;
  std::array<std::size_t, 3> offsets_{};  // of coordinates in a vertex
  std::size_t most_ = 0;
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> block_in_;  // of each slot
  std::vector<bool> used_;               // since it was last passed over
  std::vector<std::uint32_t> slot_of_;   // of each block of the file
  std::size_t next_ = 0;                 // the slot that is looked at next
  std::vector<std::byte> bytes_;
};

class PlyFaces {
 public:
  PlyFaces(SourceStream& stream, const PlyLayout& layout, const std::string& file,
           VertexBlocks& vertices, BadFaces& bad, const WorldFaceSink& sink)
      : stream_(stream),
        layout_(layout),
        swapped_((layout.header.form == PlyHeader::Form::kBigEndian) ==
                 (std::endian::native == std::endian::little)),
        file_(file),
        vertices_(vertices),
        bad_(bad),
        sink_(sink) {}

  Result<WorldFaces> read() {
    if (Status status = check_face_count(layout_.face->count, file_); !status) {
      return status.error();
    }
    for (std::uint64_t i = 0; i < layout_.face->count; ++i) {
      if (Status status = read_record(i); !status) return status.error();
      if (numbers_.size() < 3) continue;
      const Result<std::optional<FaceFault>> fault = find_corners();
      if (!fault) return fault.error();
      const Status status =
          *fault ? bad_.take(next_id_, **fault) : sink_({next_id_, corners_, corners_});
      if (!status) return status.error();
      ++next_id_;
    }
    return WorldFaces{next_id_, bad_.count()};
  }

 private:
  [[nodiscard]] Error ended_in(std::uint64_t face) const {
    return stream_.ended_in(fmt::format("face {} of {}", face, layout_.face->count));
  }

  // The positions of a record's vertices, or what is wrong with one of them.
  Result<std::optional<FaceFault>> find_corners() {
    corners_.clear();
    for (const std::uint32_t vertex : numbers_) {
      if (vertex >= layout_.vertex->count) {
        return std::optional(
            vertex_out_of_range(corners_.size(), vertex_text(vertex), layout_.vertex->count));
      }
      const Result<WorldCorner> corner = vertices_[vertex];
      if (!corner) return corner.error();
      if (!is_finite(*corner)) {
        return std::optional(vertex_not_finite(vertex_text(vertex), in_double(*corner)));
      }
      corners_.push_back(*corner);
    }
    return std::optional<FaceFault>();
  }

  Status read_record(std::uint64_t face) {
    for (const PlyProperty& property : layout_.face->properties) {
      const char* const at = stream_.take(size_of(property.length.value_or(property.type)));
      if (at == nullptr) return ended_in(face);
      if (!property.length) continue;
      const std::int64_t count = load_ply_integer(at, *property.length, swapped_);
      const std::size_t size = size_of(property.type);
      if (count < 0 || static_cast<std::uint64_t>(count) > stream_.left() / size) {
        return ended_in(face);
      }
      if (&property != layout_.corners) {
        if (!stream_.skip(static_cast<std::uint64_t>(count) * size)) return ended_in(face);
        continue;
      }
      numbers_.clear();
      for (std::int64_t i = 0; i < count; ++i) {
        const char* const number = stream_.take(size);
        if (number == nullptr) return ended_in(face);
        numbers_.push_back(
            static_cast<std::uint32_t>(load_ply_integer(number, property.type, swapped_)));
      }
    }
    return {};
  }

  SourceStream& stream_;
  const PlyLayout& layout_;
  const bool swapped_;
  const std::string& file_;
  VertexBlocks& vertices_;
  BadFaces& bad_;
  const WorldFaceSink& sink_;
  std::vector<std::uint32_t> numbers_;  // of the vertices of a face
  std::vector<WorldCorner> corners_;
  std::uint32_t next_id_ = 0;
};

// Precondition: is_streamable(layout).
Result<WorldFaces> read_ply(SourceStream& stream, const PlyLayout& layout, const fs::path& path,
                            std::uint64_t memory, BadFaces& bad, const WorldFaceSink& sink) {
  const std::string file = path.string();
  const std::uint64_t all = stream.left();
  std::uint64_t at = layout.header.bytes, vertices_at = 0;
  for (const PlyElement& element : layout.header.elements) {
    if (&element == layout.face) break;
    if (&element == layout.vertex) vertices_at = at;
    const std::uint64_t size = std::max<std::uint64_t>(fixed_bytes(element), 1);
    if (element.count > (all - at) / size) {
      return Error{Errc::kImportFailed,
                   fmt::format("{}: {} elements '{}' cannot be in the {} bytes that are left{}",
                               file, element.count, element.name, all - at, kAsIfCut)};
    }
    at += element.count * fixed_bytes(element);
  }
  if (layout.vertex->count > kMaxVertices) {
    return Error{Errc::kMeshTooLarge, fmt::format("{}: {} vertices, more than {}", file,
                                                  layout.vertex->count, kMaxVertices)};
  }
  FileHandle handle = open_to_read(path);
  if (!handle) return input_failure(file, errno);
  VertexBlocks vertices(layout, vertices_at, std::move(handle), file, memory);
  if (!stream.skip(at)) return stream.ended_in("its vertices");
  return PlyFaces(stream, layout, file, vertices, bad, sink).read();
}

Result<WorldFaces> read_imported(const fs::path& path, const WorldReading& reading,
                                 const WorldFaceSink& sink) {
  CookJob job;
  job.inputs = {path};
  if (const std::uint64_t expected = estimated_memory(job); expected > reading.memory / 2) {
    return Error{Errc::kMeshUnsupported,
                 fmt::format("{}: it is read into memory and takes about {} bytes, for which half "
                             "of the {} of --memory is there; binary PLY and STL files are read as "
                             "streams: convert it, or give --memory {}",
                             path.string(), expected, reading.memory, 2 * expected)};
  }
  const Result<Imported> imported =
      import_mesh(path, {.skip_bad = reading.skip_bad, .command = "tile", .try_first = true});
  if (!imported) return imported.error();
  const SourceMesh& mesh = imported->mesh;
  std::vector<WorldCorner> corners;  // of all parts of a polygon
  std::vector<std::size_t> ends;     // of each part
  for (std::size_t face = 0; face < mesh.faces.size();) {
    const std::uint32_t id = mesh.face_id(face);
    corners.clear();
    ends.clear();
    for (; face < mesh.faces.size() && mesh.face_id(face) == id; ++face) {
      for (const std::uint32_t corner : mesh.faces[face].corner) {
        if (corner == kNoCorner) continue;
        const float* const p = &mesh.positions.f32[std::size_t{3} * corner];
        corners.push_back({p[0], p[1], p[2]});
      }
      ends.push_back(corners.size());
    }
    std::size_t begin = 0;
    for (const std::size_t end : ends) {
      const std::span<const WorldCorner> part = std::span(corners).subspan(begin, end - begin);
      if (Status status = sink({id, part, corners}); !status) return status.error();
      begin = end;
    }
  }
  return WorldFaces{static_cast<std::uint32_t>(imported->report.source_faces),
                    static_cast<std::uint32_t>(imported->report.skipped.size())};
}

}  // namespace

Result<WorldFaces> read_world_faces(const fs::path& path, const WorldReading& reading,
                                    const WorldFaceSink& sink) {
  const bool is_stl = has_extension(path, "stl"), is_ply = has_extension(path, "ply");
  if (!is_stl && !is_ply) return read_imported(path, reading, sink);
  Result<SourceStream> stream = SourceStream::open(SourceFile(path));
  if (!stream) return stream.error();
  const std::string file = path.string();
  BadFaces bad(file, reading.skip_bad);
  if (is_stl) {
    return is_binary_stl(*stream) ? read_stl(*stream, file, bad, sink)
                                  : read_imported(path, reading, sink);
  }
  Result<PlyHeader> header = read_ply_header(stream->ahead());
  if (!header) return in_file(path, header.error());
  PlyLayout layout;
  layout.header = std::move(*header);
  if (Status status = find_ply_parts(layout); !status) return in_file(path, status.error());
  if (!is_streamable(layout)) return read_imported(path, reading, sink);
  return read_ply(*stream, layout, path, reading.memory / 2, bad, sink);
}

}  // namespace boxtree::cooker
