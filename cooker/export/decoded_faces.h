// SPDX-License-Identifier: MIT
// The faces of a tree as vertices and corners in object space, for any geometry store.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "cooker/import/source_mesh.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {

/// The order of exported faces.
enum class ExportOrder : std::uint8_t {
  kSource,  // by face id; parts of one polygon share an id and keep the order of the tree
  kTree,    // as numbered in the tree
};

/// Whether the stored positions of a tree are f32 in object space. False for a grid, whose points
/// are computed in double.
[[nodiscard]] bool has_f32_positions(const Tree& tree);

/// Points into the bytes of its tree if they hold positions and corners. A grid is decoded into
/// memory, and vertices that are equal bit for bit become one.
class DecodedFaces {
 public:
  DecodedFaces(DecodedFaces&&) noexcept = default;
  DecodedFaces& operator=(DecodedFaces&&) noexcept = default;
  DecodedFaces(const DecodedFaces&) = delete;  // it points into itself
  DecodedFaces& operator=(const DecodedFaces&) = delete;
  ~DecodedFaces() = default;

  /// Checks everything, so that reading cannot fail. Errors: kPartLeftOut if the order of the
  /// source is requested and the tree has no face ids; kFaceOutOfRange, kVertexOutOfRange and
  /// kVertexNotFinite for corrupt bytes.
  static Result<DecodedFaces> decode(const Tree& tree, ExportOrder order);

  [[nodiscard]] std::uint32_t vertex_count() const { return arrays_.vertex_count; }
  [[nodiscard]] std::uint32_t face_count() const { return arrays_.face_count; }
  [[nodiscard]] std::uint64_t triangle_count() const { return triangle_count_; }

  /// Vertices and faces as arrays; valid as long as this object and the tree's file.
  [[nodiscard]] const MeshArrays& arrays() const { return arrays_; }
  /// Precondition: vertex < vertex_count().
  [[nodiscard]] Eigen::Vector3d position(std::uint32_t vertex) const {
    return position_of(arrays_, vertex);
  }
  /// Vertex numbers of face i in the selected order; the last is kMissingCorner for a triangle.
  /// Precondition: i < face_count().
  [[nodiscard]] std::array<std::uint32_t, 4> face(std::uint32_t i) const {
    return face_of(arrays_, order_.empty() ? i : order_[i]);
  }

 private:
  DecodedFaces() = default;
  Status decode_clusters(const Tree& tree);
  template <class Scalar>
  Status weld_clusters(const Tree& tree, std::vector<Scalar>& positions);
  Status check();

  MeshArrays arrays_;
  SourceMesh decoded_;                // arrays_ points into this for clusters
  std::vector<std::uint32_t> order_;  // face i is the stored face order_[i]; empty: face i
  std::uint64_t triangle_count_ = 0;
};

}  // namespace boxtree::cooker
