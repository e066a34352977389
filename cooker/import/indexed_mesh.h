// SPDX-License-Identifier: MIT
// Adds the vertices and faces of a file that numbers its vertices (OBJ, OFF, PLY) to a mesh. Faces
// keep the numbers of the file until all are read; then vertices are welded and corners renumbered.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cooker/import/face_intake.h"
#include "cooker/import/import.h"

namespace boxtree::cooker {

/// T is the type of the positions. All vertices come first, then all faces.
template <class T>
class IndexedMesh {
 public:
  IndexedMesh(std::string file, const ImportOptions& options, std::vector<T>& positions,
              Imported& out)
      : file_(std::move(file)),
        options_(options),
        positions_(positions),
        out_(out),
        intake_(positions, options, out) {}
  IndexedMesh(const IndexedMesh&) = delete;
  IndexedMesh& operator=(const IndexedMesh&) = delete;

  /// Reserves memory; bytes of the file must back `count`. Error: kMeshTooLarge.
  Status begin_vertices(std::uint64_t count);
  /// The next coordinate of the next vertex.
  void add_coordinate(double value) {
    const T rounded = static_cast<T>(value);
    positions_.push_back(rounded);
    all_finite_ = all_finite_ && std::isfinite(rounded);
  }
  /// Adds the next vertex; `line` is its line in a text. Error: kMeshTooLarge.
  Status add_vertex(const Eigen::Vector3d& position, std::size_t line);
  [[nodiscard]] std::size_t vertices() const { return positions_.size() / 3; }

  /// Call after the last vertex.
  void end_vertices();
  /// Reserves memory in the same way.
  Status reserve_faces(std::uint64_t count);
  /// Gives the next face another id than the number of faces before it. Ids must not descend, so
  /// that ties, and runs of faces, go by the order of the file; parts of one face have the same,
  /// which user data would tell apart. Errors: kMeshUnsupported where they do; kMeshTooLarge for
  /// one that no file holds.
  Status number_next_face(std::int64_t id);
  /// Adds a polygon by the numbers of its vertices, from 0. Polygons with fewer than three are
  /// counted and skipped.
  Status add_face(std::span<const std::uint32_t> corners,
                  std::optional<std::uint32_t> user_data = {});
  /// Adds a polygon that the reader has found to be bad.
  Status add_bad_face(FaceFault fault);
  /// Adds the triangles of strips; a vertex number of -1 ends a strip. Every other triangle of a
  /// strip has the opposite winding. Strips of one or two vertices are not faces.
  Status add_strips(std::span<const std::uint32_t> vertices);
  /// The id of the next face: the number of faces of three corners or more before it, if ids were
  /// not given.
  [[nodiscard]] std::uint32_t next_face_id() const { return next_face_id_; }

  /// Reports `count` of `what` ("line") after the last element that the header counts; of a text,
  /// the first is in `line`.
  void add_left_over(std::string_view what, std::uint64_t count, std::size_t line = 0);

  /// Welds the vertices and drops unused ones; fails if no face was added.
  Status finish();

 private:
  Status add_strip(std::span<const std::uint32_t> vertices);
  [[nodiscard]] std::optional<FaceFault> fault_of(std::span<const std::uint32_t> corners) const;
  [[nodiscard]] bool is_finite(std::size_t vertex) const;
  [[nodiscard]] std::string name_of(std::uint32_t vertex) const;
  [[nodiscard]] RoundedCorner rounded(std::uint32_t vertex) const;

  const std::string file_;
  const ImportOptions& options_;
  std::vector<T>& positions_;
  Imported& out_;
  FaceIntake<T> intake_;
  std::vector<std::uint32_t> numbers_;  // of vertices, for weld_in_place
  bool all_finite_ = true;
  std::vector<std::pair<std::uint32_t, std::size_t>> bad_lines_;  // of vertices that are not finite
  std::uint32_t next_face_id_ = 0;
};

extern template class IndexedMesh<float>;
extern template class IndexedMesh<double>;

}  // namespace boxtree::cooker
