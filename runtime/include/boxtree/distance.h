// SPDX-License-Identifier: MIT
// Distance of two trees' surfaces, exactly or as nearly as is required, each tree with a pose.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include <boxtree/configuration.h>
#include <boxtree/export.h>
#include <boxtree/query.h>

namespace boxtree {

static_assert(BOXTREE_HAS_DISTANCE_QUERIES,
              "BOXTREE_QUERIES left distance queries out of this build of boxtree");

/// How near to the truth a distance has to be.
using DistanceOptions = Approximation;

/// Two faces, and a point of each.
struct DistanceWitness {
  FacePair faces;          ///< A face of each tree.
  Eigen::Vector3d first;   ///< A point of the first face, in the world.
  Eigen::Vector3d second;  ///< A point of the second face, in the world.
};

/// Bounds of the distance of two surfaces, and what was found.
struct Distance {
  /// The surfaces are at least this far apart, a length of the world. Always, with all rounding
  /// included, whatever was allowed and however the query ended.
  double lower = 0;
  /// The surfaces are at most this far apart, likewise.
  double upper = std::numeric_limits<double>::infinity();
  /// What is `upper` apart; nothing if no triangles were met, or none within the maximal distance:
  /// whether there are any is decided to within rounding, whatever error is allowed, unless the
  /// budget runs out. Points far from the world's origin are rounded more coarsely than `upper`
  /// is.
  std::optional<DistanceWitness> witness;
  /// Whether the bounds are as near to each other as was required, or as rounding lets them be:
  /// some 2^-44 of the triangles' size and distance. Otherwise the budget ran out.
  bool converged = true;
  /// Pairs of nodes expanded and pairs of leaves compared: what the budget counts.
  std::uint64_t nodes_expanded = 0;
};

/// The distance of two surfaces in the world. Poses may be any invertible affine map, as for
/// overlap_pairs(), and like there the second tree's triangles count as they are after being
/// brought into the first one's space in double precision. Whether a pair of faces touches is for
/// exact predicates: if one was found both bounds are zero, and with no error allowed and no budget
/// one is found if there is any. Empty trees are infinitely far from anything.
///
/// The walk is best-first: with a budget it may be stopped anywhere and has then made the best of
/// it. Before it, unless the budget is 0 or the bounds are too far apart, up to six searches for a
/// closest point, back and forth between the trees, visit at most 256 nodes and leaves each, which
/// no budget counts. Nodes visited do not grow with the error that is allowed, as long as its queue
/// (of 2048 pairs) suffices; when it is full, part of the walk is depth-first and the bounds stay
/// true.
///
/// Errors: kInvalidPose, kInvalidQuery (options that are NaN or negative) and the codes of corrupt
/// bytes as for closest_hit(). Never allocates; takes half a megabyte of stack.
BOXTREE_API Result<Distance> distance(const Tree& first, const Pose& first_pose, const Tree& second,
                                      const Pose& second_pose, const DistanceOptions& options = {});

}  // namespace boxtree
