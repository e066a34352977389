// SPDX-License-Identifier: MIT
// Boxes, spheres, frustums and points in the scene of any file.
#include "tests/fuzz/frustum_input.h"
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_scene(input, [](const Scene& scene, const QueryInput& query, const auto& check) {
    const LayerMask layers = query.option(1) == 0 ? kAllLayers : query.option(1);
    const Eigen::Vector3d at = query.vector(0);
    const auto all = [](const SceneFace&) { return true; };
    switch (query.option(2) % 4) {
      case 0:
        check(
            overlap_box(scene, {at, at + query.vector(3).cwiseAbs()}, all, layers, query.limits()));
        break;
      case 1:
        check(overlap_sphere(scene, at, query.number(3), all, layers, query.limits()));
        break;
      case 3: {
        const Frustum frustum = frustum_of(query);
        const bool of_faces = query.option(3) % 2 == 0;
        check(of_faces ? overlap_frustum(scene, frustum, all, layers, query.limits())
                       : instances_in_frustum(
                             scene, frustum, [](std::uint32_t) { return true; }, layers,
                             query.limits()));
        break;
      }
      default:
        check(closest_point(scene, at, std::numeric_limits<double>::infinity(), layers,
                            query.limits()));
    }
  });
}

}  // namespace boxtree::fuzz
