// SPDX-License-Identifier: MIT
// Maps the cooked level and crate, finds the ground, and tests whether the crate touches the
// stairs.
#include <cstdio>
#include <string>

#include <boxtree/boxtree.h>

namespace {

boxtree::Result<boxtree::File> open(const char* name) {
  return boxtree::File::open(std::string(BOXTREE_ASSET_DIR "/") + name);
}

}  // namespace

int main() {
  const auto level_file = open("level.bxt");
  const auto crate_file = open("crate.bxt");
  if (!level_file || !crate_file) {
    std::puts("cooked files are missing");
    return 1;
  }
  const auto level = boxtree::Tree::bind(*level_file);
  const auto crate = boxtree::Tree::bind(*crate_file);
  if (!level || !crate) return 1;

  const auto ground = boxtree::closest_hit(*level, {{2.5, 0, 10}, {0, 0, -1}});
  if (!ground) return 1;
  std::printf("ground under (2.5, 0): height %g, face %u\n", ground->point[2], ground->face.id);

  boxtree::Pose pose = boxtree::Pose::Identity();
  for (const double height : {0.6, 0.5, 0.4}) {
    pose.translation() = Eigen::Vector3d(2.5, 0, height);
    const auto contact = boxtree::first_contact(*level, boxtree::Pose::Identity(), *crate, pose);
    if (!contact.ok()) return 1;
    std::printf("crate at height %g: %s\n", height, contact ? "touches" : "disjoint");
  }
  return 0;
}
