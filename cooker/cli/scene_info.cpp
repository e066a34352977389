// SPDX-License-Identifier: MIT
// The scene of a file as JSON, and the JSON as text.
#include "cooker/cli/scene_info.h"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/cli/output.h"
#include "cooker/import/mesh_arrays.h"
#include "cooker/text/counted.h"
#include "format/tree_record.h"
#include "runtime/file/open_file.h"
#include "runtime/scene/bound_scene.h"

namespace boxtree::cooker {
namespace {

Json kinds_json(std::uint32_t kinds) {
  Json json = Json::array();
  constexpr std::pair<QueryKinds, const char*> kNames[] = {
      {kRayQueries, "ray"}, {kBoxQueries, "box"}, {kPointQueries, "point"}, {kPairQueries, "pair"}};
  for (const auto& [kind, name] : kNames) {
    if ((kinds & kind) != 0) json.push_back(name);
  }
  return json;
}

Json instance_json(const File& file, const Scene& scene, std::uint32_t number) {
  const Result<InstanceInfo> info = scene.info(number);
  const Result<Pose> pose = scene.pose(number);
  if (!info || !pose) return {{"number", number}, {"error", "corrupt"}};
  Json rows = Json::array();
  for (Eigen::Index row = 0; row < 3; ++row) {
    Json numbers = Json::array();
    for (Eigen::Index column = 0; column < 4; ++column) {
      numbers.push_back(pose->matrix()(row, column));
    }
    rows.push_back(numbers);
  }
  return {{"number", number},
          {"id", info->id},
          {"name", info->name},
          {"tree", info->tree},
          {"layer", info->layer},
          {"moves", info->moves},
          {"triangles", OpenFile::of(file).tree_record(info->tree).triangle_count},
          {"pose", rows}};
}

Json left_out_json(const File& file) {
  Json json = Json::array();
  const Bytes bytes = OpenFile::of(file).section(SectionKind::kLeftOut);
  const Bytes names = OpenFile::of(file).section(SectionKind::kNames);
  for (std::size_t i = 0; i < bytes.size() / sizeof(LeftOutRecord); ++i) {
    const auto record = load<LeftOutRecord>(bytes.data(), i);
    const bool is_text = in_range(record.text_offset, record.text_bytes, names.size());
    json.push_back({{"part", part_name(record.part)},
                    {"tree", record.owner == kNoOwner ? Json(nullptr) : Json(record.owner)},
                    {"by", is_text ? std::string(reinterpret_cast<const char*>(names.data()) +
                                                     record.text_offset,
                                                 record.text_bytes)
                                   : std::string()}});
  }
  return json;
}

}  // namespace

std::uint32_t instances_left_out(const Scene& scene) {
  std::uint32_t of_source = 0;
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    const Result<InstanceInfo> info = scene.info(i);
    if (info) of_source = std::max(of_source, info->id + 1);
  }
  return of_source - std::min(of_source, scene.instance_count());
}

bool profile_left_out(const File& file) {
  const Bytes bytes = OpenFile::of(file).section(SectionKind::kLeftOut);
  for (std::size_t i = 0; i < bytes.size() / sizeof(LeftOutRecord); ++i) {
    if (load<LeftOutRecord>(bytes.data(), i).line > 0) return true;
  }
  return false;
}

QueryKinds layer_queries(const Scene& scene, std::uint32_t layer) {
  return static_cast<QueryKinds>(BoundScene::of(scene).layer(layer).query_kinds);
}

Result<Json> scene_json(const File& file) {
  if (!file.has_scene()) return Json(nullptr);
  const Result<Scene> scene = bind_without_meshes(file);
  if (!scene) return scene.error();
  std::uint64_t triangles = 0;
  Json instances = Json::array();
  for (std::uint32_t i = 0; i < scene->instance_count(); ++i) {
    instances.push_back(instance_json(file, *scene, i));
    if (instances.back().contains("triangles")) {
      triangles += instances.back()["triangles"].get<std::uint64_t>();
    }
  }
  Json layers = Json::array();
  for (std::uint32_t i = 0; i < scene->layer_count(); ++i) {
    const LayerRecord layer = BoundScene::of(*scene).layer(i);
    Json collides_with = Json::array();
    for (std::uint32_t other = 0; other < scene->layer_count(); ++other) {
      if (((layer.collides_with >> other) & 1u) != 0) collides_with.push_back(other);
    }
    layers.push_back({{"name", scene->layer_name(i)},
                      {"queries", kinds_json(layer_queries(*scene, i))},
                      {"collides_with", collides_with}});
  }
  Json materials = Json::array();
  for (std::uint32_t i = 0; i < scene->material_count(); ++i) {
    materials.push_back(scene->material_name(i));
  }
  return Json{{"instance_count", scene->instance_count()},
              {"moving", BoundScene::of(*scene).moving().size()},
              {"placed_triangles", triangles},
              {"queries", kinds_json(scene->query_kinds())},
              {"layers", layers},
              {"materials", materials},
              {"left_out", left_out_json(file)},
              {"instances_left_out", instances_left_out(*scene)},
              {"instances", instances}};
}

void print_scene(const Json& scene) {
  fmt::print("scene: {} ({} moving), {} placed; answers {}\n",
             counted(scene["instance_count"].get<std::uint32_t>(), "instance"),
             scene["moving"].get<std::uint64_t>(),
             counted(scene["placed_triangles"].get<std::uint64_t>(), "triangle"),
             line_of(scene["queries"]));
  std::map<std::uint32_t, std::size_t> of_layer;
  for (const Json& instance : scene["instances"]) {
    if (instance.contains("layer")) ++of_layer[instance["layer"].get<std::uint32_t>()];
  }
  for (std::uint32_t i = 0; i < scene["layers"].size(); ++i) {
    const Json& layer = scene["layers"][i];
    fmt::print("  layer {} {}: {}, answers {}, collides with layers {}\n", i,
               line_of(layer["name"]), counted(of_layer[i], "instance"), line_of(layer["queries"]),
               line_of(layer["collides_with"]));
  }
  if (!scene["materials"].empty()) fmt::print("  materials {}\n", line_of(scene["materials"]));
  for (const Json& part : scene["left_out"]) {
    const std::string owner =
        part["tree"].is_null() ? "" : fmt::format(" of tree {}", part["tree"].get<std::uint32_t>());
    fmt::print("  left out: {}{}, by {}\n", shown(part["part"].get<std::string>()), owner,
               shown(part["by"].get<std::string>()));
  }
  const auto instances = scene["instances_left_out"].get<std::uint32_t>();
  if (instances > 0) {
    fmt::print("  left out: {} or more instances of the source, whose ids are not there\n",
               instances);
  }
}

}  // namespace boxtree::cooker
