// SPDX-License-Identifier: MIT
// A character walks through the courtyard and up the stairs. A sphere keeps it away from walls; a
// ray keeps its feet on the ground and finds the material below.
//   walk_level level.bxt
#include <algorithm>
#include <cstdio>
#include <string>

#include <boxtree/boxtree.h>

namespace {

using Eigen::Vector3d;

constexpr double kStride = 0.05;     // metres per frame
constexpr double kRadius = 0.35;     // of the character
constexpr double kStepHeight = 0.3;  // largest step that it climbs without a jump
constexpr double kWaist = kStepHeight + kRadius;

// Whether a character with its feet there touches anything higher than a step.
bool is_blocked(const boxtree::Scene& scene, const Vector3d& feet) {
  bool blocked = false;
  const auto visit = boxtree::overlap_sphere(scene, feet + Vector3d(0, kWaist, 0), kRadius,
                                             [&](const boxtree::SceneFace&) {
                                               blocked = true;
                                               return false;  // one is enough
                                             });
  return !visit || blocked;
}

}  // namespace

int main(int argument_count, char** arguments) {
  if (argument_count != 2) {
    std::fputs("usage: walk_level LEVEL.bxt\n", stderr);
    return 1;
  }
  const auto file = boxtree::File::open(arguments[1]);
  if (!file) {
    std::fprintf(stderr, "%s\n", file.error().message().c_str());
    return 1;
  }
  boxtree::SceneOptions needs;  // bind() fails with the profile's line if the level lacks these
  needs.queries = boxtree::kRayQueries | boxtree::kBoxQueries;
  needs.require_materials = needs.require_names = true;
  const auto scene = boxtree::Scene::bind(*file, needs);
  if (!scene) {
    std::fprintf(stderr, "%s\n", scene.error().message().c_str());
    return 1;
  }

  // From the gate to the pillar in the way, around it, and up the stairs.
  const Vector3d way[] = {{0.5, 0, 11}, {0.5, 0, 2}, {0, 0, -2.4}, {0, 0, -7}, {9, 0, -7}};
  Vector3d feet = way[0];
  std::string ground;
  int blocked = 0;
  for (const Vector3d& goal : way) {
    while (blocked < 40) {
      const Vector3d ahead(goal[0] - feet[0], 0, goal[2] - feet[2]);
      if (ahead.norm() < kStride) break;
      Vector3d next = feet + kStride * ahead.normalized();
      const auto hit = boxtree::closest_hit(
          *scene, {next + Vector3d(0, kStepHeight, 0), Vector3d(0, -1, 0), 0, 10});
      if (!hit) break;  // the end of the level
      next[1] += kStepHeight - hit->t;
      if (is_blocked(*scene, next)) {
        if (++blocked == 40)
          std::printf("blocked at (%.2f, %.2f, %.2f)\n", feet[0], feet[1], feet[2]);
        continue;
      }
      feet = next;
      const auto material = scene->material({hit->instance, hit->face});
      const std::string now = std::string(scene->material_name(material)) + " of " +
                              std::string(scene->info(hit->instance)->name);
      if (now != ground) {
        ground = now;
        std::printf("(%6.2f, %5.2f, %6.2f) on %s\n", feet[0], feet[1], feet[2], ground.c_str());
      }
    }
  }
  std::printf("ends at height %.2f\n", feet[1]);
  return 0;
}
