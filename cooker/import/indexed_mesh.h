// SPDX-License-Identifier: MIT
// Vertices and faces of a file that numbers its vertices (OBJ, OFF, PLY), on their way into a mesh:
// vertices as they come, faces with the numbers of the file; then vertices are welded and corners
// get their new numbers.
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
  /// `first_number`: what the file calls its first vertex, in messages alone.
  IndexedMesh(std::string file, const ImportOptions& options, std::vector<T>& positions,
              Imported& out, std::uint32_t first_number = 0)
      : file_(std::move(file)),
        options_(options),
        positions_(positions),
        out_(out),
        intake_(positions, out),
        first_number_(first_number) {}
  IndexedMesh(const IndexedMesh&) = delete;
  IndexedMesh& operator=(const IndexedMesh&) = delete;

  /// Makes room; `count` must be backed by bytes of the file. Error: kMeshTooLarge.
  Status begin_vertices(std::uint64_t count);
  /// The next coordinate of the next vertex.
  void add_coordinate(double value) {
    const T rounded = static_cast<T>(value);
    positions_.push_back(rounded);
    all_finite_ = all_finite_ && std::isfinite(rounded);
  }
  /// The next vertex, which stands in that line of a text. Error: kMeshTooLarge.
  Status add_vertex(const Eigen::Vector3d& position, std::size_t line);
  [[nodiscard]] std::size_t vertices() const { return positions_.size() / 3; }

  /// There are no more vertices.
  void end_vertices();
  /// Makes room likewise.
  Status reserve_faces(std::uint64_t count);
  /// Takes a polygon by the numbers of its vertices, from 0; less than three are counted and passed
  /// over.
  Status add_face(std::span<const std::uint32_t> corners);
  /// A polygon of which the reader knows that it is bad.
  Status add_bad_face(FaceFault fault);
  /// Takes the triangles of strips, which a vertex number of -1 ends; every other triangle of a
  /// strip is wound the other way round. One or two vertices by themselves are no face.
  Status add_strips(std::span<const std::uint32_t> vertices);
  /// What the next face is called: faces of three corners and more that came before it.
  [[nodiscard]] std::uint32_t next_face_id() const { return next_face_id_; }

  /// Welds the vertices, drops the unused ones, and fails when nothing was taken.
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
  const std::uint32_t first_number_;
  std::vector<std::uint32_t> numbers_;  // of vertices, for weld_in_place
  bool all_finite_ = true;
  std::vector<std::pair<std::uint32_t, std::size_t>> bad_lines_;  // of vertices that are not finite
  std::uint32_t next_face_id_ = 0;
};

extern template class IndexedMesh<float>;
extern template class IndexedMesh<double>;

}  // namespace boxtree::cooker
