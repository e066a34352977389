// SPDX-License-Identifier: MIT
// What a convex shape touches in a scene, in world coordinates.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <boxtree/collide.h>
#include <boxtree/scene.h>

namespace boxtree {

/// Where a shape and an instance touch. Point, normal and depth are those of the world.
struct SceneContact : Contact {
  std::uint32_t instance = kNoInstance;  ///< The instance that is touched.
};

/// Receives one contact after the other; returns whether to go on.
using SceneContactVisitor = FunctionRef<bool(const SceneContact&)>;

/// Visits every triangle that the shape touches, as collide() of a tree, for the triangles that
/// arise when each corner is brought into the world in double precision. Layers count that answer
/// boxes. Errors: those of collide() on a tree; kPartLeftOut. Never allocates.
BOXTREE_API Result<Visit> collide(const Scene& scene, const Sphere& sphere,
                                  SceneContactVisitor visitor, LayerMask layers = kAllLayers,
                                  const QueryLimits& limits = {});
/// The same.
BOXTREE_API Result<Visit> collide(const Scene& scene, const Capsule& capsule,
                                  SceneContactVisitor visitor, LayerMask layers = kAllLayers,
                                  const QueryLimits& limits = {});
/// The same.
BOXTREE_API Result<Visit> collide(const Scene& scene, const OrientedBox& box,
                                  SceneContactVisitor visitor, LayerMask layers = kAllLayers,
                                  const QueryLimits& limits = {});
#if BOXTREE_HAS_HULL_QUERIES
/// The same, with up to 200 KB of stack.
BOXTREE_API Result<Visit> collide(const Scene& scene, const ConvexHull& hull,
                                  SceneContactVisitor visitor, LayerMask layers = kAllLayers,
                                  const QueryLimits& limits = {});
#endif

/// Visits every face that the shape touches, each once, in no promised order: as collide(), without
/// looking where.
BOXTREE_API Result<Visit> overlap_capsule(const Scene& scene, const Capsule& capsule,
                                          SceneFaceVisitor visitor, LayerMask layers = kAllLayers,
                                          const QueryLimits& limits = {});
/// The same for a box along axes of its own.
BOXTREE_API Result<Visit> overlap_oriented_box(const Scene& scene, const OrientedBox& box,
                                               SceneFaceVisitor visitor,
                                               LayerMask layers = kAllLayers,
                                               const QueryLimits& limits = {});
#if BOXTREE_HAS_HULL_QUERIES
/// The same for the convex hull of points.
BOXTREE_API Result<Visit> overlap_convex_hull(const Scene& scene, const ConvexHull& hull,
                                              SceneFaceVisitor visitor,
                                              LayerMask layers = kAllLayers,
                                              const QueryLimits& limits = {});
#endif

/// merge_contacts() for those of a scene, of several instances, too.
[[nodiscard]] BOXTREE_API std::size_t merge_contacts(std::span<SceneContact> contacts,
                                                     double distance, double cosine = 0.999);

}  // namespace boxtree
