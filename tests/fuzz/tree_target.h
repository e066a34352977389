// SPDX-License-Identifier: MIT
// What targets that query one tree share: the file is opened, its first tree bound, and what the
// query says held against what `verify` says.
#pragma once

#include "tests/fuzz/query_input.h"
#include "tests/fuzz/target.h"

namespace boxtree::fuzz {

/// Calls query(tree, query, check) when the file of the input opens and binds; `check` takes
/// each Result of a query.
template <class Query>
void query_tree(Bytes bytes, const Query& query) {
  const Input input(bytes);
  const Result<File> file = File::open(input.file());
  if (!file) return;
  const Result<Tree> tree = Tree::bind(*file);
  if (!tree) {
    check_error(*file, tree.code());
    return;
  }
  query(*tree, input.query, [&](const auto& result) {
    if (!result.ok()) check_error(*file, result.code());
  });
}

/// The same with the scene of the file, whose moving instances are first sent elsewhere.
template <class Query>
void query_scene(Bytes bytes, const Query& query) {
  const Input input(bytes);
  const Result<File> file = File::open(input.file());
  if (!file || !file->has_scene()) return;
  const auto check = [&](const auto& result) {
    if (!result.ok()) check_error(*file, result.code());
  };
  SceneOptions options;
  const std::uint32_t made_moving = input.query.option(11);
  if (input.query.option(12) % 2 == 1) options.moving = std::span(&made_moving, 1);
  Result<Scene> scene = Scene::bind(*file, options);
  if (!scene) {
    check(scene);
    return;
  }
  if (input.query.option(12) % 4 >= 2) {
    for (std::uint32_t i = 0; i < std::min(scene->instance_count(), 8u); ++i) {
      const Status moved = scene->update(i, input.query.pose());
      if (!moved.ok()) check_error(*file, moved.code());
    }
    if (input.query.option(13) % 2 == 1) scene->rebuild();
  }
  query(*scene, input.query, check);
}

}  // namespace boxtree::fuzz
