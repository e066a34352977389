// SPDX-License-Identifier: MIT
// Scenes assembled of the trees of any file, in any poses, layers and with any names, changed and
// queried.
#include <array>
#include <string>
#include <vector>

#include "tests/fuzz/answers.h"
#include "tests/fuzz/frustum_input.h"
#include "tests/fuzz/shape_input.h"
#include "tests/fuzz/tree_target.h"

namespace boxtree::fuzz {
namespace {

std::vector<Tree> trees_of(const File& file) {
  std::vector<Tree> trees;
  for (std::uint32_t i = 0; i < std::min(file.tree_count(), 3u); ++i) {
    Result<Tree> tree = Tree::bind(file, i);
    if (tree.code() == Errc::kExternalMeshNeeded) tree = Tree::bind(file, i, external_arrays());
    if (tree) trees.push_back(*tree);
  }
  return trees;
}

std::vector<PlacedTree> placed(const QueryInput& query, std::size_t trees) {
  std::vector<PlacedTree> instances(query.option(7) % 6);
  for (std::size_t i = 0; i < instances.size(); ++i) {
    PlacedTree& instance = instances[i];
    instance.tree = static_cast<std::uint32_t>(i % std::max<std::size_t>(trees, 1));
    instance.moves = query.option(10) >> i & 1u;
    instance.layer = i % 2 == 0 ? 0 : query.option(9) % 40u;
    if (i == 1) instance.pose = query.pose();
    if (i > 1) instance.pose.translation() = static_cast<double>(i) * query.vector(9);
    if (i == 2 && query.option(11) == 255) instance.tree = 7;
    if (i == 3) instance.name = "named";
  }
  return instances;
}

void query_scene_once(const Scene& scene, const QueryInput& query, const Check& check) {
  const Filters filters(query);
  const SceneFaceOptions options = scene_face_options(query, filters);
  switch (query.option(8) % 6) {
    case 0: {
      const auto hit = closest_hit(scene, Ray{query.vector(0), query.vector(3)}, options);
      check(hit);
      if (hit) read_face(scene, {hit->instance, hit->face}, hit->triangle, check);
      return;
    }
    case 1:
      return with_shape(query, [&](const auto& shape) {
        const auto hit = cast_closest(scene, shape, {query.vector(3)}, options);
        check(hit);
        if (!hit) return;
        check_hit(*hit, query, check);
        read_face(scene, {hit->instance, hit->face}, hit->triangle, check);
      });
    case 2:
      return with_shape(query, [&](const auto& shape) {
        check(collide(
            scene, shape,
            [&](const SceneContact& contact) {
              check_contact(contact, query, check);
              return true;
            },
            options.layers, options.limits));
      });
    case 3:
      return check(pair_contacts(
          scene,
          [&](const ScenePairContact& contact) {
            check_contact(contact, check);
            return true;
          },
          options.limits));
    case 4:
      return check(overlap_frustum(
          scene, frustum_of(query), [](const SceneFace&) { return true; }, options.layers,
          options.limits));
    default:
      check(closest_point(scene, query.vector(0), std::numeric_limits<double>::infinity(),
                          options.layers, options.limits));
  }
}

}  // namespace

void run(Bytes bytes) {
  const Input input(bytes);
  const Result<File> file = File::open(input.file());
  if (!file) return;
  const std::vector<Tree> trees = trees_of(*file);
  const std::vector<PlacedTree> instances = placed(input.query, trees.size());
  const std::array<SceneLayer, 2> layers{SceneLayer{"ground", ~0u, kAllQueries},
                                         SceneLayer{"", input.query.option(5), kAllQueries}};
  const Check check(*file, external_arrays().mesh);
  Result<Scene> scene =
      Scene::assemble(trees, instances, std::span(layers).first(input.query.option(4) % 3u));
  if (!scene) {
    if (scene.code() == Errc::kInternal) finding("assemble ends with kInternal");
    return;
  }
  if (scene->instance_count() != instances.size()) finding("a scene of other instances");
  if (input.query.option(12) % 4 >= 2) change_scene(*scene, input.query, check);
  query_scene_once(*scene, input.query, check);
}

}  // namespace boxtree::fuzz
