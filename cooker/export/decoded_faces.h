// SPDX-License-Identifier: MIT
// The faces of a tree as vertices and corners in object space, whatever its geometry store.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "cooker/import/source_mesh.h"
#include "runtime/tree/bound_tree.h"

namespace boxtree::cooker {

/// In which order faces are told.
enum class ExportOrder : std::uint8_t {
  kSource,  // by face id; the pieces of one polygon share theirs and come as in the tree
  kTree,    // as the tree numbers them
};

/// Whether the stored positions of a tree are f32 of object space. Not so on a grid, whose points
/// are made in double.
[[nodiscard]] bool has_f32_positions(const Tree& tree);

/// Points into the bytes of its tree where those hold positions and corners; a grid is decoded into
/// memory, where vertices that are equal bit for bit become one.
class DecodedFaces {
 public:
  DecodedFaces(DecodedFaces&&) noexcept = default;
  DecodedFaces& operator=(DecodedFaces&&) noexcept = default;
  DecodedFaces(const DecodedFaces&) = delete;  // it points into itself
  DecodedFaces& operator=(const DecodedFaces&) = delete;
  ~DecodedFaces() = default;

  /// Everything is checked here, so that reading cannot fail. Errors: kPartLeftOut when the order
  /// of the source is requested and the tree has no face ids; kFaceOutOfRange, kVertexOutOfRange
  /// and kVertexNotFinite for corrupt bytes.
  static Result<DecodedFaces> decode(const Tree& tree, ExportOrder order);

  [[nodiscard]] std::uint32_t vertex_count() const { return arrays_.vertex_count; }
  [[nodiscard]] std::uint32_t face_count() const { return arrays_.face_count; }
  [[nodiscard]] std::uint64_t triangle_count() const { return triangle_count_; }

  /// Both of the above, and what they refer to: valid as long as this and the tree's file.
  [[nodiscard]] const MeshArrays& arrays() const { return arrays_; }
  /// Precondition: vertex < vertex_count().
  [[nodiscard]] Eigen::Vector3d position(std::uint32_t vertex) const {
    return position_of(arrays_, vertex);
  }
  /// Vertex numbers of face i in the order chosen, the last kMissingCorner for a triangle.
  /// Precondition: i < face_count().
  [[nodiscard]] std::array<std::uint32_t, 4> face(std::uint32_t i) const {
    return face_of(arrays_, order_.empty() ? i : order_[i]);
  }

 private:
  DecodedFaces() = default;
  Status decode_grid(const Tree& tree);
  Status check();

  MeshArrays arrays_;
  SourceMesh decoded_;                // what arrays_ points into, for a grid
  std::vector<std::uint32_t> order_;  // face i of the answer is face order_[i]; empty: is face i
  std::uint64_t triangle_count_ = 0;
};

}  // namespace boxtree::cooker
