// SPDX-License-Identifier: MIT
// Drops the moving crate of the level frame by frame and stops it at its first contacts. Poses
// change at run time; the mapped file is never written.
//   drop_crate level.bxt
#include <cstdio>
#include <set>
#include <string>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: drop_crate LEVEL.bxt\n", stderr);
    return 1;
  }
  const auto file = boxtree::File::open(arguments[1]);
  if (!file) {
    std::fprintf(stderr, "%s\n", file.error().message().c_str());
    return 1;
  }
  boxtree::SceneOptions needs;
  needs.queries = boxtree::kPairQueries;
  auto scene = boxtree::Scene::bind(*file, needs);
  if (!scene) {
    std::fprintf(stderr, "%s\n", scene.error().message().c_str());
    return 1;
  }
  const auto crate = scene->find_instance("Crate");
  const auto start = crate ? scene->pose(*crate) : crate.error();
  if (!start || !scene->info(*crate)->moves) {
    std::fputs("the level has no crate that moves\n", stderr);
    return 1;
  }

  // Falls until the first contact, then halves the last step until the gap is a tenth of a
  // millimetre.
  boxtree::Pose pose = *start;
  double speed = 0, frame = 1.0 / 60;
  int frames = 0, queries = 0;
  std::set<std::string> met;
  while (frames < 600) {
    const double fall = (speed + 9.81 * frame / 2) * frame;
    boxtree::Pose next = pose;
    next.translation()[1] -= fall;
    if (!scene->update(*crate, next)) return 1;
    std::set<std::string> touched;
    const auto visit = boxtree::contacts(*scene, [&](const boxtree::ScenePair& pair) {
      touched.insert(std::string(scene->info(pair.second.instance)->name));
      return true;
    });
    if (!visit) return 1;
    ++queries;
    if (touched.empty()) {
      pose = next;
      speed += 9.81 * frame;
      ++frames;
      continue;
    }
    met = touched;
    if (fall < 1e-4) break;
    frame /= 2;
  }
  std::printf("after %d frames and %d queries the crate rests at height %.4f on", frames, queries,
              pose.translation()[1]);
  for (const std::string& name : met) std::printf(" \"%s\"", name.c_str());
  std::printf("\n");
  return met.empty() ? 1 : 0;
}
