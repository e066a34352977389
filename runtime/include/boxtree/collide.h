// SPDX-License-Identifier: MIT
// What a convex shape touches where it is: faces, or contacts with point, normal and depth.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <boxtree/configuration.h>
#include <boxtree/export.h>
#include <boxtree/query.h>
#include <boxtree/shape.h>

namespace boxtree {

static_assert(BOXTREE_HAS_COLLIDE_QUERIES,
              "BOXTREE_QUERIES left collide queries out of this build of boxtree");

/// Where a shape and a triangle touch, and how to part them.
struct Contact {
  FaceRef face;  ///< The face that is touched.
  /// 0, or 1 for the second half (0,2,3) of a quad. Parts of a quad that import split are faces of
  /// their own, with the same id, and have 0.
  std::uint32_t triangle = 0;
  /// On the triangle, inside the shape or on its surface, in object space: of a sphere or capsule
  /// the point closest to its center or segment, of a box the middle of what it holds, of a hull
  /// the farthest against the normal, if it holds that, or else some.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  /// Unit vector along which the shape leaves the triangle soonest. Where the center of a sphere
  /// lies on the triangle, the front of the face.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  /// How far the shape has to move along the normal until they only touch, 0 or more, in object
  /// space.
  double depth = 0;
  Feature feature = Feature::kFace;  ///< What part of the triangle is touched.
  /// The corner of a vertex; the corner from which an edge leads to the next one: 0 to 2, of
  /// Tree::triangle(face, triangle). 0 for a face.
  std::uint8_t feature_index = 0;
  /// Whether the feature may keep the normal; see CastHit::is_active.
  bool is_active = true;
  /// Unit vector orthogonal to the face, to the side to which the normal points; along both sides,
  /// to its front. Zero for a face without an area.
  Eigen::Vector3d face_normal = Eigen::Vector3d::Zero();
};

/// The normal along which the contact should act; see resolved_normal() of a CastHit.
[[nodiscard]] BOXTREE_API Eigen::Vector3d resolved_normal(const Contact& contact,
                                                          const Eigen::Vector3d& velocity);

/// Receives one contact after the other; returns whether to go on.
using ContactVisitor = FunctionRef<bool(const Contact&)>;

/// Visits every triangle that the shape touches, each once, in no promised order; copies of a face,
/// too. Faces are touched, not solids: a shape wholly inside a mesh touches nothing. Nothing is
/// missed; what is within 2^-46 of the largest coordinate involved may count as touched, with a
/// depth of 0, and depths are off by at most that. Errors: kInvalidQuery (not finite; a negative
/// radius or extent; a rotation of 0; no points, or more than kMaxHullPoints; a shape farther than
/// 2^185 mesh extents away, or larger), and the codes of corrupt bytes and limits as for
/// closest_hit(). Never allocates.
BOXTREE_API Result<Visit> collide(const Tree& tree, const Sphere& sphere, ContactVisitor visitor,
                                  const QueryLimits& limits = {});
/// The same.
BOXTREE_API Result<Visit> collide(const Tree& tree, const Capsule& capsule, ContactVisitor visitor,
                                  const QueryLimits& limits = {});
/// The same.
BOXTREE_API Result<Visit> collide(const Tree& tree, const OrientedBox& box, ContactVisitor visitor,
                                  const QueryLimits& limits = {});
#if BOXTREE_HAS_HULL_QUERIES
/// The same, with up to 200 KB of stack.
BOXTREE_API Result<Visit> collide(const Tree& tree, const ConvexHull& hull, ContactVisitor visitor,
                                  const QueryLimits& limits = {});
#endif

/// Visits every face that the shape touches, each once, in no promised order: as collide(), without
/// looking where.
BOXTREE_API Result<Visit> overlap_capsule(const Tree& tree, const Capsule& capsule,
                                          FaceVisitor visitor, const QueryLimits& limits = {});
/// The same for a box along axes of its own.
BOXTREE_API Result<Visit> overlap_oriented_box(const Tree& tree, const OrientedBox& box,
                                               FaceVisitor visitor, const QueryLimits& limits = {});
#if BOXTREE_HAS_HULL_QUERIES
/// The same for the convex hull of points.
BOXTREE_API Result<Visit> overlap_convex_hull(const Tree& tree, const ConvexHull& hull,
                                              FaceVisitor visitor, const QueryLimits& limits = {});
#endif

/// Of contacts of one shape, keeps one of those that neighbouring triangles report of the same
/// point: within `distance` of each other, with normals whose cosine is at least `cosine`. Keeps
/// the deepest one, of equal depths the first, then the deepest of those that are unlike it, and so
/// on: each that is left out is like one that is kept and no less deep. Moves those that are kept
/// to the front, in their order, and returns how many; what is behind them is unspecified.
/// Quadratic in their number. Never allocates.
[[nodiscard]] BOXTREE_API std::size_t merge_contacts(std::span<Contact> contacts, double distance,
                                                     double cosine = 0.999);

}  // namespace boxtree
