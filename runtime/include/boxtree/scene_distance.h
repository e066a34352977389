// SPDX-License-Identifier: MIT
// How far a body is from the instances of a scene, exactly or as nearly as is required.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include <boxtree/distance.h>
#include <boxtree/scene.h>

namespace boxtree {

/// Two faces, and a point of each.
struct SceneDistanceWitness {
  ScenePair faces;         ///< A face of each body; which is the first one, each query says.
  Eigen::Vector3d first;   ///< A point of the first face, in the world.
  Eigen::Vector3d second;  ///< A point of the second face, in the world.
};

/// Bounds of the distance of a body from what is nearest to it in a scene. Fields are as in
/// Distance.
struct SceneDistance {
  /// No instance is nearer. Where nothing is within the maximal distance, at least that.
  double lower = 0;
  /// Some instance is at most this far away.
  double upper = std::numeric_limits<double>::infinity();
  /// What is `upper` apart; nothing if there is nothing within the maximal distance, or if a budget
  /// ended the query before triangles were met.
  std::optional<SceneDistanceWitness> witness;
  /// Whether the bounds are as near to each other as was required. Otherwise the budget ran out.
  bool converged = true;
  /// Of all instances that were compared.
  std::uint64_t nodes_expanded = 0;
};

/// How far a tree that is no part of the scene, placed by `pose`, is from the nearest instance of
/// the given layers: `first` of the witness is a face of the scene, `second` one of the tree, whose
/// instance is kNoInstance. Each pair of trees is answered as by distance(), in the order of
/// overlap_pairs(); of several instances at the same distance, that whose box is nearest, then that
/// with the smallest number. Layers count that answer pairs.
///
/// Instances are compared from near to far by their boxes, as long as one may be nearer than what
/// was found. A budget counts what is compared of all of them together, not the instances whose
/// boxes are looked at: all that may be nearer, sixteen first, then a thousand at a time. Errors:
/// kInvalidPose, kInvalidQuery (as for distance()), kPartLeftOut, and the codes of corrupt bytes.
/// Never allocates; takes up to 528 KB of stack.
BOXTREE_API Result<SceneDistance> distance(const Scene& scene, const Tree& tree, const Pose& pose,
                                           LayerMask layers = kAllLayers,
                                           const DistanceOptions& options = {});

/// How far an instance, moving or not, is from the nearest other one whose layer collides with its
/// own: `first` of the witness is a face of the instance. Also kInstanceIndex.
BOXTREE_API Result<SceneDistance> distance_of(const Scene& scene, std::uint32_t instance,
                                              const DistanceOptions& options = {});

}  // namespace boxtree
