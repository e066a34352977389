// SPDX-License-Identifier: MIT
// Does the crate touch the stair, where a gap of some centimetres need not be told apart? Larger
// than both meshes, 16 leaves all undecided whose boxes meet.
//   overlap_within level.bxt crate.bxt
#include <cstdio>

#include <boxtree/boxtree.h>

const char* name(boxtree::Overlap overlap) {
  switch (overlap) {
    case boxtree::Overlap::kOverlapping:
      return "overlapping";
    case boxtree::Overlap::kDisjoint:
      return "disjoint";
    case boxtree::Overlap::kUndecided:
      return "undecided";
    case boxtree::Overlap::kBudgetSpent:
      return "budget spent";
  }
  return "";
}

int main(int argument_count, char** arguments) {
  if (argument_count != 3) {
    std::fputs("usage: overlap_within level.bxt crate.bxt\n", stderr);
    return 2;
  }
  const auto level_file = boxtree::File::open(arguments[1]);
  const auto crate_file = boxtree::File::open(arguments[2]);
  if (!level_file || !crate_file) return 1;
  const auto level = boxtree::Tree::bind(*level_file);
  const auto crate = boxtree::Tree::bind(*crate_file);
  if (!level || !crate) return 1;

  boxtree::Pose pose = boxtree::Pose::Identity();
  for (const double height : {0.375, 0.53125, 2.0}) {
    pose.translation() = Eigen::Vector3d(2.5, 0, height);
    for (const double within : {0.0, 0.0625, 16.0}) {
      const auto answer =
          boxtree::overlap_within(*level, boxtree::Pose::Identity(), *crate, pose, within);
      if (!answer) return 1;
      std::printf("height %g, within %g: %s\n", height, within, name(answer->overlap));
    }
  }
  return 0;
}
