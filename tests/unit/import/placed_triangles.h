// SPDX-License-Identifier: MIT
// The triangles of a scene where its poses put them, in a form that compares with a flattened mesh.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include <Eigen/LU>

#include "cooker/import/source_scene.h"

namespace boxtree::cooker {

/// Three corners of three coordinates; the least corner first, the sense of rotation kept.
using PlacedTriangle = std::array<std::array<float, 3>, 3>;

/// Appends the triangles of `mesh`: transformed in double, rounded once, turned round by a mirror.
inline void append_placed(const SourceMesh& mesh, const Pose& pose,
                          std::vector<PlacedTriangle>& triangles) {
  const bool is_placed = pose.matrix() != Pose::Identity().matrix();
  const auto corner_of = [&](std::uint32_t vertex) {
    const Eigen::Vector3d v = mesh.positions[vertex];
    std::array<float, 3> placed{};
    for (int i = 0; i < 3; ++i) {
      const double along = pose(i, 0) * v[0] + pose(i, 1) * v[1] + pose(i, 2) * v[2] + pose(i, 3);
      placed[static_cast<std::size_t>(i)] = static_cast<float>(is_placed ? along : v[i]);
    }
    return placed;
  };
  const auto append = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    PlacedTriangle triangle = {corner_of(a), corner_of(b), corner_of(c)};
    if (pose.linear().determinant() < 0) std::swap(triangle[1], triangle[2]);
    std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()),
                triangle.end());
    triangles.push_back(triangle);
  };
  for (const Face& face : mesh.faces) {
    append(face.corner[0], face.corner[1], face.corner[2]);
    if (face.is_quad()) append(face.corner[0], face.corner[2], face.corner[3]);
  }
}

/// Of all instances, sorted.
inline std::vector<PlacedTriangle> placed_triangles(const SourceScene& scene) {
  std::vector<PlacedTriangle> triangles;
  for (const SceneInstance& instance : scene.instances) {
    append_placed(scene.meshes[instance.mesh].mesh, instance.pose, triangles);
  }
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

/// Of a flattened mesh, sorted.
inline std::vector<PlacedTriangle> placed_triangles(const SourceMesh& mesh) {
  std::vector<PlacedTriangle> triangles;
  append_placed(mesh, Pose::Identity(), triangles);
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

}  // namespace boxtree::cooker
