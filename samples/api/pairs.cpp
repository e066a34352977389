// SPDX-License-Identifier: MIT
// Does the crate touch the stair, and where?
//   pairs level.bxt crate.bxt
#include <cstdio>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 3) {
    std::fputs("usage: pairs level.bxt crate.bxt\n", stderr);
    return 2;
  }
  const auto level_file = boxtree::File::open(arguments[1]);
  const auto crate_file = boxtree::File::open(arguments[2]);
  if (!level_file || !crate_file) return 1;
  const auto level = boxtree::Tree::bind(*level_file);
  const auto crate = boxtree::Tree::bind(*crate_file);
  if (!level || !crate) return 1;

  const boxtree::Pose here = boxtree::Pose::Identity();
  boxtree::Pose pose = here;
  for (const double height : {0.625, 0.5, 0.375}) {
    pose.translation() = Eigen::Vector3d(2.5, 0, height);
    int pairs = 0;
    const auto visit =
        boxtree::overlap_pairs(*level, here, *crate, pose, [&](const boxtree::FacePair&) {
          ++pairs;
          return true;
        });
    const auto contact = boxtree::first_contact(*level, here, *crate, pose);
    if (!visit || !contact.ok()) return 1;
    std::printf("height %g: %d pairs, %s\n", height, pairs, contact ? "touches" : "free");
  }
  return 0;
}
