// SPDX-License-Identifier: MIT
// Leaf geometry: corner numbers to positions to tree space, every number checked before it is used.
#include "runtime/tree/geometry.h"

#include <cmath>
#include <limits>

namespace boxtree {

std::array<std::uint32_t, 4> face_of(const MeshArrays& mesh, std::uint32_t face) noexcept {
  std::array<std::uint32_t, 4> corner;
  corner[3] = kMissingCorner;
  const std::size_t first = std::size_t{face} * mesh.corners_per_face;
  for (std::size_t i = 0; i < mesh.corners_per_face; ++i) {
    corner[i] = mesh.corner_bytes == 2 ? load<std::uint16_t>(mesh.corners, first + i)
                                       : load<std::uint32_t>(mesh.corners, first + i);
  }
  if (mesh.corner_bytes == 2 && corner[3] == 0xffffu) corner[3] = kMissingCorner;
  return corner;
}

void TriangleBatch::round_to_floats(float (&out)[3][3][kMaxLeafTriangles]) const noexcept {
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::uint32_t i = 0; i < count; ++i) {
        out[c][k][i] = static_cast<float>(coordinate[c][k][i]);
      }
    }
  }
}

Eigen::Vector3d position_of(const MeshArrays& mesh, std::uint32_t vertex) noexcept {
  const std::byte* place = mesh.positions + std::size_t{vertex} * mesh.position_stride;
  if (mesh.positions_f64) {
    const auto p = load<std::array<double, 3>>(place);
    return {p[0], p[1], p[2]};
  }
  const auto p = load<std::array<float, 3>>(place);
  return {p[0], p[1], p[2]};
}

void LeafReader::prepare_floats(double max_abs) noexcept {
  floats_.rounding =
      float_above(max_abs * 2 * kRoundoffF32 + double{std::numeric_limits<float>::min()});
  // By underflow alone, where the numbers are floats or whole numbers that a float has.
  floats_.direct_rounding = std::numeric_limits<float>::min();
  if (is_grid()) {
    constexpr double kMostWhole = 1u << std::numeric_limits<float>::digits;
    if (max_abs > kMostWhole * grid_step_) floats_.direct_rounding = floats_.rounding;
    floats_.scale = static_cast<float>(grid_step_);
    floats_.is_direct = true;
    return;
  }
  // Three times the number of a vertex fits into 32 bits.
  constexpr std::uint32_t kMaxVertices32 = 1u << 30;
  floats_.scale = static_cast<float>(frame_.inverse_scale);
  bool is_scaled_exactly =
      double{floats_.scale} == frame_.inverse_scale && std::isnormal(floats_.scale);
  if (!is_from_origin() && !frame_.origin.isZero(0)) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double shift = frame_.origin[static_cast<Eigen::Index>(k)] * frame_.inverse_scale;
      floats_.shift[k] = static_cast<float>(shift);
      is_scaled_exactly &= double{floats_.shift[k]} == shift;
    }
    floats_.direct_rounding = floats_.rounding;
  }
  floats_.is_f64 = has_clusters() ? clusters_.numbers == ClusterNumbers::kF64 : mesh_.positions_f64;
  if (floats_.is_f64) floats_.direct_rounding = floats_.rounding;
  const std::size_t number_bytes = floats_.is_f64 ? sizeof(double) : sizeof(float);
  const bool are_readable =
      has_clusters() || (mesh_.position_stride == 3 * number_bytes && is_in_tree_order() &&
                         mesh_.vertex_count > 1 && mesh_.vertex_count <= kMaxVertices32);
  floats_.is_direct = are_readable && (is_scaled_exactly || floats_.is_f64);
}

Errc LeafReader::read(std::uint32_t first, std::uint32_t count, TriangleBatch& out) const noexcept {
  out.count = 0;
  if (!in_range(first, count, mesh_.face_count)) return Errc::kFaceOutOfRange;
  return has_clusters() ? read_clusters(first, count, out) : read_arrays(first, count, out);
}

Errc LeafReader::read_clusters(std::uint32_t first, std::uint32_t count,
                               TriangleBatch& out) const noexcept {
  constexpr std::uint32_t kNone = 0xffffffffu;
  std::uint32_t decoded = kNone;
  ClusterLeaf leaf;
  std::uint32_t triangles = 0;
  for (std::uint32_t f = first; f < first + count; ++f) {
    if (f / kLeafFaces != decoded) {
      decoded = f / kLeafFaces;
      if (!decode_cluster_leaf(clusters_, decoded, out.found, leaf)) {
        return Errc::kVertexOutOfRange;
      }
      for (std::uint32_t v = 0; v < leaf.vertex_count; ++v) {
        std::array<double, 3>& p = leaf.position[v];
        const Eigen::Vector3d stored(p[0], p[1], p[2]);
        const Eigen::Vector3d position =
            is_from_origin() ? stored * stored_scale() : frame_.to_tree(stored);
        if (!is_within_range(position)) return Errc::kVertexNotFinite;
        p = {position[0], position[1], position[2]};
      }
    }
    const std::array<std::uint8_t, 4>& corner = leaf.corner[f % kLeafFaces];
    const std::uint32_t corner_count = corner[3] == ClusterLeaf::kNoCorner ? 3 : 4;
    if (triangles + corner_count - 2 > kMaxLeafTriangles) return Errc::kFaceOutOfRange;
    for (std::uint32_t second = 1; second + 1 < corner_count; ++second) {
      const std::array<std::uint32_t, 3> named = {corner[0], corner[second], corner[second + 1]};
      for (std::size_t c = 0; c < 3; ++c) {
        for (std::size_t k = 0; k < 3; ++k) {
          out.coordinate[c][k][triangles] = leaf.position[named[c]][k];
        }
      }
      out.face[triangles++] = f;
    }
  }
  out.count = triangles;
  return Errc::kOk;
}

// The number of a face in the mesh. `ids`: of the faces of its leaf, read with the first.
std::uint32_t LeafReader::stored_face(std::uint32_t face, bool is_first,
                                      std::span<std::uint32_t, kLeafFaces> ids) const noexcept {
  if (!order_) return face;
  if (is_first || face % kLeafFaces == 0) order_.read_leaf(face / kLeafFaces, ids);
  return ids[face % kLeafFaces];
}

Errc LeafReader::read_arrays(std::uint32_t first, std::uint32_t count,
                             TriangleBatch& out) const noexcept {
  std::uint32_t triangles = 0;
  std::array<std::uint32_t, kLeafFaces> ids;
  for (std::uint32_t f = first; f < first + count; ++f) {
    const std::uint32_t stored = stored_face(f, f == first, ids);
    if (stored >= mesh_.face_count) return Errc::kFaceOutOfRange;
    const std::array<std::uint32_t, 4> corner = face_of(mesh_, stored);
    const std::uint32_t corner_count = corner[3] == kMissingCorner ? 3 : 4;
    if (triangles + corner_count - 2 > kMaxLeafTriangles) return Errc::kFaceOutOfRange;
    std::array<Eigen::Vector3d, 4> position;
    for (std::uint32_t i = 0; i < corner_count; ++i) {
      if (corner[i] >= mesh_.vertex_count) return Errc::kVertexOutOfRange;
      position[i] = frame_.to_tree(position_of(mesh_, corner[i]));
      if (!is_within_range(position[i])) return Errc::kVertexNotFinite;
    }
    for (std::uint32_t second = 1; second + 1 < corner_count; ++second) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<Eigen::Index>(axis);
        out.coordinate[0][axis][triangles] = position[0][k];
        out.coordinate[1][axis][triangles] = position[second][k];
        out.coordinate[2][axis][triangles] = position[second + 1][k];
      }
      out.face[triangles++] = f;
    }
  }
  out.count = triangles;
  return Errc::kOk;
}

}  // namespace boxtree
