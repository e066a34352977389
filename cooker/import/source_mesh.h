// SPDX-License-Identifier: MIT
// A mesh before it is cooked: all data that later stages use of the input file.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Geometry>

namespace boxtree::cooker {

/// The type of vertex positions. f32 unless the caller needs f64: most sources are f32.
enum class Precision : std::uint8_t { kF32, kF64 };

[[nodiscard]] constexpr std::string_view precision_name(Precision precision) noexcept {
  return precision == Precision::kF32 ? "f32" : "f64";
}

/// Why f32 moved vertices, which decides what moves none.
enum class F32Loss : std::uint8_t {
  kDigits,  // f32 does not hold those of the file; kF64 does
  kNodes,   // nor the places of nodes; kF64 and a scene do
  kReader,  // assimp's reader of a text has f32 alone, whatever the precision
};

/// Positions of all vertices, three numbers each, in object space (the units of the source). Only
/// the array of `precision` is filled.
struct Positions {
  Precision precision = Precision::kF32;
  std::vector<float> f32;   // x0 y0 z0 x1 ...
  std::vector<double> f64;  // x0 y0 z0 x1 ...

  [[nodiscard]] std::size_t size() const {
    return (precision == Precision::kF32 ? f32.size() : f64.size()) / 3;
  }
  /// Position of vertex `i`; f32 values convert without change. Precondition: i < size().
  [[nodiscard]] Eigen::Vector3d operator[](std::size_t i) const {
    return precision == Precision::kF32
               ? Eigen::Vector3d(f32[3 * i], f32[3 * i + 1], f32[3 * i + 2])
               : Eigen::Vector3d(f64[3 * i], f64[3 * i + 1], f64[3 * i + 2]);
  }
};

/// Bounds of all; empty if there are none.
[[nodiscard]] inline Eigen::AlignedBox3d bounds_of(const Positions& positions) {
  Eigen::AlignedBox3d bounds;
  for (std::size_t i = 0; i < positions.size(); ++i) bounds.extend(positions[i]);
  return bounds;
}

/// Marks the missing fourth corner of a triangle.
inline constexpr std::uint32_t kNoCorner = 0xffffffffu;

/// A triangle (corner[3] == kNoCorner) or a planar convex quad: vertex numbers in source winding. A
/// quad represents the triangles (0,1,2) and (0,2,3).
struct Face {
  std::array<std::uint32_t, 4> corner;

  [[nodiscard]] bool is_quad() const { return corner[3] != kNoCorner; }
};

/// A mesh to cook. Invariant after import: every corner < positions.size(), every position finite,
/// face_ids either empty (face i has id i) or as long as faces.
struct SourceMesh {
  std::string name;
  Positions positions;
  std::vector<Face> faces;
  std::vector<std::uint32_t> face_ids;  // source number of each face; parts of an n-gon share one
  /// Of each face, which corners of its source polygon it has, from 0; the last is kNoCorner for a
  /// triangle. Empty unless import was told to keep it (ImportOptions::keep_polygon_corners).
  std::vector<std::array<std::uint32_t, 4>> polygon_corners;
  /// How far f32 moved a vertex at most from what the source says (ImportReport::moved_by_f32 and
  /// ImportOptions::count_moves).
  double moved_by_f32 = 0;
  F32Loss f32_loss = F32Loss::kDigits;

  [[nodiscard]] std::uint32_t face_id(std::size_t face) const;
  [[nodiscard]] std::size_t triangle_count() const {
    std::size_t count = faces.size();
    for (const Face& face : faces) count += face.is_quad() ? 1u : 0u;
    return count;
  }
};

/// What a tree is built over: the faces of a mesh, with its positions or others for its vertices.
/// It points into both.
struct MeshView {
  const Positions& positions;
  std::span<const Face> faces;
  std::span<const std::uint32_t> face_ids;  // as in SourceMesh

  MeshView(const SourceMesh& mesh)  // NOLINT(google-explicit-constructor): it is one
      : MeshView(mesh, mesh.positions) {}
  MeshView(const SourceMesh& mesh, const Positions& moved)
      : positions(moved), faces(mesh.faces), face_ids(mesh.face_ids) {}

  [[nodiscard]] std::uint32_t face_id(std::size_t face) const {
    return face_ids.empty() ? static_cast<std::uint32_t>(face) : face_ids[face];
  }
};

inline std::uint32_t SourceMesh::face_id(std::size_t face) const {
  return MeshView(*this).face_id(face);
}

}  // namespace boxtree::cooker
