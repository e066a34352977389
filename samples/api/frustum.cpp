// SPDX-License-Identifier: MIT
// What does a camera see of the courtyard: which instances to draw, and which faces exactly?
//   frustum courtyard.bxt
#include <array>
#include <cstdio>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: frustum courtyard.bxt\n", stderr);
    return 2;
  }
  const auto file = boxtree::File::open(arguments[1]);
  boxtree::SceneOptions needs;
  needs.queries = boxtree::kBoxQueries;  // those of frustums belong to them
  needs.require_names = true;
  const auto scene = file ? boxtree::Scene::bind(*file, needs) : file.error();
  if (!scene) {
    std::fprintf(stderr, "%s\n", scene.error().message().c_str());
    return 1;
  }

  // A camera at height 10 that looks straight down, from 1 to 9 below itself, 0.1 to each side
  // there. Rows of projection * view; a matrix of an engine with row vectors is transposed first.
  boxtree::Frustum::ViewProjection matrix;
  matrix << 90, 0, 0, 45,         // 90 (x + 0.5)
      0, 0, -90, -405,            // -90 (z + 4.5)
      0, -9. / 8, 0, 9. / 8 * 9,  // depth: 0 at height 9, w at height 1
      0, -1, 0, 10;               // w: the distance below the camera
  const auto view = boxtree::Frustum::of(matrix, boxtree::ClipDepth::kZeroToOne);
  const auto drawn = boxtree::instances_in_frustum(*scene, view, [&](std::uint32_t instance) {
    const auto info = scene->info(instance);
    if (info) std::printf("draws %.*s\n", int(info->name.size()), info->name.data());
    return true;
  });

  // The same camera by its corners: around the near side, then those behind them.
  std::array<Eigen::Vector3d, 8> corners;
  for (std::size_t i = 0; i < 8; ++i) {
    const double depth = i < 4 ? 1 : 9, side = depth / 90;
    corners[i] = {-0.5 + (i % 4 == 0 || i % 4 == 3 ? -side : side), 10 - depth,
                  -4.5 + (i % 4 < 2 ? -side : side)};
  }
  int faces = 0;
  const auto seen = boxtree::overlap_frustum(*scene, boxtree::Frustum::of(corners),
                                             [&](const boxtree::SceneFace&) {
                                               ++faces;
                                               return true;
                                             });
  std::printf("sees %d faces\n", faces);
  return drawn && seen ? 0 : 1;
}
