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

    // Where: of each two triangles a point, the ends of what they share, a normal and a depth. They
    // know no active edges; contacts of shapes do (collide.cpp).
    Eigen::AlignedBox3d where;
    const auto all = boxtree::pair_contacts(*level, here, *crate, pose,
                                            [&](const boxtree::PairContact& of_triangles) {
                                              where.extend(of_triangles.start);
                                              where.extend(of_triangles.end);
                                              return true;
                                            });
    if (!all) return 1;
    if (contact) {
      std::printf("  at x %g to %g, y %g to %g, z %g to %g\n", where.min()[0], where.max()[0],
                  where.min()[1], where.max()[1], where.min()[2], where.max()[2]);
    }
  }
  return 0;
}
