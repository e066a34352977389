// SPDX-License-Identifier: MIT
// Closest point: the point of the surface nearest to a given one.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include <boxtree/configuration.h>
#include <boxtree/export.h>
#include <boxtree/query.h>

namespace boxtree {

static_assert(BOXTREE_HAS_POINT_QUERIES,
              "BOXTREE_QUERIES left point queries out of this build of boxtree");

/// The point of a surface that is nearest to a given one.
struct ClosestPoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();            ///< Where it is, in object space.
  double distance = std::numeric_limits<double>::infinity();  ///< How far away, in object space.
  FaceRef face;                                               ///< The face that it lies on.
  /// 0, or 1 for the second half (0,2,3) of a quad. Parts of a quad that import split are faces of
  /// their own, with the same id, and have 0.
  std::uint32_t triangle = 0;
};

/// A closest point, nothing, or an error.
using PointResult = QueryResult<ClosestPoint>;

/// The nearest point of the tree's surface within `max_distance` of `point` (object space), or
/// nothing. Of several faces at the same distance the one with the smallest id (index, if the file
/// has no ids). The distance is off by at most 16 units in the last place of the largest coordinate
/// involved, for triangles of every shape. Errors: kInvalidQuery (NaN or infinite point, NaN or
/// negative distance) and the codes of corrupt bytes and limits as for closest_hit(). Never
/// allocates.
BOXTREE_API PointResult closest_point(const Tree& tree, const Eigen::Vector3d& point,
                                      double max_distance = std::numeric_limits<double>::infinity(),
                                      const QueryLimits& limits = {});

/// How near to the truth a closest point has to be.
using PointOptions = Approximation;

/// Bounds of the distance from a point to a surface, and what was found.
struct ApproximatePoint {
  /// The surface is at least this far away, in object space. Always, with all rounding included,
  /// whatever was allowed and however the query ended.
  double lower = 0;
  /// The surface is at most this far away, likewise.
  double upper = std::numeric_limits<double>::infinity();
  /// A point of the surface that is `upper` away; nothing if none was met within the maximal
  /// distance. Its `distance` is computed as in the exact query, so it may differ from `upper`, and
  /// from the truth, by rounding.
  std::optional<ClosestPoint> witness;
  /// Whether the bounds are as near to each other as was required, or as rounding lets them be:
  /// some 2^-44 of the tree's extent and the distance. Otherwise the budget ran out.
  bool converged = true;
  /// Nodes expanded and leaves read: what the budget counts.
  std::uint64_t nodes_expanded = 0;
};

/// The nearest point, as nearly as is required. With zero errors and no budget the witness is that
/// of the exact query to the last bit. With a budget the walk is best-first and may stop anywhere;
/// without one it is that of the exact query, leaving out what cannot improve the answer by more
/// than the error. Errors as above; kInvalidQuery also for options that are NaN or negative. Takes
/// up to 160 KB of stack; never allocates.
BOXTREE_API Result<ApproximatePoint> closest_point(const Tree& tree, const Eigen::Vector3d& point,
                                                   const PointOptions& options);

}  // namespace boxtree
