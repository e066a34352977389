// SPDX-License-Identifier: MIT
// The mesh that every library is given: triangles alone, f32 positions.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "cooker/import/source_mesh.h"
#include "runtime/primitive/triangle.h"

namespace boxtree::bench {

/// The same triangles twice: as the cooker takes them and as plain arrays for others.
struct TriangleMesh {
  std::string name;
  cooker::SourceMesh source;  // quads split, face ids left out: face i is triangle i
  std::vector<Eigen::Vector3f> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  Eigen::AlignedBox3d bounds;

  [[nodiscard]] Triangle triangle(std::size_t i) const {
    const auto corner = [&](std::size_t c) {
      return Eigen::Vector3d(positions[triangles[i][c]].cast<double>());
    };
    return {{corner(0), corner(1), corner(2)}};
  }
};

/// `longest_edge`: size of the bounds to scale to, 0 to leave every coordinate alone.
[[nodiscard]] TriangleMesh make_triangle_mesh(const cooker::SourceMesh& mesh, std::string name,
                                              double longest_edge);

}  // namespace boxtree::bench
