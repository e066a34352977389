// SPDX-License-Identifier: MIT
// What positions lose as f32: the farther a mesh is from the origin for its size, as in metres of a
// map, the fewer bits are left for its shape.
#pragma once

#include <limits>
#include <string>
#include <string_view>

#include <Eigen/Core>

#include <boxtree/error.h>

#include "cooker/import/import.h"
#include "cooker/import/source_mesh.h"

namespace boxtree::cooker {

/// Rounding to f32 moves a coordinate by no more than this if the result is subnormal: half of the
/// smallest number.
inline constexpr double kUnderflowF32 = 0x1p-150;
static_assert(2 * kUnderflowF32 == std::numeric_limits<float>::denorm_min());

/// How far f32 may move a vertex before it is told: half a step of a grid of 16 bits over the
/// largest extent, the least that a mesh of a scene gets by default (kLeastMeshBits).
[[nodiscard]] double unnoticed_move(const Positions& positions);

/// Whether rounding to these positions of f32 can have moved a vertex farther than that.
[[nodiscard]] bool may_have_moved(const Positions& positions);

/// The distance of a position from the nearest one with coordinates of f32.
[[nodiscard]] double moved_by_f32(const Eigen::Vector3d& position);
/// The largest of these distances.
[[nodiscard]] double moved_by_f32(const Positions& positions);

/// The largest distance of a number in a text from the nearest f32, whatever the number is of.
[[nodiscard]] double loss_in_text(std::string_view text);

/// What moves no vertex: "--f64 keeps all digits".
[[nodiscard]] std::string remedy_of(F32Loss loss);
/// The same where another command is run: "cook --f64 keeps all digits".
[[nodiscard]] std::string cook_remedy_of(F32Loss loss);

/// kMeshUnsupported if f32 has moved a vertex of a mesh, in errors `what`, farther than a
/// tolerance, which is for what the source says. Precondition: imported with
/// ImportOptions::count_moves.
Status check_moved_by_f32(const SourceMesh& mesh, std::string_view what, double tolerance);

}  // namespace boxtree::cooker
