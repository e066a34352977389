// SPDX-License-Identifier: MIT
// How far is the crate above the stair, and between which points?
//   distance level.bxt crate.bxt
#include <cstdio>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 3) {
    std::fputs("usage: distance level.bxt crate.bxt\n", stderr);
    return 2;
  }
  const auto level_file = boxtree::File::open(arguments[1]);
  const auto crate_file = boxtree::File::open(arguments[2]);
  if (!level_file || !crate_file) return 1;
  const auto level = boxtree::Tree::bind(*level_file);
  const auto crate = boxtree::Tree::bind(*crate_file);
  if (!level || !crate) return 1;

  boxtree::Pose pose = boxtree::Pose::Identity();
  pose.translation() = Eigen::Vector3d(2.5, 0, 1);
  const auto exact = boxtree::distance(*level, boxtree::Pose::Identity(), *crate, pose);
  if (!exact || !exact->witness) return 1;
  std::printf("%.6f, from face %u to face %u\n", exact->upper, exact->witness->faces.first.id,
              exact->witness->faces.second.id);

  // Bounds that hold, as soon as they are within a tenth or ten pairs of nodes are expanded.
  const auto rough = boxtree::distance(*level, boxtree::Pose::Identity(), *crate, pose,
                                       {.relative_error = 0.1, .node_budget = 10});
  if (!rough) return 1;
  std::printf("between %.3f and %.3f\n", rough->lower, rough->upper);
  return 0;
}
