// SPDX-License-Identifier: MIT
// What targets that query one tree or a scene share: the file is opened, its first tree or its
// scene bound, and what the query says held against what `verify` says.
#pragma once

#include <algorithm>

#include "cooker/import/mesh_arrays.h"
#include "tests/fuzz/query_input.h"
#include "tests/fuzz/target.h"
#include "tests/support/meshes.h"

namespace boxtree::fuzz {

/// Arrays for files with external geometry: those of the seed.
inline BindOptions external_arrays() {
  static const cooker::SourceMesh mesh = test::city(2, 1);
  BindOptions options;
  options.mesh = cooker::arrays_of(mesh);
  return options;
}

/// Calls query(tree, query, check) when the file of the input opens and binds; `check` takes
/// each Result of a query.
template <class Query>
void query_tree(Bytes bytes, const Query& query) {
  const Input input(bytes);
  const Result<File> file = File::open(input.file());
  if (!file) return;
  Result<Tree> tree = Tree::bind(*file);
  if (tree.code() == Errc::kExternalMeshNeeded) tree = Tree::bind(*file, external_arrays());
  if (tree.code() == Errc::kExternalMeshMismatch) return;
  const Check check(*file, external_arrays().mesh);
  if (!tree) return check(tree);
  if (input.query.option(13) % 4 == 1) tree = tree->without_duplicates();
  if (input.query.option(13) % 4 == 2) tree->prefetch(input.query.option(12));
  query(*tree, input.query, check);
}

/// Sends moving instances of a scene elsewhere, and changes what else an application may.
inline void change_scene(Scene& scene, const QueryInput& query, const Check& check) {
  const std::uint32_t count = std::min(scene.instance_count(), 8u);
  if (query.option(13) % 4 >= 2) check(scene.make_movable(query.option(10)));
  for (std::uint32_t i = 0; i < count; ++i) check(scene.update(i, query.pose()));
  if (query.option(13) % 2 == 1) scene.rebuild();
  if (query.option(13) % 8 >= 4) {
    check(scene.set_enabled(query.option(9), false));
    check(scene.set_user_data(query.option(9), 1));
  }
  for (std::uint32_t i = 0; i < count; ++i) {
    const Result<InstanceInfo> info = scene.info(i);
    check(info);
    check(scene.pose(i));
    if (info) check(scene.find_instance(info->name));
    if (info) static_cast<void>(scene.layer_name(info->layer));
  }
}

/// Calls query(scene, query, check) with the scene of the file, changed first if the query says so.
template <class Query>
void query_scene(Bytes bytes, const Query& query) {
  const Input input(bytes);
  const Result<File> file = File::open(input.file());
  if (!file || !file->has_scene()) return;
  const Check check(*file);
  SceneOptions options;
  const std::uint32_t made_moving = input.query.option(11);
  if (input.query.option(12) % 2 == 1) options.moving = std::span(&made_moving, 1);
  Result<Scene> scene = Scene::bind(*file, options);
  if (!scene) return check(scene);
  if (input.query.option(12) % 4 >= 2) change_scene(*scene, input.query, check);
  query(*scene, input.query, check);
}

}  // namespace boxtree::fuzz
