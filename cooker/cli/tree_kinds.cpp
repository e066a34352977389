// SPDX-License-Identifier: MIT
#include "cooker/cli/tree_kinds.h"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "cooker/import/mesh_arrays.h"
#include "format/scene_record.h"
#include "runtime/scene/bound_scene.h"

namespace boxtree::cooker {
namespace {

constexpr QueryKinds kAllKinds = kRayQueries | kBoxQueries | kPointQueries | kPairQueries;

// The layers of the instances of a tree, each once.
std::vector<std::uint32_t> layers_of(const Scene& scene, std::uint32_t tree) {
  std::vector<std::uint32_t> layers;
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    const Result<InstanceInfo> info = scene.info(i);
    if (!info || info->tree != tree) continue;
    if (std::find(layers.begin(), layers.end(), info->layer) == layers.end()) {
      layers.push_back(info->layer);
    }
  }
  return layers;
}

Part part_of(QueryKinds kind) {
  switch (kind) {
    case kRayQueries:
      return Part::kRays;
    case kBoxQueries:
      return Part::kBoxes;
    case kPointQueries:
      return Part::kPoints;
    default:
      return Part::kPairs;
  }
}

}  // namespace

Result<QueryKinds> kinds_of_tree(const File& file, std::uint32_t tree) {
  if (file.is_pack()) {
    const Result<Member> member = file.member(tree);
    if (!member) return member.error();
    return kinds_of_tree(member->file, member->tree);
  }
  if (!file.has_scene()) return kAllKinds;
  const Result<Scene> scene = bind_without_meshes(file);
  if (!scene) return scene.error();
  const std::vector<std::uint32_t> layers = layers_of(*scene, tree);
  if (layers.empty()) return scene->query_kinds();
  std::uint32_t kinds = 0;
  for (const std::uint32_t layer : layers) kinds |= BoundScene::of(*scene).layer(layer).query_kinds;
  return static_cast<QueryKinds>(kinds & scene->query_kinds());
}

Error kind_left_out(const File& file, std::uint32_t tree, QueryKinds kind) {
  if (file.is_pack()) {
    const Result<Member> member = file.member(tree);
    return member ? kind_left_out(member->file, member->tree, kind) : member.error();
  }
  SceneOptions needed;
  needed.queries = kind;
  const Result<Scene> scene = bind_without_meshes(file, needed);
  if (!scene) return scene.error();
  std::string objects;
  for (const std::uint32_t layer : layers_of(*scene, tree)) {
    objects += fmt::format("{}{}", objects.empty() ? "" : ", ", scene->layer_name(layer));
  }
  const std::string_view name = file.tree_name(tree);
  return {Errc::kPartLeftOut,
          fmt::format(
              "tree {}: {} were left out for the objects that place it, {}: by \"queries\" of its "
              "profile",
              name.empty() ? std::to_string(tree) : fmt::format("\"{}\"", name),
              part_name(part_of(kind)), objects)};
}

}  // namespace boxtree::cooker
