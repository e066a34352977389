// SPDX-License-Identifier: MIT
// Rays: the closest hit, whether there is any, and all of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>

#include <boxtree/configuration.h>
#include <boxtree/export.h>
#include <boxtree/face_options.h>
#include <boxtree/query.h>

namespace boxtree {

static_assert(BOXTREE_HAS_RAY_QUERIES,
              "BOXTREE_QUERIES left ray queries out of this build of boxtree");

/// A ray or segment in object space: all points origin + t * direction with t_min <= t <= t_max.
struct Ray {
  Eigen::Vector3d origin;     ///< Where t is 0.
  Eigen::Vector3d direction;  ///< Of any length but zero; the unit of t.
  double t_min = 0;           ///< Begin, 0 or more.
  double t_max = std::numeric_limits<double>::infinity();  ///< End, `t_min` or more.
};

/// Where a ray meets a surface.
struct RayHit {
  double t = std::numeric_limits<double>::infinity();  ///< In units of the ray's direction.
  FaceRef face;                                        ///< The face that was hit.
  /// 0, or 1 for the second half (0,2,3) of a quad. Parts of a quad that import split are faces of
  /// their own, with the same id, and have 0.
  std::uint32_t triangle = 0;
  double u = 0,  ///< Weight of the triangle's corner 1.
      v = 0;     ///< Weight of its corner 2; corner 0 has 1 - u - v.
  /// Where the face was hit, on the face by its weights: from far away more exact than
  /// origin + t * direction.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  /// Unit normal of the face, to the side from which its corners are seen counterclockwise; zero
  /// where the face has no area.
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
};

/// A hit, nothing, or an error.
using RayResult = QueryResult<RayHit>;

/// The hit with the smallest t, in object space; of several at the same t the one with the smallest
/// face id (index, if the file has no ids), so that all codecs and brute force agree. Both sides of
/// a face count, edges and corners are part of it and no gap lies between faces that share them; a
/// ray in the plane of a face does not hit it, nor does any ray hit a face without area, but for
/// rounding. Errors: kInvalidQuery (NaN or infinite origin or direction, zero direction, empty
/// interval, an origin more than 2^185 mesh extents away), and
/// kNodeCorrupt, kDepthExceeded, kFaceOutOfRange, kVertexOutOfRange, kVertexNotFinite on corrupt
/// bytes that the ray comes upon, whatever it has hit by then; kWorkLimit when `limits` do not
/// suffice. Never allocates.
BOXTREE_API RayResult closest_hit(const Tree& tree, const Ray& ray, const QueryLimits& limits = {});

/// Some hit, or nothing: cheaper than closest_hit() when only the fact matters. Errors as there.
/// Never allocates.
BOXTREE_API RayResult any_hit(const Tree& tree, const Ray& ray, const QueryLimits& limits = {});

/// The same among the faces that `options` let be hit. Of a face and its copies the first that the
/// filter accepts. Whether a face is met from behind is decided exactly for the corners as the ray
/// sees them, which are rounded: as close to edge-on as rounding, either side may be.
BOXTREE_API RayResult closest_hit(const Tree& tree, const Ray& ray, const FaceOptions& options);
/// Some hit of those, or nothing.
BOXTREE_API RayResult any_hit(const Tree& tree, const Ray& ray, const FaceOptions& options);

/// Receives one hit after the other; returns the largest t that is still of interest, or a negative
/// number to stop. Of `t_max` every hit is visited, of each hit's own t what comes before it.
using RayVisitor = FunctionRef<double(const RayHit&)>;

/// Visits every hit, in no promised order: each triangle once, copies of a face, too; of a ray
/// through an edge, one of its triangles or both. Errors as for closest_hit(). Never allocates.
BOXTREE_API Result<Visit> all_hits(const Tree& tree, const Ray& ray, RayVisitor visitor,
                                   const FaceOptions& options = {});

/// The first hits, as many as `hits` has room for, in ascending order of t, then of face ids.
/// Returns how many there are. Takes time proportional to the room for each hit that is met.
/// Errors as for closest_hit(). Never allocates.
BOXTREE_API Result<std::size_t> nearest_hits(const Tree& tree, const Ray& ray,
                                             std::span<RayHit> hits,
                                             const FaceOptions& options = {});

}  // namespace boxtree
