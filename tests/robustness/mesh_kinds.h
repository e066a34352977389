// SPDX-License-Identifier: MIT
// Meshes of the robustness suite, and changes to meshes. Positions are f32 unless stated otherwise.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "cooker/quantise/grid.h"
#include "tests/robustness/subjects.h"
#include "tests/support/meshes.h"

namespace boxtree::robustness {

using Corners = std::array<Eigen::Vector3d, 3>;

/// Every triangle with its own three vertices. The corners must be exact in f32.
[[nodiscard]] SourceMesh from_triangles(std::string name, const std::vector<Corners>& triangles,
                                        cooker::Precision precision = cooker::Precision::kF32);

/// Corner i of triangle `half` of a face.
[[nodiscard]] Triangle source_triangle(const SourceMesh& mesh, std::size_t face, std::size_t half);

/// Coordinates times a factor, rounded once to the precision of the mesh; exact for a power of two.
[[nodiscard]] SourceMesh times(SourceMesh mesh, double factor);
/// The same for each axis.
[[nodiscard]] SourceMesh times(SourceMesh mesh, const Eigen::Vector3d& factor);
/// Coordinates plus a vector, rounded once.
[[nodiscard]] SourceMesh plus(SourceMesh mesh, const Eigen::Vector3d& offset);
/// The same coordinates in f64.
[[nodiscard]] SourceMesh in_double(SourceMesh mesh);
/// Coordinates rounded to multiples of 2^exponent.
[[nodiscard]] SourceMesh snapped(SourceMesh mesh, int exponent);

/// The box from -half to half as 12 triangles.
[[nodiscard]] SourceMesh box_mesh(const Eigen::Vector3d& half);
/// cells x cells squares of two triangles in the plane axis = 0, corners on whole numbers.
[[nodiscard]] SourceMesh flat_square(unsigned cells, Eigen::Index axis);
/// Closed surfaces that share their vertices: a sphere of icosahedron subdivisions, f32.
[[nodiscard]] SourceMesh icosphere_mesh(int levels);

}  // namespace boxtree::robustness
