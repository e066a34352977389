// SPDX-License-Identifier: MIT
// Boxes, spheres and points in the scene of any file.
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {

void run(Bytes input) {
  query_scene(input, [](const Scene& scene, const Question& question, const auto& check) {
    const LayerMask layers = question.option(1) == 0 ? kAllLayers : question.option(1);
    const Eigen::Vector3d at = question.vector(0);
    const auto all = [](const SceneFace&) { return true; };
    switch (question.option(2) % 3) {
      case 0:
        check(overlap_box(scene, {at, at + question.vector(3).cwiseAbs()}, all, layers,
                          question.limits()));
        break;
      case 1:
        check(overlap_sphere(scene, at, question.number(3), all, layers, question.limits()));
        break;
      default:
        check(closest_point(scene, at, std::numeric_limits<double>::infinity(), layers,
                            question.limits()));
    }
  });
}

}  // namespace boxtree::fuzz
