// SPDX-License-Identifier: MIT
// What a scene answers, in world coordinates: rays, boxes, spheres, closest points, contacts.
//
// Each query answers for the instances of the given layers whose layer answers its kind. Errors, if
// not said otherwise: those of the same query on a tree; kPartLeftOut when the scene was cooked
// without the kind; kRecordInvalid on corrupt bytes. Limits count for all instances together. None
// allocates.
#pragma once

#include <limits>
#include <optional>

#include <boxtree/closest.h>
#include <boxtree/configuration.h>
#include <boxtree/contact.h>
#include <boxtree/ray.h>

#include "runtime/scene/scene.h"

static_assert(BOXTREE_HAS_SCENE_QUERIES,
              "BOXTREE_QUERIES left scenes out of this build of boxtree");

namespace boxtree {

/// A face of an instance.
struct SceneFace {
  std::uint32_t instance;
  FaceRef face;
};

/// Receives one face after the other; returns whether to go on.
using SceneFaceVisitor = FunctionRef<bool(const SceneFace&)>;

struct SceneRayHit {
  RayHit hit;
  std::uint32_t instance;
};

/// The hit with the smallest t; of several at the same t that of the instance with the smallest id,
/// then of the smallest face. The ray is brought into each tree's object space in double precision
/// and answered there, so no gap lies between faces of one instance that share an edge.
Result<std::optional<SceneRayHit>> closest_hit(const Scene& scene, const Ray& ray,
                                               LayerMask layers = kAllLayers,
                                               const QueryLimits& limits = {});

/// Some hit, or nothing.
Result<std::optional<SceneRayHit>> any_hit(const Scene& scene, const Ray& ray,
                                           LayerMask layers = kAllLayers,
                                           const QueryLimits& limits = {});

/// Visits every face that touches the closed box `box` of the world, each once. Exact for the
/// triangles that arise when each corner is brought into the world in double precision.
Result<Visit> overlap_box(const Scene& scene, const Eigen::AlignedBox3d& box,
                          SceneFaceVisitor visitor, LayerMask layers = kAllLayers,
                          const QueryLimits& limits = {});

/// Visits every face whose distance from `center` is at most `radius`, likewise.
Result<Visit> overlap_sphere(const Scene& scene, const Eigen::Vector3d& center, double radius,
                             SceneFaceVisitor visitor, LayerMask layers = kAllLayers,
                             const QueryLimits& limits = {});

struct SceneClosestPoint {
  ClosestPoint closest;  // world
  std::uint32_t instance;
};

/// The nearest point of any surface within `max_distance` of `point`, or nothing. Of several at the
/// same distance that of the instance with the smallest id, then of the smallest face.
Result<std::optional<SceneClosestPoint>> closest_point(
    const Scene& scene, const Eigen::Vector3d& point,
    double max_distance = std::numeric_limits<double>::infinity(), LayerMask layers = kAllLayers,
    const QueryLimits& limits = {});

/// A face of an instance and a face of another body that touch.
struct ScenePair {
  SceneFace first;
  SceneFace second;
};
using ScenePairVisitor = FunctionRef<bool(const ScenePair&)>;

/// Visits every contact of a moving instance with any other one, each pair of faces once; `first`
/// is the moving instance, of two the one with the smaller number. Pairs whose layers do not meet,
/// and pairs of static instances, are not looked at. Each pair of instances is answered as by
/// overlap_pairs of the two trees, the one whose pose magnifies errors less being the first there.
Result<Visit> contacts(const Scene& scene, ScenePairVisitor visitor,
                       const QueryLimits& limits = {});

/// The contacts of one instance, moving or not, with all others: `first` is the instance.
/// Also kInstanceIndex.
Result<Visit> contacts_of(const Scene& scene, std::uint32_t instance, ScenePairVisitor visitor,
                          const QueryLimits& limits = {});

/// Visits every pair of a face of the scene (`first`) and a face of a tree that is no part of it,
/// placed by `pose` (`second`, whose instance is kNoInstance).
inline constexpr std::uint32_t kNoInstance = 0xffffffffu;
Result<Visit> overlap_pairs(const Scene& scene, const Tree& tree, const Pose& pose,
                            ScenePairVisitor visitor, LayerMask layers = kAllLayers,
                            const QueryLimits& limits = {});

}  // namespace boxtree
