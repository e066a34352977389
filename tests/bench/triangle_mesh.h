// SPDX-License-Identifier: MIT
// The mesh that every library receives: only triangles, f32 positions.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "cooker/import/source_mesh.h"
#include "runtime/primitive/triangle.h"

namespace boxtree::bench {

/// The same triangles in two forms: for the cooker, and as plain arrays for other libraries.
struct TriangleMesh {
  std::string name;
  cooker::SourceMesh source;  // quads split, no face ids: face i is triangle i
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

/// `longest_edge`: size of the scaled bounds; 0 leaves every coordinate unchanged.
[[nodiscard]] TriangleMesh make_triangle_mesh(const cooker::SourceMesh& mesh, std::string name,
                                              double longest_edge);

}  // namespace boxtree::bench
