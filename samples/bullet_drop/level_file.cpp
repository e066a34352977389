// SPDX-License-Identifier: MIT
// Converts the application's arrays to the cooker's mesh, and to Bullet's.
#include "samples/bullet_drop/level_file.h"

namespace bullet_drop {

boxtree::Status cook_level(const Level& level, const std::filesystem::path& path,
                           const boxtree::cooker::CookOptions& options) {
  boxtree::cooker::SourceMesh mesh;
  mesh.name = "level";
  mesh.positions.f32 = level.positions;
  for (const auto& t : level.triangles) {
    mesh.faces.push_back({{t[0], t[1], t[2], boxtree::cooker::kNoCorner}});
  }
  auto cooked = boxtree::cooker::cook_mesh(mesh, options);
  if (!cooked) return cooked.error();
  const auto written = boxtree::cooker::write_file(path, {std::span(&cooked->tree, 1), {}});
  return written ? boxtree::Status() : boxtree::Status(written.error());
}

btTriangleIndexVertexArray arrays_of(Level& level) {
  return {static_cast<int>(level.triangles.size()),
          reinterpret_cast<int*>(level.triangles.data()),
          static_cast<int>(sizeof(level.triangles.front())),
          static_cast<int>(level.positions.size() / 3),
          level.positions.data(),
          static_cast<int>(3 * sizeof(float))};
}

}  // namespace bullet_drop
