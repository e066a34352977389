// SPDX-License-Identifier: MIT
// Geometry stores "arrays" and "external" (reader: runtime/tree/geometry.h).
#include <algorithm>
#include <cstring>

#include "cooker/encode/encoded.h"
#include "format/numbers.h"

namespace boxtree::cooker {
namespace {

template <class T>
void append(std::vector<std::byte>& out, T value) {
  const std::size_t end = out.size();
  out.resize(end + sizeof(T));
  std::memcpy(out.data() + end, &value, sizeof(T));
}

// Writes numbers of 1, 2 or 4 bytes.
void append_number(std::vector<std::byte>& out, std::uint32_t value, std::uint8_t bytes) {
  if (bytes == 1) append(out, static_cast<std::uint8_t>(value));
  if (bytes == 2) append(out, static_cast<std::uint16_t>(value));
  if (bytes == 4) append(out, value);
}

void append_position(const Positions& positions, std::size_t vertex, std::vector<std::byte>& out) {
  const auto copy = [&](const auto* first) {
    const std::size_t end = out.size();
    out.resize(end + 3 * sizeof(*first));
    std::memcpy(out.data() + end, first, 3 * sizeof(*first));
  };
  if (positions.precision == Precision::kF32) {
    copy(positions.f32.data() + 3 * vertex);
  } else {
    copy(positions.f64.data() + 3 * vertex);
  }
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
  const bool quads =
      std::any_of(mesh.faces.begin(), mesh.faces.end(), [](const Face& f) { return f.is_quad(); });
  out.corners_per_face = quads ? 4 : 3;
  // 16 bits suffice for 65 535 vertices: the largest number marks a missing corner.
  out.corner_bytes = mesh.positions.size() <= 0xffff ? 2 : 4;
  out.corners.reserve(order.size() * out.corners_per_face * out.corner_bytes);

  std::uint32_t vertices = 0;
  std::vector<std::uint32_t> renumbered(mesh.positions.size(), kNoCorner);
  for (const std::uint32_t face : order) {
    for (std::size_t i = 0; i < out.corners_per_face; ++i) {
      const std::uint32_t corner = mesh.faces[face].corner[i];
      if (corner == kNoCorner) {
        append_number(out.corners, kNoCorner, out.corner_bytes);
        continue;
      }
      if (renumbered[corner] == kNoCorner) {
        renumbered[corner] = vertices++;
        append_position(mesh.positions, corner, out.vertices);
      }
      append_number(out.corners, renumbered[corner], out.corner_bytes);
    }
  }
  return out;
}

EncodedGeometry encode_external_geometry() {
  EncodedGeometry out;
  out.geometry = GeometryId::kExternal;
  return out;
}

}  // namespace boxtree::cooker
