// SPDX-License-Identifier: MIT
// Runs every query of a scene: on a runtime of one codec, of the paper, it has to link all the
// same.
#include <cstdio>

#include <boxtree/boxtree.h>
#include <boxtree/paper.h>

int main(int, char** argv) {
  using namespace boxtree;
  use_paper_codecs();
  const auto file = File::open(argv[1]);
  if (!file) return std::puts(file.error().detail.c_str()), 1;
  const auto scene = Scene::bind(*file);
  if (!scene) return std::puts(scene.error().detail.c_str()), 1;
  const auto hit = closest_hit(*scene, Ray{{0, 0, 10}, {0, 0, -1}});
  if (!hit) return 1;
  int faces = 0;
  const auto count = [&faces](const SceneFace&) { return ++faces > 0; };
  const auto box =
      overlap_box(*scene, {Eigen::Vector3d(-1, -1, 0), Eigen::Vector3d(1, 1, 2)}, count);
  const auto sphere = overlap_sphere(*scene, {0, 0, 0}, 1, count);
  const auto point = closest_point(*scene, {0, 0, 0});
  const auto touching = contacts(*scene, [](const ScenePair&) { return true; });
  if (!box || !sphere || !point || !touching) return 1;
  std::printf("t %g, face %u, %d faces, distance %g\n", hit->t, hit->face.id, faces,
              point->distance);
}
