// SPDX-License-Identifier: MIT
// What every geometry store decodes: the triangles of a leaf.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include <boxtree/error.h>
#include <boxtree/tree.h>

#include "format/bytes.h"
#include "format/cluster.h"
#include "format/cluster_leaf.h"
#include "format/face_ids.h"
#include "format/limits.h"
#include "runtime/primitive/rounding.h"
#include "runtime/primitive/triangle.h"
#include "runtime/tree/frame.h"

namespace boxtree {

/// The vertex numbers of a face. Precondition: face < mesh.face_count.
[[nodiscard]] std::array<std::uint32_t, 4> face_of(const MeshArrays& mesh,
                                                   std::uint32_t face) noexcept;
/// A position in object space. Precondition: vertex < mesh.vertex_count.
[[nodiscard]] Eigen::Vector3d position_of(const MeshArrays& mesh, std::uint32_t vertex) noexcept;

/// XXH3-64 over the corner positions of all faces in order, each face preceded by its corner count:
/// the same for every way to index the same faces. kVertexOutOfRange for a bad corner number.
Result<std::uint64_t> geometry_hash(const MeshArrays& mesh);

/// The triangles of one leaf in tree space, as arrays over the triangles. Entries at and above
/// `count` are unspecified.
struct TriangleBatch {
  std::uint32_t count = 0;
  // coordinate[corner][axis][triangle]
  std::array<std::array<std::array<double, kMaxLeafTriangles>, 3>, 3> coordinate;
  std::array<std::uint32_t, kMaxLeafTriangles> face;  // position of the face in the tree's order
  FoundCluster found;                                 // by the last read, of any tree

  [[nodiscard]] Triangle triangle(std::uint32_t i) const noexcept {
    Triangle result;
    for (std::size_t corner = 0; corner < 3; ++corner) {
      result.corner[corner] = {coordinate[corner][0][i], coordinate[corner][1][i],
                               coordinate[corner][2][i]};
    }
    return result;
  }

  /// To the nearest; out[corner][axis][triangle].
  void round_to_floats(float (&out)[3][3][kMaxLeafTriangles]) const noexcept;
};

/// What walks by vectors read of a store once per query, computed when a tree is bound.
struct FloatLeaves {
  float scale = 1;            // of stored coordinates, to tree space
  float shift[3] = {};        // of arrays: subtracted after that
  float rounding = 0;         // how far a coordinate is off once rounded to float
  float direct_rounding = 0;  // the same for coordinates that are scaled as they are stored
  bool is_direct = false;     // full leaves are scaled as they are stored
  bool is_f64 = false;        // they are doubles, placed in tree space and then rounded
};

/// Reads leaves of one tree. A quad gives the triangles (0,1,2) and (0,2,3) of the same face.
class LeafReader {
 public:
  LeafReader() = default;
  LeafReader(const MeshArrays& mesh, const Frame& frame) noexcept : mesh_(mesh), frame_(frame) {}
  /// Faces in clusters. `grid_step`: of a grid, in tree space, a power of two.
  LeafReader(const ClusterView& clusters, const Frame& frame, double grid_step) noexcept
      : frame_(frame), clusters_(clusters), grid_step_(grid_step) {
    mesh_.face_count = clusters.face_count;
    mesh_.corners_per_face = clusters.corners_per_face;
  }

  /// From now on face n of the tree is face order[n] of the mesh: for arrays of an application,
  /// whose order is not the tree's.
  void set_order(FaceIdView order) noexcept { order_ = order; }

  /// Call it last. `max_abs`: the largest absolute coordinate in tree space.
  void prepare_floats(double max_abs) noexcept;
  [[nodiscard]] const FloatLeaves& floats() const noexcept { return floats_; }

  /// The arrays; for clusters only their counts.
  [[nodiscard]] const MeshArrays& mesh() const noexcept { return mesh_; }
  [[nodiscard]] bool has_clusters() const noexcept { return !clusters_.bytes.empty(); }
  [[nodiscard]] const ClusterView& clusters() const noexcept { return clusters_; }
  /// Whether positions are on a grid, and not those of the source.
  [[nodiscard]] bool is_grid() const noexcept {
    return has_clusters() && clusters_.numbers == ClusterNumbers::kGrid;
  }
  [[nodiscard]] double grid_step() const noexcept { return grid_step_; }
  /// Whether stored coordinates count from the tree's origin; otherwise they are in object space.
  [[nodiscard]] bool is_from_origin() const noexcept {
    return has_clusters() && clusters_.numbers != ClusterNumbers::kF64;
  }
  /// From stored coordinates, less the origin unless is_from_origin(), to tree space.
  [[nodiscard]] double stored_scale() const noexcept {
    return is_grid() ? grid_step_ : frame_.inverse_scale;
  }
  [[nodiscard]] const Frame& frame() const noexcept { return frame_; }
  /// Whether face n of the tree is face n of the mesh.
  [[nodiscard]] bool is_in_tree_order() const noexcept { return !order_; }

  /// Triangles of faces [first, first + count). On corrupt bytes kFaceOutOfRange (also when the
  /// leaf holds more than kMaxLeafTriangles), kVertexOutOfRange or kVertexNotFinite.
  [[nodiscard]] Errc read(std::uint32_t first, std::uint32_t count,
                          TriangleBatch& out) const noexcept;

 private:
  [[nodiscard]] Errc read_arrays(std::uint32_t first, std::uint32_t count,
                                 TriangleBatch& out) const noexcept;
  [[nodiscard]] std::uint32_t stored_face(std::uint32_t face, bool is_first,
                                          std::span<std::uint32_t, kLeafFaces> ids) const noexcept;
  [[nodiscard]] Errc read_clusters(std::uint32_t first, std::uint32_t count,
                                   TriangleBatch& out) const noexcept;

  MeshArrays mesh_;
  Frame frame_;
  ClusterView clusters_;
  double grid_step_ = 0;
  FaceIdView order_;  // none: the mesh is in the order of the tree
  FloatLeaves floats_;
};

}  // namespace boxtree
