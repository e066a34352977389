// SPDX-License-Identifier: MIT
// Exporting one tree, importing it again, and faces as bits to compare.
#pragma once

#include <array>
#include <bit>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "cooker/cook.h"
#include "cooker/export/export.h"
#include "cooker/import/import.h"
#include "tests/support/require.h"
#include "tests/support/temp_folder.h"

namespace boxtree::cooker {

inline std::filesystem::path export_one(const test::TempFolder& folder, const std::string& name,
                                        const Tree& tree, const ExportOptions& options,
                                        ExportReport* report = nullptr) {
  const std::filesystem::path path = folder.path() / name;
  ExportReport written = test::require(export_trees(std::span(&tree, 1), path, options));
  EXPECT_EQ(written.bytes, std::filesystem::file_size(path));
  if (report != nullptr) *report = std::move(written);
  return path;
}

[[nodiscard]] inline ExportOptions triangles_only() {
  ExportOptions options;
  options.levels.clear();
  return options;
}

[[nodiscard]] inline ExportOptions everything() {
  ExportOptions options;
  options.levels = {{0, kMaxDepth}};
  options.leaves = true;
  return options;
}

[[nodiscard]] inline CookOptions on_grid(int bits) {
  CookOptions options;
  options.geometry = GeometryId::kGrid;
  options.grid.bits = bits;
  return options;
}

// The same mesh in f64, scaled and moved.
[[nodiscard]] inline SourceMesh far_away(const SourceMesh& mesh, double scale,
                                         const Eigen::Vector3d& offset) {
  SourceMesh far = mesh;
  far.positions = {Precision::kF64, {}, {}};
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    const Eigen::Vector3d p = scale * mesh.positions[v] + offset;
    far.positions.f64.insert(far.positions.f64.end(), {p[0], p[1], p[2]});
  }
  return far;
}

// Corners of a face as the bits of their positions.
using FaceBits = std::vector<std::array<std::uint64_t, 3>>;

[[nodiscard]] inline FaceBits bits_of(const SourceMesh& mesh, const Face& face) {
  FaceBits bits;
  for (std::size_t i = 0; i < (face.is_quad() ? 4 : 3); ++i) {
    const Eigen::Vector3d p = mesh.positions[face.corner[i]];
    bits.push_back({std::bit_cast<std::uint64_t>(p[0]), std::bit_cast<std::uint64_t>(p[1]),
                    std::bit_cast<std::uint64_t>(p[2])});
  }
  return bits;
}

[[nodiscard]] inline std::vector<FaceBits> faces_of(const SourceMesh& mesh) {
  std::vector<FaceBits> faces;
  for (const Face& face : mesh.faces) faces.push_back(bits_of(mesh, face));
  return faces;
}

[[nodiscard]] inline std::vector<FaceBits> triangles_of(const SourceMesh& mesh) {
  std::vector<FaceBits> triangles;
  for (const FaceBits& face : faces_of(mesh)) {
    for (std::size_t i = 1; i + 1 < face.size(); ++i) {
      triangles.push_back({face[0], face[i], face[i + 1]});
    }
  }
  return triangles;
}

[[nodiscard]] inline SourceMesh imported(const std::filesystem::path& path,
                                         Precision precision = Precision::kF32) {
  ImportOptions options;
  options.precision = precision;
  return test::require(import_mesh(path, options)).mesh;
}

// What a reader of f32 makes of positions with all the digits of a file.
[[nodiscard]] inline SourceMesh as_f32(const SourceMesh& mesh) {
  SourceMesh rounded = mesh;
  rounded.positions = {Precision::kF32, {}, {}};
  for (const double x : mesh.positions.f64) {
    rounded.positions.f32.push_back(static_cast<float>(x));
  }
  return rounded;
}

}  // namespace boxtree::cooker
