// SPDX-License-Identifier: MIT
// What is below a point, and what does a crate stand on, in a scene of trees of several files?
//   assemble level.bxt crate.bxt
#include <cstdio>
#include <vector>

#include <boxtree/boxtree.h>

namespace {

boxtree::Pose at(double x, double y, double z) {
  return boxtree::Pose(Eigen::Translation3d(x, y, z));
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 3) {
    std::fputs("usage: assemble level.bxt crate.bxt\n", stderr);
    return 2;
  }
  const auto level = boxtree::File::open(arguments[1]), crate = boxtree::File::open(arguments[2]);
  std::vector<boxtree::Tree> trees;
  for (const auto* file : {&level, &crate}) {  // the files must outlive the scene
    const auto tree = *file ? boxtree::Tree::bind(**file) : file->error();
    if (!tree) {
      std::fprintf(stderr, "%s\n", tree.error().message().c_str());
      return 1;
    }
    trees.push_back(*tree);
  }

  // Two tiles of ground side by side, and two crates on them, one of which moves.
  constexpr std::uint32_t kGround = 0, kThings = 1;
  const std::vector<boxtree::PlacedTree> placed = {
      {.tree = 0, .layer = kGround, .name = "West"},
      {.tree = 0, .pose = at(8, 0, 0), .layer = kGround, .name = "East"},
      {.tree = 1, .pose = at(-2, 0, 0), .layer = kThings, .user_data = 42, .name = "Chest"},
      {.tree = 1, .pose = at(6, 0, 2), .layer = kThings, .moves = true, .name = "Crate"}};
  const std::vector<boxtree::SceneLayer> layers = {{.name = "ground"}, {.name = "things"}};
  auto scene = boxtree::Scene::assemble(trees, placed, layers);
  if (!scene) {
    std::fprintf(stderr, "%s\n", scene.error().message().c_str());
    return 1;
  }

  // Answers name an instance as it is numbered in `placed`.
  const auto hit = boxtree::closest_hit(*scene, {{-2, 0, 10}, {0, 0, -1}});
  if (!hit) return 1;
  std::printf("height %.1f: %s, user data %llu\n", hit->point[2], placed[hit->instance].name.data(),
              static_cast<unsigned long long>(scene->user_data(hit->instance)));
  const boxtree::LayerMask ground = boxtree::LayerMask{1} << kGround;
  const auto below = boxtree::closest_hit(*scene, {{-2, 0, 10}, {0, 0, -1}}, ground);
  if (!below) return 1;
  std::printf("below it: %s\n", placed[below->instance].name.data());

  // The crate is put down; whoever is moved is found where it is.
  if (!scene->update(3, at(6, 0, 0))) return 1;
  const auto visit = boxtree::contacts(*scene, [&](const boxtree::ScenePair& pair) {
    std::printf("%s touches %s\n", placed[pair.first.instance].name.data(),
                placed[pair.second.instance].name.data());
    return false;  // the first is enough
  });
  return visit ? 0 : 1;
}
