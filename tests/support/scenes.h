// SPDX-License-Identifier: MIT
// Scenes in memory, and brute force over all their placed triangles.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <boxtree/boxtree.h>

#include "cooker/cook.h"
#include "cooker/encode/encoded_scene.h"
#include "cooker/write/file_writer.h"

namespace boxtree::test {

/// A file with a scene, and the inputs it was made from.
struct CookedScene {
  std::vector<cooker::SourceMesh> meshes;  // one per tree
  cooker::SceneParts parts;
  std::vector<std::byte> bytes;
  File file;
};

/// Encodes each mesh with the codec at the same index of `codecs` (which repeat) and writes the
/// scene. Trees on a grid share it. Precondition: `parts` refers to these meshes; if it has no
/// layers, one is added.
[[nodiscard]] CookedScene cook_scene(std::vector<cooker::SourceMesh> meshes,
                                     cooker::SceneParts parts,
                                     const std::vector<CodecId>& codecs = {CodecId::kWide8},
                                     const cooker::CookOptions& options = {});

/// A random affine pose: a rotation, a translation within `spread`, and a scale of 1/2 to 2; with
/// `unevenly` also a separate scale per axis, a mirror and a shear.
[[nodiscard]] Pose random_pose(std::mt19937_64& random, double spread, bool unevenly);

/// Poses that leave nothing of a tree's space to rely on: all but flat, far away, tiny in a huge
/// world, huge in a tiny one.
[[nodiscard]] std::vector<Pose> extreme_poses();

/// `count` instances of trees 0 to `trees` - 1 in `layers` layers that all collide; every
/// `moving`-th instance moves.
[[nodiscard]] cooker::SceneParts random_parts(std::uint32_t count, std::uint32_t trees,
                                              std::uint32_t moving, std::uint32_t layers,
                                              unsigned seed);

/// A point in the world: ((t + m0 x) + m1 y) + m2 z in double on each axis, as in FORMAT.md.
[[nodiscard]] Eigen::Vector3d placed(const Pose& pose, const Eigen::Vector3d& point);

/// A triangle of an instance in the world, computed from the source mesh.
struct WorldTriangle {
  std::uint32_t instance;  // number in the scene
  std::uint32_t id;        // of the instance
  std::uint32_t face;      // source face number
  Triangle triangle;
};

/// All triangles of all instances, at the scene's current poses.
[[nodiscard]] std::vector<WorldTriangle> world_triangles(const CookedScene& cooked,
                                                         const Scene& scene);

}  // namespace boxtree::test
