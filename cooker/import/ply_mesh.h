// SPDX-License-Identifier: MIT
// Vertices and faces of a PLY file, of text or of numbers, on their way into a mesh: vertices as
// they come, faces with the numbers of the file; then vertices are welded and corners get their new
// numbers.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <boxtree/cooker/import/face_intake.h>
#include <boxtree/cooker/import/import.h>

namespace boxtree::cooker {

/// T is the type of the positions. Calls come in the order of the declarations.
template <class T>
class PlyMesh {
 public:
  PlyMesh(std::string file, const ImportOptions& options, std::vector<T>& positions, Imported& out)
      : file_(std::move(file)),
        options_(options),
        positions_(positions),
        out_(out),
        intake_(positions, out) {}
  PlyMesh(const PlyMesh&) = delete;
  PlyMesh& operator=(const PlyMesh&) = delete;

  /// Makes room; `count` must be backed by bytes of the file. Error: kMeshTooLarge.
  Status begin_vertices(std::uint64_t count);
  /// The next coordinate of the next vertex. Precondition: it is one of those announced.
  void add_coordinate(double value) {
    T& to = positions_[coordinates_++];
    to = static_cast<T>(value);
    all_finite_ = all_finite_ && std::isfinite(to);
  }
  /// Makes room likewise.
  Status begin_faces(std::uint64_t count);
  /// Takes a polygon by the numbers of its vertices; less than three are counted and passed over.
  Status add_face(std::span<const std::uint32_t> corners);
  /// Welds the vertices, drops the unused ones, and fails when nothing was taken.
  Status finish();

 private:
  [[nodiscard]] std::optional<FaceFault> fault_of(std::span<const std::uint32_t> corners) const;
  [[nodiscard]] bool is_finite(std::size_t vertex) const;
  [[nodiscard]] RoundedCorner rounded(std::uint32_t vertex) const;

  const std::string file_;
  const ImportOptions& options_;
  std::vector<T>& positions_;
  Imported& out_;
  FaceIntake<T> intake_;
  std::vector<std::uint32_t> numbers_;  // of vertices, for weld_in_place
  std::size_t coordinates_ = 0;
  bool all_finite_ = true;
  std::uint32_t next_face_id_ = 0;
};

extern template class PlyMesh<float>;
extern template class PlyMesh<double>;

}  // namespace boxtree::cooker
