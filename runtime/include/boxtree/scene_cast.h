// SPDX-License-Identifier: MIT
// Casts in a scene, in world coordinates.
#pragma once

#include <cstdint>

#include <boxtree/cast.h>
#include <boxtree/scene.h>

namespace boxtree {

/// The first touch of a moving shape and an instance. Point and normal are in world coordinates.
struct SceneCastHit : CastHit {
  std::uint32_t instance = kNoInstance;  ///< The instance that is touched.
};

/// A touch, nothing, or an error.
using SceneCastResult = QueryResult<SceneCastHit>;

/// The first touch of the shape on its way through the world, as cast_closest() of a tree answers
/// it for the triangles that arise when each corner is brought into the world in double precision:
/// poses may mirror, stretch and shear them. Of several at the same t_lower that of the instance
/// with the smallest id, then of the smallest face. Layers count that answer rays. How near t and
/// t_lower are to each other and to the true touch depends on the largest coordinates of the
/// instance and of the shape. Errors: those of a cast on a tree, of the scene's own, far beyond
/// which no shape may be; kPartLeftOut. Never allocates.
BOXTREE_API SceneCastResult cast_closest(const Scene& scene, const Sphere& sphere,
                                         const Motion& motion,
                                         const SceneFaceOptions& options = {});
/// The same.
BOXTREE_API SceneCastResult cast_closest(const Scene& scene, const Capsule& capsule,
                                         const Motion& motion,
                                         const SceneFaceOptions& options = {});
/// The same.
BOXTREE_API SceneCastResult cast_closest(const Scene& scene, const OrientedBox& box,
                                         const Motion& motion,
                                         const SceneFaceOptions& options = {});
#if BOXTREE_HAS_HULL_QUERIES
/// The same. Takes time in proportion to the number of points, and up to 200 KB of stack.
BOXTREE_API SceneCastResult cast_closest(const Scene& scene, const ConvexHull& hull,
                                         const Motion& motion,
                                         const SceneFaceOptions& options = {});
#endif

/// Some touch, or nothing: cheaper than cast_closest() when only the fact matters.
BOXTREE_API SceneCastResult cast_any(const Scene& scene, const Sphere& sphere, const Motion& motion,
                                     const SceneFaceOptions& options = {});
/// The same.
BOXTREE_API SceneCastResult cast_any(const Scene& scene, const Capsule& capsule,
                                     const Motion& motion, const SceneFaceOptions& options = {});
/// The same.
BOXTREE_API SceneCastResult cast_any(const Scene& scene, const OrientedBox& box,
                                     const Motion& motion, const SceneFaceOptions& options = {});
#if BOXTREE_HAS_HULL_QUERIES
/// The same.
BOXTREE_API SceneCastResult cast_any(const Scene& scene, const ConvexHull& hull,
                                     const Motion& motion, const SceneFaceOptions& options = {});
#endif

/// Receives one touch after the other; what it returns is as for CastVisitor.
using SceneCastVisitor = FunctionRef<double(const SceneCastHit&)>;

/// Visits every triangle that the shape touches on its way, each once, with the hit that it would
/// be alone, in no promised order; copies of a face, too.
BOXTREE_API Result<Visit> cast_all(const Scene& scene, const Sphere& sphere, const Motion& motion,
                                   SceneCastVisitor visitor, const SceneFaceOptions& options = {});
/// The same.
BOXTREE_API Result<Visit> cast_all(const Scene& scene, const Capsule& capsule, const Motion& motion,
                                   SceneCastVisitor visitor, const SceneFaceOptions& options = {});
/// The same.
BOXTREE_API Result<Visit> cast_all(const Scene& scene, const OrientedBox& box, const Motion& motion,
                                   SceneCastVisitor visitor, const SceneFaceOptions& options = {});
#if BOXTREE_HAS_HULL_QUERIES
/// The same.
BOXTREE_API Result<Visit> cast_all(const Scene& scene, const ConvexHull& hull, const Motion& motion,
                                   SceneCastVisitor visitor, const SceneFaceOptions& options = {});
#endif

/// Which edges of a triangle of an instance are active, as active_edges() of its tree tells it,
/// with bit i from corner i of Scene::triangle(face, half) on; but boundaries of the tree at which
/// the surface goes on in another instance, as both rest in the file, are not active. An instance
/// that moves, or was made movable, has the edges of its tree. Errors: also those of Scene::info().
[[nodiscard]] BOXTREE_API Result<std::uint32_t> active_edges(const Scene& scene,
                                                             const SceneFace& face,
                                                             std::uint32_t half = 0);

}  // namespace boxtree
