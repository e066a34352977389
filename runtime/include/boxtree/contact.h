// SPDX-License-Identifier: MIT
// Tree against tree: the pairs of faces that share a point, each tree with a pose of its own, and
// where they touch.
#pragma once

#include <cstdint>

#include <boxtree/configuration.h>
#include <boxtree/export.h>
#include <boxtree/query.h>

namespace boxtree {

static_assert(BOXTREE_HAS_PAIR_QUERIES,
              "BOXTREE_QUERIES left pair queries out of this build of boxtree");

/// Visits every pair of faces that share a point, each once, in no promised order. Poses take
/// object space to world and may be any invertible affine map: rotation, scale, mirror, shear.
/// The surfaces are compared, not the solids: a tree wholly inside the other gives no pair.
///
/// Answers are exact for the coordinates that arise when the second tree's triangles are brought
/// into the first one's space in double precision (translations subtracted first).
/// Errors: kInvalidPose (not finite, not invertible) and the codes of corrupt bytes as for
/// closest_hit(); kWorkLimit. Never allocates; takes up to 320 KB of stack.
BOXTREE_API Result<Visit> overlap_pairs(const Tree& first, const Pose& first_pose,
                                        const Tree& second, const Pose& second_pose,
                                        PairVisitor visitor, const QueryLimits& limits = {});

/// Some pair of faces that share a point, or nothing: cheaper than overlap_pairs() when only the
/// fact matters. Exactness, errors, stack and threads as there.
BOXTREE_API QueryResult<FacePair> first_contact(const Tree& first, const Pose& first_pose,
                                                const Tree& second, const Pose& second_pose,
                                                const QueryLimits& limits = {});

/// Where two triangles of two trees touch. Points and vectors are those of the world.
struct PairContact {
  FacePair faces;                     ///< The faces that they belong to.
  std::uint32_t first_triangle = 0;   ///< Of the first face: 0, or 1 for the second half of a quad.
  std::uint32_t second_triangle = 0;  ///< Of the second one.
  /// The ends of the segment that both triangles share, the same if that is a point. Of triangles
  /// in one plane, which share a polygon, the two of its corners that are farthest apart.
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d end = Eigen::Vector3d::Zero();    ///< The other end.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< Between them, on both.
  /// Unit vector along which the second triangle leaves the first one soonest. It is that of the
  /// two alone, whichever sides of them are solid; see tree.triangle() for their own normals.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  double depth = 0;  ///< How far it has to move along it, 0 or more.
};

/// Receives one contact after the other; returns whether to go on.
using PairContactVisitor = FunctionRef<bool(const PairContact&)>;

/// Visits every pair of triangles that share a point, as overlap_pairs() decides it, each once,
/// with where they touch. Points are within 2^-46 of the largest extent of both triangles of each
/// of them, and of the first one's coordinates; where rounding decides between planes that are
/// nearly one, start and end may be closer to each other than the true ends. Depths are off by at
/// most as much. Errors, stack and threads as there.
BOXTREE_API Result<Visit> pair_contacts(const Tree& first, const Pose& first_pose,
                                        const Tree& second, const Pose& second_pose,
                                        PairContactVisitor visitor, const QueryLimits& limits = {});

}  // namespace boxtree
