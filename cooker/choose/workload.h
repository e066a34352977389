// SPDX-License-Identifier: MIT
// The queries that measurements run: seeded, the same on every machine and for every library.
#pragma once

#include <cstdint>
#include <vector>

#include <boxtree/ray.h>

namespace boxtree::cooker {

/// Number of queries of each kind.
struct WorkloadSize {
  std::size_t rays = 200'000;
  std::size_t boxes = 20'000;
  std::size_t points = 20'000;
  std::size_t poses = 200;
  std::size_t apart = 100;
  std::size_t camera = 0;  // pixels of a side, a multiple of 4
  std::size_t segments = 0;
  std::size_t lattice = 0;  // points of a side, a multiple of 4
};

/// What Workload::camera is, for texts.
inline constexpr const char* kCameraMeaning =
    "a camera at the diagonal's length from the middle, in tiles of 4 x 4 pixels";

/// What Workload::lattice is, for texts.
inline constexpr const char* kLatticeMeaning =
    "the points of a lattice over 1.2 times the bounds, in bricks of 4 x 2 x 2";

/// What Workload::boxes are, for texts.
inline constexpr const char* kBoxMeaning = "cubes with an edge of 5 % of the diagonal";

/// What Workload::poses are, for texts.
inline constexpr const char* kPoseMeaning =
    "a copy at 0.6, 0.8, 0.9 and 1.0 of the distance at which boxes touch";

struct Workload {
  /// From a sphere with twice the bounding radius toward random points of the bounds.
  std::vector<Ray> rays;
  /// kCameraMeaning.
  std::vector<Ray> camera;
  /// From random points of the bounds in random directions, to 2 % of the diagonal.
  std::vector<Ray> segments;
  /// Of spheres that are cast along the rays, 1 % of the diagonal.
  double cast_radius = 0;
  /// kBoxMeaning, with centres in the bounds.
  std::vector<Eigen::AlignedBox3d> boxes;
  /// In the bounds scaled by 1.2.
  std::vector<Eigen::Vector3d> points;
  /// kLatticeMeaning.
  std::vector<Eigen::Vector3d> lattice;
  /// Poses of a copy of the mesh with random rotations, in random directions, at 0.6, 0.8, 0.9 and
  /// 1.0 of the distance at which the mesh's bounding box and the copy's rotated one touch.
  std::vector<Pose> poses;
  /// The same at 1.05, 1.2, 1.5 and 2 of that distance: mesh and copy do not touch.
  std::vector<Pose> apart;
};

/// Queries for a mesh with these bounds (object space). Deterministic.
[[nodiscard]] Workload make_workload(const Eigen::AlignedBox3d& bounds, const WorkloadSize& size,
                                     std::uint64_t seed = 1);

/// The tumble protocol (Zachmann, "Optimizing the Collision Detection Pipeline", 2003; P1): the
/// mesh against its copy, both centred. `distance` of the centres is along x, in units of the
/// largest half extent; the copy turns through `steps` angles about both z and x.
[[nodiscard]] std::vector<Pose> tumble_poses(const Eigen::AlignedBox3d& bounds, double distance,
                                             std::size_t steps);

}  // namespace boxtree::cooker
