// SPDX-License-Identifier: MIT
// Casts: where a shape that moves along a straight line first touches a surface (also called
// sweeps). The shape does not turn on its way.
#pragma once

#include <cstdint>
#include <limits>

#include <boxtree/configuration.h>
#include <boxtree/export.h>
#include <boxtree/face_options.h>
#include <boxtree/query.h>
#include <boxtree/shape.h>

namespace boxtree {

static_assert(BOXTREE_HAS_CAST_QUERIES, "BOXTREE_QUERIES left casts out of this build of boxtree");

/// How a shape moves: at t it is where it started + t * direction, for 0 <= t <= t_max.
struct Motion {
  /// Of any length, the unit of t; object space. Of zero the shape stays where it is.
  Eigen::Vector3d direction = Eigen::Vector3d::Zero();
  double t_max = std::numeric_limits<double>::infinity();  ///< The end, 0 or more.
};

/// The first touch of a moving shape and a surface.
struct CastHit {
  /// The shape touches at t or before, in units of the direction; 0 where it touches at its start.
  double t = std::numeric_limits<double>::infinity();
  /// And it touches nothing before t_lower: moving it there is safe. Never above t. See
  /// cast_closest() for how near to each other they are.
  double t_lower = std::numeric_limits<double>::infinity();
  FaceRef face;  ///< The face that is touched.
  /// 0, or 1 for the second half (0,2,3) of a quad. Parts of a quad that import split are faces of
  /// their own, with the same id, and have 0.
  std::uint32_t triangle = 0;
  /// Where they touch, on the surface, in object space. Of several points one of them; where they
  /// touch at the start, a point of the face that the shape holds.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  /// Unit vector along which the surface pushes the shape back, orthogonal to both where both are
  /// smooth; where they overlap at the start, the one along which the shape leaves the face
  /// soonest.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  Feature feature = Feature::kFace;  ///< What part of the triangle the point lies on.
  bool initially_touching = false;   ///< Whether the shape touches the face at its start.
  /// The corner of a vertex; the corner from which an edge leads to the next one: 0 to 2, of
  /// Tree::triangle(face, triangle). 0 for a face.
  std::uint8_t feature_index = 0;
  /// Whether the feature may keep the normal: not at edges where the surface goes on flat or
  /// rises, nor at vertices whose edges are all of this kind. See active_edges().
  bool is_active = true;
  /// Unit vector orthogonal to the face, to the side to which the normal points; along both sides,
  /// to its front. Zero for a face without an area.
  Eigen::Vector3d face_normal = Eigen::Vector3d::Zero();
};

/// A touch, nothing, or an error.
using CastResult = QueryResult<CastHit>;

/// The first touch of the shape on its way; of several at the same t_lower the one with the
/// smallest face id (index, if the file has no ids), so that all codecs and brute force agree.
/// Faces count that `options` let be hit: one is met from behind if its normal points along the
/// motion, which no face without area does. These count as the segments or points that they are.
/// Nothing is missed: a shape that touches is found to, and one that passes within
/// 2^-46 of the largest coordinate involved (of the surface, of the shape on its way, and 2^-49 of
/// that of its start) may be. t and t_lower are as far apart as the shape moves while it comes
/// nearer by at most four times that. Errors: kInvalidQuery (not finite; a negative radius, extent
/// or t_max; a rotation of 0; no points, or more than kMaxHullPoints; a shape farther than 2^185
/// mesh extents away, or larger), and the codes of corrupt bytes and limits as for closest_hit().
/// Never allocates.
BOXTREE_API CastResult cast_closest(const Tree& tree, const Sphere& sphere, const Motion& motion,
                                    const FaceOptions& options = {});
/// The same.
BOXTREE_API CastResult cast_closest(const Tree& tree, const Capsule& capsule, const Motion& motion,
                                    const FaceOptions& options = {});
/// The same.
BOXTREE_API CastResult cast_closest(const Tree& tree, const OrientedBox& box, const Motion& motion,
                                    const FaceOptions& options = {});
#if BOXTREE_HAS_HULL_QUERIES
/// The same. A hull whose points are farther from their origin than it is large is placed with the
/// digits of that distance, where it is rotated. Takes time in proportion to the number of points,
/// and up to 200 KB of stack.
BOXTREE_API CastResult cast_closest(const Tree& tree, const ConvexHull& hull, const Motion& motion,
                                    const FaceOptions& options = {});
#endif

/// Some touch, or nothing: cheaper than cast_closest() when only the fact matters. Errors as there.
/// Never allocates.
BOXTREE_API CastResult cast_any(const Tree& tree, const Sphere& sphere, const Motion& motion,
                                const FaceOptions& options = {});
/// The same.
BOXTREE_API CastResult cast_any(const Tree& tree, const Capsule& capsule, const Motion& motion,
                                const FaceOptions& options = {});
/// The same.
BOXTREE_API CastResult cast_any(const Tree& tree, const OrientedBox& box, const Motion& motion,
                                const FaceOptions& options = {});
#if BOXTREE_HAS_HULL_QUERIES
/// The same.
BOXTREE_API CastResult cast_any(const Tree& tree, const ConvexHull& hull, const Motion& motion,
                                const FaceOptions& options = {});
#endif

/// Receives one touch after the other; returns the largest t that is still of interest, or a
/// negative number to stop. Of `t_max` everything on the way is visited, of each hit's own t what
/// comes before it.
using CastVisitor = FunctionRef<double(const CastHit&)>;

/// Visits every triangle that the shape touches on its way, each once, with the hit that it would
/// be alone, in no promised order; copies of a face, too. Errors as for cast_closest(). Never
/// allocates.
BOXTREE_API Result<Visit> cast_all(const Tree& tree, const Sphere& sphere, const Motion& motion,
                                   CastVisitor visitor, const FaceOptions& options = {});
/// The same.
BOXTREE_API Result<Visit> cast_all(const Tree& tree, const Capsule& capsule, const Motion& motion,
                                   CastVisitor visitor, const FaceOptions& options = {});
/// The same.
BOXTREE_API Result<Visit> cast_all(const Tree& tree, const OrientedBox& box, const Motion& motion,
                                   CastVisitor visitor, const FaceOptions& options = {});
#if BOXTREE_HAS_HULL_QUERIES
/// The same.
BOXTREE_API Result<Visit> cast_all(const Tree& tree, const ConvexHull& hull, const Motion& motion,
                                   CastVisitor visitor, const FaceOptions& options = {});
#endif

/// Which edges of a triangle of a face are active: bit i is the edge from corner i of
/// Tree::triangle(face, half) to the next one. Active are boundaries, edges of more than two faces,
/// and those at which the surface, seen from the front of the face, bends away by more degrees than
/// the cook was told (--active-edges). All edges of a tree without active edges are
/// (Tree::has_active_edges()), and of a triangle without an area; a diagonal of a quad never is.
/// Bit i is edge i alone; what a vertex has is up to both edges at it. Errors: as Tree::triangle.
/// Costs what reading one leaf does. Never allocates but for the text of an error.
[[nodiscard]] BOXTREE_API Result<std::uint32_t> active_edges(const Tree& tree, const FaceRef& face,
                                                             std::uint32_t half = 0);

/// The normal along which a contact should act: that of the hit, or of the face where the feature
/// is not active, so that bodies neither trip over edges inside a floor nor are lifted by them. The
/// face's is on the side of the hit's normal; where this lies in the plane of the face, on the side
/// against the velocity of the shape, relative to the surface, of any length. (Zero: the front.)
/// What parts shape and face along the hit's normal is enough along the face's, too, where the
/// surface goes on flat. Never allocates.
[[nodiscard]] BOXTREE_API Eigen::Vector3d resolved_normal(const CastHit& hit,
                                                          const Eigen::Vector3d& velocity);

}  // namespace boxtree
