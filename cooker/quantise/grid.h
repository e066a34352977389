// SPDX-License-Identifier: MIT
// From positions to whole numbers: the grid that all trees of a file share, and a mesh brought onto
// it before anything is built, so that boxes hold what a reader will decode.
#pragma once

#include <array>
#include <optional>

#include <Eigen/Geometry>

#include <boxtree/error.h>

#include "cooker/import/source_mesh.h"

namespace boxtree::cooker {

/// How fine a grid is to be: the last of these that is given.
struct GridChoice {
  int bits = 24;                     // steps in the largest extent of the scene: 2^bits
  std::optional<double> tolerance;   // no vertex moves farther, in object space
  std::optional<int> step_exponent;  // the step is 2^step_exponent, in object space
};

/// Points origin + q * 2^step_exponent for whole q.
struct Grid {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  // object space
  int step_exponent = 0;
};

/// The smallest e with 2^e >= x; x is positive.
[[nodiscard]] int exponent_above(double x);

/// Bounds of all positions; empty for a mesh without any.
[[nodiscard]] Eigen::AlignedBox3d bounds_of(const SourceMesh& mesh);

/// A grid over `bounds` of all meshes that go into one file. Its origin is a multiple of its step
/// where double can hold one. kMeshUnsupported when a tolerance or a step needs more than
/// kMaxGridBits, or a tolerance is not positive and finite.
Result<Grid> choose_grid(const Eigen::AlignedBox3d& bounds, const GridChoice& choice);

/// A mesh on the grid, in grid steps around a middle of its own: whole numbers, so that float holds
/// them up to 25 bits of extent; as f64 above that.
struct QuantisedMesh {
  SourceMesh mesh;
  std::array<double, 3> origin{};  // of its coordinates, object space
  int step_exponent = 0;
  double max_vertex_error = 0;  // largest distance of a vertex from its source, object space
};

/// Brings a mesh onto the grid; faces, ids and name stay. Precondition: a grid over bounds that
/// contain the mesh.
[[nodiscard]] QuantisedMesh quantise(const SourceMesh& mesh, const Grid& grid);

}  // namespace boxtree::cooker
