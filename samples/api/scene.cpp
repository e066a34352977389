// SPDX-License-Identifier: MIT
// What is below a point of the courtyard, what does the crate meet when it is put down there, and
// how far from the nearest is it two higher?
//   scene level.bxt
#include <cstdio>
#include <set>
#include <string_view>

#include <boxtree/boxtree.h>

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: scene level.bxt\n", stderr);
    return 2;
  }
  const auto file = boxtree::File::open(arguments[1]);
  boxtree::SceneOptions needs;
  needs.queries = boxtree::kRayQueries | boxtree::kPairQueries;  // refused here if left out
  needs.require_names = true;
  auto scene = file ? boxtree::Scene::bind(*file, needs) : file.error();
  if (!scene) {
    std::fprintf(stderr, "%s\n", scene.error().message().c_str());
    return 1;
  }

  const auto hit = boxtree::closest_hit(*scene, {{-0.5, 10, -4.5}, {0, -1, 0}});
  const auto crate = scene->find_instance("Crate");
  if (!hit || !crate || !scene->make_movable(*crate)) return 1;
  const auto below = scene->info(hit->instance);
  if (!below) return 1;
  std::printf("%.*s at height %.3f\n", int(below->name.size()), below->name.data(), hit->point[1]);

  boxtree::Pose pose = boxtree::Pose::Identity();
  pose.translation() = hit->point;
  std::set<std::string_view> names;
  if (!scene->update(*crate, pose)) return 1;
  const auto visit = boxtree::contacts(*scene, [&](const boxtree::ScenePair& pair) {
    if (const auto info = scene->info(pair.second.instance)) names.insert(info->name);
    return true;
  });
  for (const std::string_view name : names)
    std::printf("meets %.*s\n", int(name.size()), name.data());
  if (!visit) return 1;

  pose.translation()[1] += 2;
  if (!scene->update(*crate, pose)) return 1;
  const auto apart = boxtree::distance_of(*scene, *crate);
  if (!apart || !apart->witness) return 1;
  const auto nearest = scene->info(apart->witness->faces.second.instance);
  if (!nearest) return 1;
  std::printf("%.3f from %.*s\n", apart->upper, int(nearest->name.size()), nearest->name.data());
  return 0;
}
