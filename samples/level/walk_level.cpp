// SPDX-License-Identifier: MIT
// A character walks through the courtyard, climbs the stairs and slides along what is in its way:
// a capsule that is cast up, ahead and down each frame. The material below makes the sound of its
// steps.
//   walk_level level.bxt
#include <algorithm>
#include <cstdio>
#include <string>

#include <boxtree/boxtree.h>

namespace {

using boxtree::SceneCastHit;
using Eigen::Vector3d;

constexpr double kStride = 0.05;  // metres per frame
constexpr double kRadius = 0.35;
constexpr double kHeight = 1.8;
constexpr double kStepHeight = 0.3;  // the largest step that it climbs without a jump
constexpr double kSkin = 0.01;       // kept along its way; less from a face at a grazing angle
constexpr double kSteepest = 0.7;    // the least height of a normal on which it stands

class Character {
 public:
  Character(const boxtree::Scene& scene, const Vector3d& feet) : scene_(scene), feet_(feet) {}

  [[nodiscard]] const Vector3d& feet() const { return feet_; }

  // One frame. Returns what it stands on; nothing above the end of the level.
  boxtree::SceneCastResult walk(const Vector3d& ahead) {
    const Vector3d start = feet_;
    static_cast<void>(move({0, kStepHeight, 0}));
    const double climbed = feet_[1] - start[1];
    slide(ahead);
    boxtree::SceneCastResult ground = move({0, -climbed - kStepHeight, 0});
    if (ground && is_ground(*ground)) return ground;
    // Up there is no ground: along the ground then, and down.
    feet_ = start;
    slide(ahead);
    ground = move({0, -10, 0});
    if (!ground) feet_ = start;
    return ground;
  }

 private:
  // The edge of a step pushes back aslant, and is one to stand on.
  static bool is_ground(const SceneCastHit& hit) {
    return hit.feature != boxtree::Feature::kFace || hit.normal[1] >= kSteepest;
  }

  // Moves along `way` until something is in the way, and returns it. At t_lower the body touches
  // nothing, whatever has been rounded.
  boxtree::SceneCastResult move(const Vector3d& way) {
    const double length = way.norm();
    if (length == 0) return {};
    const Vector3d low(0, kSkin + kRadius, 0), high(0, kHeight - kRadius, 0);
    const boxtree::Capsule body{feet_ + low, feet_ + high, kRadius};
    boxtree::SceneCastResult hit =
        boxtree::cast_closest(scene_, body, {.direction = way, .t_max = 1 + kSkin / length});
    const double part = hit ? std::max(0.0, hit->t_lower - kSkin / length) : 1;
    feet_ += std::min(part, 1.0) * way;
    return hit;
  }

  // Moves ahead and along what is in the way.
  void slide(Vector3d way) {
    for (int i = 0; i < 4; ++i) {
      const Vector3d before = feet_;
      const boxtree::SceneCastResult hit = move(way);
      if (!hit) return;
      way -= feet_ - before;
      const Vector3d wall = Vector3d(hit->normal[0], 0, hit->normal[2]).normalized();
      way -= std::min(0.0, way.dot(wall)) * wall;
    }
  }

  const boxtree::Scene& scene_;
  Vector3d feet_;
};

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
  needs.queries = boxtree::kRayQueries;
  needs.require_materials = needs.require_names = true;
  const auto scene = boxtree::Scene::bind(*file, needs);
  if (!scene) {
    std::fprintf(stderr, "%s\n", scene.error().message().c_str());
    return 1;
  }

  // From the gate up the stairs, and down again over what is in the way.
  const Vector3d way[] = {{0.5, 1, 11}, {0.5, 0, 2}, {0, 0, -2.4}, {0, 0, -7}, {9, 0, -7}};
  Character character(*scene, way[0]);
  std::string ground;
  int blocked = 0;
  for (const Vector3d& goal : way) {
    while (blocked < 40) {
      const Vector3d before = character.feet();
      const Vector3d ahead(goal[0] - before[0], 0, goal[2] - before[2]);
      if (ahead.norm() < kStride) break;
      const auto below = character.walk(kStride * ahead.normalized());
      if (!below) break;  // the end of the level
      const Vector3d& feet = character.feet();
      if ((feet - before).norm() < kStride / 10 && ++blocked == 40) {
        std::printf("blocked at (%.2f, %.2f, %.2f)\n", feet[0], feet[1], feet[2]);
      }
      const auto material = scene->material({below->instance, below->face});
      const std::string now = std::string(scene->material_name(material)) + " of " +
                              std::string(scene->info(below->instance)->name);
      if (now != ground) {
        ground = now;
        std::printf("(%6.2f, %5.2f, %6.2f) on %s\n", feet[0], feet[1], feet[2], ground.c_str());
      }
    }
  }
  std::printf("ends at height %.2f\n", character.feet()[1]);
  return 0;
}
