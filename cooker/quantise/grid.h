// SPDX-License-Identifier: MIT
// Quantisation: the grid that all trees of a file share, and positions on that grid. Meshes are
// quantised before trees are built, so boxes contain what a reader decodes.
#pragma once

#include <array>
#include <limits>
#include <optional>
#include <span>

#include <Eigen/Geometry>

#include <boxtree/error.h>

#include "cooker/import/source_mesh.h"
#include "format/limits.h"

namespace boxtree::cooker {

/// Steps are powers of two, from 2^-kMaxStepExponent to 2^kMaxStepExponent: the scale of a tree on
/// the grid maps extents of 1 to 2^30 steps to 2^14, so it differs from the step by at most 16
/// binary orders.
inline constexpr int kMaxStepExponent = kMaxScaleExponent - 16;

/// The resolution of a grid: the last member that is set counts.
struct GridChoice {
  int bits = 24;                     // steps in the largest extent of the scene: 2^bits
  std::optional<double> tolerance;   // no vertex moves farther from its source, in object space
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

/// How far the vertices of a mesh may still move if none may be farther than `tolerance` from where
/// the source has it: what f32 moved them by is taken from it. 0 or less if that is all of it.
[[nodiscard]] double tolerance_left(double tolerance, const SourceMesh& mesh) noexcept;

/// A grid over `bounds`, the bounds of all meshes in a file. Its origin is a multiple of its step
/// if a double can represent one. Errors: kMeshUnsupported if a tolerance or a step needs more than
/// kMaxGridBits, or a tolerance is not positive and finite.
Result<Grid> choose_grid(const Eigen::AlignedBox3d& bounds, const GridChoice& choice);

/// The grid over the bounds of all `meshes`, which share it. With a tolerance, it is made coarser
/// by coarsen_together. Errors: as above.
Result<Grid> choose_grid(std::span<const SourceMesh* const> meshes, const GridChoice& choice);

/// A mesh, its grid over `bounds`, and how far its vertices may move on it.
struct MeshOnGrid {
  const SourceMesh* mesh;
  Eigen::AlignedBox3d bounds;  // contain the mesh
  Grid grid;
  double tolerance;  // object space; from the source, as in GridChoice
  int largest_step_exponent = std::numeric_limits<int>::max();
};

/// Doubles the steps of all grids as often as no vertex of any mesh moves farther than its
/// tolerance: of all together, so that what touches on equal grids still does. choose_grid allows
/// for the farthest that a vertex can move, halfway between points of the grid on every axis;
/// usually none lies there. Cost: a pass over the vertices for each doubling, of which there are at
/// most kMaxGridBits, since no step grows beyond the extent of `bounds`; the last pass ends at the
/// first vertex that moves too far.
void coarsen_together(std::span<MeshOnGrid> meshes);

/// The positions of a mesh on the grid, in grid steps from the mesh's own centre. Coordinates are
/// whole numbers: f32 for extents up to 25 bits, f64 above.
struct QuantisedPositions {
  Positions positions;
  std::array<double, 3> origin{};  // of its coordinates, object space
  int step_exponent = 0;
  /// Largest distance of a vertex from its source, object space, with what f32 moved it by.
  double max_vertex_error = 0;
};

/// Moves the vertices of a mesh onto the grid. Precondition: the grid's bounds contain the mesh.
[[nodiscard]] QuantisedPositions quantise(const SourceMesh& mesh, const Grid& grid);

}  // namespace boxtree::cooker
