// SPDX-License-Identifier: MIT
// Finds the active edges of a surface: those at which a contact may keep its own normal. At all
// others, where the surface goes on flat or rises, a contact has to take the normal of the face, or
// bodies trip over edges inside a floor.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "cooker/import/source_mesh.h"

namespace boxtree::cooker {

/// By how much a surface has to bend for an edge to be active.
struct EdgeAngle {
  double cosine = 1;
  double sine = 0;

  /// The same bits on every machine. Precondition: 0 <= degrees <= 90.
  [[nodiscard]] static EdgeAngle of_degrees(double degrees) noexcept;
};

/// An edge of a face: from its corner `edge` to the next one.
struct FaceEdge {
  std::uint32_t face = 0;
  std::uint32_t edge = 0;

  bool operator==(const FaceEdge&) const = default;
  auto operator<=>(const FaceEdge&) const = default;
};

/// A face at one of its edges, which leads from `from` to `to` if the face is seen from its front.
struct EdgeSide {
  Eigen::Vector3d from, to;
  Eigen::Vector3d apex;    // another corner of the face
  Eigen::Vector3d normal;  // of length 1
};

/// The face at that edge; its normal is zero if the face has no area. Precondition: the face has
/// such an edge.
[[nodiscard]] EdgeSide side_of(const MeshView& mesh, const FaceEdge& edge);

/// Whether a surface, seen from the front of `face`, bends away from it by more than the angle
/// where `next` goes on. Where the fronts of both are on different sides, `next` counts as if it
/// were turned. Exact for an angle of 0 if positions are.
[[nodiscard]] bool bends_away(const EdgeSide& face, const EdgeSide& next, bool is_turned,
                              const EdgeAngle& angle);

/// The active edges of one mesh.
struct ActiveEdges {
  double degrees = 0;                 // by more than that the surface bends at them
  std::vector<std::uint8_t> of_face;  // bit i: the edge from corner i to the next one
  std::vector<FaceEdge> open;         // edges of one face alone, ascending; all are active
  bool is_by_face = false;            // some edge is active for one of its faces alone
};

/// Vertices are one if their positions are equal; -0 is 0. An edge is active if one face has it
/// alone, or more than two have it, or the other one bends away by more than `degrees`. Faces that
/// have the same corners, copies or back to back, count as one, so that both layers of a two-sided
/// floor are smooth. Faces without area have active edges alone and are no neighbours. O(faces).
/// Precondition: 0 <= degrees <= 90.
[[nodiscard]] ActiveEdges find_active_edges(const MeshView& mesh, double degrees);
/// The same where faces have no edges but some of theirs, bit i: the edge from corner i to the next
/// one. All others are active. Precondition: `edges` has an entry for each face.
[[nodiscard]] ActiveEdges find_active_edges(const MeshView& mesh, double degrees,
                                            std::span<const std::uint8_t> edges);

}  // namespace boxtree::cooker
