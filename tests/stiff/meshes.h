// SPDX-License-Identifier: MIT
// The surfaces that stiff contact is measured on. Units are metres, z is up, centred on the origin.
#pragma once

#include "cooker/import/source_mesh.h"

namespace boxtree::stiff {

using cooker::SourceMesh;

/// A box around the origin, of twelve triangles with outward normals.
[[nodiscard]] SourceMesh box(const Eigen::Vector3d& half_extents);

/// Stairs of `steps` treads and risers over a square of `size`, climbing along x by kStairRise a
/// step, in quads of `cells` along y.
inline constexpr float kStairRise = 0.17f;  // no number that f16 or a grid of powers of two holds
[[nodiscard]] SourceMesh stairs(unsigned steps, unsigned cells, double size);
/// Where on the stairs a body can stand: the middle of tread `step`, as f32 rounds it.
[[nodiscard]] Eigen::Vector3d tread_middle(unsigned step, unsigned steps, double size);

/// The same square as height(x, y) in 2 * cells * cells triangles.
enum class Field {
  kFlat,    // at a height that no grid of powers of two holds
  kSine,    // kSineHeight * sin * sin, kSineWaves waves along each edge
  kTilted,  // by tilted_normal()
};
inline constexpr double kSineHeight = 0.3;
inline constexpr double kSineWaves = 4;
inline constexpr double kFlatHeight = 0.1;
[[nodiscard]] SourceMesh field(Field field, unsigned cells, double size);
[[nodiscard]] Eigen::Vector3d tilted_normal();

/// Walls of `thickness` across x, some `size` / `walls` apart, each of two sides with outward
/// normals in cells of a quarter of a metre.
[[nodiscard]] SourceMesh walls(unsigned walls, double thickness, double size);
/// Where the front (low x) of a wall is, as f32 rounds it.
[[nodiscard]] double wall_front(unsigned wall, unsigned walls, double size);

}  // namespace boxtree::stiff
