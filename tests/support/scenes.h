// SPDX-License-Identifier: MIT
// Scenes in memory, and brute force over all their placed triangles.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <boxtree/boxtree.h>

#include "cooker/encode/encoded_scene.h"
#include "cooker/write/file_writer.h"

namespace boxtree::test {

/// A file with a scene, and what it was made of.
struct CookedScene {
  std::vector<cooker::SourceMesh> meshes;  // one a tree
  cooker::SceneParts parts;
  std::vector<std::byte> bytes;
  File file;
};

/// Encodes each mesh in the codec at the same place of `codecs` (which repeat) and writes the
/// scene. Precondition: `parts` refers to these meshes; without layers it gets one.
[[nodiscard]] CookedScene cook_scene(std::vector<cooker::SourceMesh> meshes,
                                     cooker::SceneParts parts,
                                     const std::vector<CodecId>& codecs = {CodecId::kWide8});

/// An affine pose: turned, moved within `spread`, scaled by 1/2 to 2; `unevenly` also by another
/// factor on each axis, mirrored and sheared.
[[nodiscard]] Pose random_pose(std::mt19937_64& random, double spread, bool unevenly);

/// `count` instances of trees 0 to `trees` - 1, every `moving`-th of which moves, in `layers`
/// layers that all meet.
[[nodiscard]] cooker::SceneParts random_parts(std::uint32_t count, std::uint32_t trees,
                                              std::uint32_t moving, std::uint32_t layers,
                                              unsigned seed);

/// A point in the world: ((t + m0 x) + m1 y) + m2 z in double on each axis, as FORMAT.md says.
[[nodiscard]] Eigen::Vector3d placed(const Pose& pose, const Eigen::Vector3d& point);

/// A triangle of an instance in the world, from the source mesh.
struct WorldTriangle {
  std::uint32_t instance;  // number in the scene
  std::uint32_t id;        // of the instance
  std::uint32_t face;      // source face number
  Triangle triangle;
};

/// All triangles of all instances, at the poses that the scene has for them now.
[[nodiscard]] std::vector<WorldTriangle> world_triangles(const CookedScene& cooked,
                                                         const Scene& scene);

}  // namespace boxtree::test
