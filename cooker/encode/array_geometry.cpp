// SPDX-License-Identifier: MIT
// Geometry stores "arrays" and "external" (reader: runtime/tree/geometry.h).
#include <algorithm>
#include <cstring>

#include "cooker/encode/append.h"
#include "cooker/encode/encoded.h"
#include "format/numbers.h"

namespace boxtree::cooker {
namespace {

// Writes numbers of 1, 2 or 4 bytes.
void append_number(std::vector<std::byte>& out, std::uint32_t value, std::uint8_t bytes) {
  if (bytes == 1) append(out, static_cast<std::uint8_t>(value));
  if (bytes == 2) append(out, static_cast<std::uint16_t>(value));
  if (bytes == 4) append(out, value);
}

// Appends pieces to bytes that have room for them.
class ByteWriter {
 public:
  explicit ByteWriter(std::byte* to) : to_(to) {}
  template <class T>
  void put(const T* values, std::size_t count) {
    std::memcpy(to_, values, count * sizeof(T));
    to_ += count * sizeof(T);
  }

 private:
  std::byte* to_;
};

// Corners are of the type Number, positions of Float.
template <class Number, class Float>
void encode_arrays(const SourceMesh& mesh, std::span<const Float> positions,
                   std::span<const std::uint32_t> order, EncodedGeometry& out) {
  out.corner_bytes = sizeof(Number);
  out.corners.resize(order.size() * out.corners_per_face * sizeof(Number));
  out.vertices.resize(positions.size() * sizeof(Float));
  ByteWriter corners(out.corners.data()), vertices(out.vertices.data());
  std::uint32_t count = 0;
  std::vector<std::uint32_t> renumbered(positions.size() / 3, kNoCorner);
  for (const std::uint32_t face : order) {
    for (std::size_t i = 0; i < out.corners_per_face; ++i) {
      const std::uint32_t corner = mesh.faces[face].corner[i];
      auto number = static_cast<Number>(kNoCorner);
      if (corner != kNoCorner) {
        if (renumbered[corner] == kNoCorner) {
          renumbered[corner] = count++;
          vertices.put(&positions[std::size_t{3} * corner], 3);
        }
        number = static_cast<Number>(renumbered[corner]);
      }
      corners.put(&number, 1);
    }
  }
  out.vertices.resize(std::size_t{3} * count * sizeof(Float));  // without those that no face has
}

}  // namespace

void encode_duplicates(std::span<const std::uint32_t> originals, EncodedGeometry& out) {
  if (originals.empty()) return;
  out.duplicate_count = static_cast<std::uint32_t>(originals.size());
  out.duplicate_bytes = number_bytes(originals.back());
  out.duplicates.reserve(originals.size() * out.duplicate_bytes);
  for (const std::uint32_t face : originals) {
    append_number(out.duplicates, face, out.duplicate_bytes);
  }
}

std::vector<std::uint32_t> faces_in_tree_order(const BuildTree& tree) {
  std::vector<std::uint32_t> order;
  order.reserve((tree.nodes.size() + 1) / 2);
  for (const BuildNode& node : tree.nodes) {
    if (node.is_leaf()) order.push_back(node.face());
  }
  return order;
}

EncodedGeometry encode_array_geometry(const SourceMesh& mesh,
                                      std::span<const std::uint32_t> order) {
  EncodedGeometry out;
  out.geometry = GeometryId::kArrays;
  out.max_vertex_error = mesh.moved_by_f32;
  const bool quads =
      std::any_of(mesh.faces.begin(), mesh.faces.end(), [](const Face& f) { return f.is_quad(); });
  out.corners_per_face = quads ? 4 : 3;
  const Positions& positions = mesh.positions;
  const auto encode = [&](auto number) {
    using Number = decltype(number);
    if (positions.precision == Precision::kF32) {
      encode_arrays<Number, float>(mesh, positions.f32, order, out);
    } else {
      encode_arrays<Number, double>(mesh, positions.f64, order, out);
    }
  };
  // 16 bits suffice for 65 535 vertices: the largest number marks a missing corner.
  if (positions.size() <= 0xffff) {
    encode(std::uint16_t{});
  } else {
    encode(std::uint32_t{});
  }
  return out;
}

EncodedGeometry encode_external_geometry() {
  EncodedGeometry out;
  out.geometry = GeometryId::kExternal;
  return out;
}

}  // namespace boxtree::cooker
