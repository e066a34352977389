// SPDX-License-Identifier: MIT
// Splits and scales a source mesh.
#include "tests/bench/triangle_mesh.h"

#include <utility>

namespace boxtree::bench {

TriangleMesh make_triangle_mesh(const cooker::SourceMesh& mesh, std::string name,
                                double longest_edge) {
  TriangleMesh out;
  out.name = std::move(name);
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) out.bounds.extend(mesh.positions[i]);
  const double scale = longest_edge > 0 ? longest_edge / out.bounds.sizes().maxCoeff() : 1.0;
  out.bounds.setEmpty();
  out.source.name = out.name;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    const Eigen::Vector3f position = (mesh.positions[i] * scale).cast<float>();
    out.positions.push_back(position);
    out.bounds.extend(position.cast<double>());
    for (Eigen::Index k = 0; k < 3; ++k) out.source.positions.f32.push_back(position[k]);
  }
  for (const cooker::Face& face : mesh.faces) {
    for (std::size_t last = 2; last < (face.is_quad() ? 4u : 3u); ++last) {
      out.triangles.push_back({face.corner[0], face.corner[last - 1], face.corner[last]});
      out.source.faces.push_back(
          {{face.corner[0], face.corner[last - 1], face.corner[last], cooker::kNoCorner}});
    }
  }
  return out;
}

}  // namespace boxtree::bench
