// SPDX-License-Identifier: MIT
// Moving, querying, and the JSON of answers.
#include "cooker/cli/scene_query.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/cli/scene_info.h"
#include "cooker/cli/shape_answers.h"
#include "cooker/text/nearest_name.h"
#include "cooker/text/number_of.h"

namespace boxtree::cooker {
namespace {

// The same keys wherever an instance, or a face of one, is named.
void add_instance(const Scene& scene, std::uint32_t instance, Json& json) {
  const Result<InstanceInfo> info = scene.info(instance);
  json["instance"] = instance;
  if (info) {
    json["id"] = info->id;
    if (!info->name.empty()) json["name"] = info->name;
  }
}

void add_face(const Scene& scene, const SceneFace& face, Json& json) {
  add_instance(scene, face.instance, json);
  json["face"] = face_json(face.face);
  const std::uint32_t material = scene.material(face);
  add_material(json, material, scene.material_name(material));
  const Result<InstanceInfo> info = scene.info(face.instance);
  if (info) add_user_data(json, scene.trees()[info->tree].user_data(face.face));
}

Error not_for_scenes(const std::string& what) {
  return {Errc::kInvalidQuery,
          what + ": trees answer it, scenes do not; name a tree of the file with --tree"};
}

// See ShapeAnswers.
struct SceneKinds {
  using Body = Scene;
  using OfRay = SceneRayHit;
  using OfCast = SceneCastHit;
  using OfShape = SceneContact;
  using Options = SceneFaceOptions;

  template <class Shape>
  static Result<Visit> collide(const Scene& scene, const Shape& shape, SceneContactVisitor visitor,
                               const SceneFaceOptions& options) {
    return boxtree::collide(scene, shape, visitor, options.layers, options.limits);
  }
  template <class Hit>
  static void add_face(const Scene& scene, const Hit& hit, Json& json) {
    cooker::add_face(scene, {hit.instance, hit.face}, json);
  }
  // Precondition: the scene has named its instance, so its bytes are sound.
  template <class Hit>
  static const Tree& tree_of(const Scene& scene, const Hit& hit) {
    return scene.trees()[scene.info(hit.instance)->tree];
  }
  template <class Hit>
  static auto rank(const Scene&, const Hit& hit) {
    return std::array{hit.instance, hit.face.id, hit.face.index, hit.triangle};
  }
};

SceneFaceOptions of_layers(LayerMask layers) {
  SceneFaceOptions options;
  options.layers = layers;
  return options;
}

Result<Json> answer(const Scene& scene, LayerMask layers, const RayRequest& request) {
  return ShapeAnswers<SceneKinds>(scene, of_layers(layers)).answer(request);
}
Result<Json> answer(const Scene& scene, LayerMask layers, const CastRequest& request) {
  return ShapeAnswers<SceneKinds>(scene, of_layers(layers)).answer(request);
}
Result<Json> answer(const Scene& scene, LayerMask layers, const CollideRequest& request) {
  return ShapeAnswers<SceneKinds>(scene, of_layers(layers)).answer(request);
}

template <class Overlap>
Result<Json> answer_faces(const Scene& scene, Overlap overlap) {
  Json faces = Json::array();
  const Result<Visit> visit = overlap([&](const SceneFace& face) {
    Json json;
    add_face(scene, face, json);
    faces.push_back(std::move(json));
    return true;
  });
  if (!visit) return visit.error();
  return Json{{"count", faces.size()}, {"faces", faces}};
}

Result<Json> answer(const Scene& scene, LayerMask layers, const BoxRequest& request) {
  if (request.with_overlap) return not_for_scenes("whether something is within a distance");
  return answer_faces(scene, [&](SceneFaceVisitor visitor) {
    return overlap_box(scene, request.box, visitor, layers);
  });
}

Result<Json> answer(const Scene& scene, LayerMask layers, const SphereRequest& request) {
  return answer_faces(scene, [&](SceneFaceVisitor visitor) {
    return overlap_sphere(scene, request.center, request.radius, visitor, layers);
  });
}

Result<Json> answer(const Scene& scene, LayerMask layers, const FrustumRequest& request) {
  const Frustum frustum = request.frustum();
  if (!request.instances) {
    return answer_faces(scene, [&](SceneFaceVisitor visitor) {
      return overlap_frustum(scene, frustum, visitor, layers);
    });
  }
  Json instances = Json::array();
  const auto add = [&](std::uint32_t instance) {
    add_instance(scene, instance, instances.emplace_back());
    return true;
  };
  const Result<Visit> visit = instances_in_frustum(scene, frustum, add, layers);
  if (!visit) return visit.error();
  return Json{{"count", instances.size()}, {"instances", instances}};
}

Result<Json> answer(const Scene& scene, LayerMask layers, const PointRequest& request) {
  if (request.with_bounds) return not_for_scenes("an allowed error or a budget");
  const auto found = closest_point(scene, request.at, request.options.max_distance, layers);
  if (!found.ok()) return found.error();
  Json json = {{"found", found.has_value()}};
  if (found.has_value()) {
    const SceneClosestPoint& closest = *found;
    json["distance"] = closest.distance;
    json["point"] = to_json(closest.point);
    add_face(scene, {closest.instance, closest.face}, json);
    json["triangle"] = closest.triangle;
  }
  return json;
}

// Two objects, of which the second is the other body's.
Json pair_json(const Scene& scene, const ScenePair& pair) {
  Json first, second;
  add_face(scene, pair.first, first);
  if (pair.second.instance == kNoInstance) {
    second["face"] = face_json(pair.second.face);
  } else {
    add_face(scene, pair.second, second);
  }
  return {first, second};
}

template <class AnswerRequest>
Result<Json> answer_pairs(const Scene& scene, bool first_only, AnswerRequest query_pairs) {
  Json pairs = Json::array();
  const Result<Visit> visit = query_pairs([&](const ScenePair& pair) {
    pairs.push_back(pair_json(scene, pair));
    return !first_only;
  });
  if (!visit) return visit.error();
  return Json{{"hit", !pairs.empty()}, {"count", pairs.size()}, {"pairs", pairs}};
}

template <class AnswerRequest>
Result<Json> answer_pair_contacts(const Scene& scene, bool first_only,
                                  AnswerRequest query_contacts) {
  Json contacts = Json::array();
  const Result<Visit> visit = query_contacts([&](const ScenePairContact& contact) {
    Json& json = contacts.emplace_back();
    json["faces"] = pair_json(scene, {{contact.first_instance, contact.faces.first},
                                      {contact.second_instance, contact.faces.second}});
    json.update(contact_json(contact));
    return !first_only;
  });
  if (!visit) return visit.error();
  return Json{{"hit", !contacts.empty()}, {"count", contacts.size()}, {"contacts", contacts}};
}

Result<Json> answer(const Scene& scene, LayerMask layers, const ContactsRequest& request) {
  if (layers != kAllLayers) {
    return Error{Errc::kInvalidQuery,
                 "contacts: --layer is for the other kinds; which layers meet is the profile's"};
  }
  if (request.points) {
    return answer_pair_contacts(scene, request.first_only, [&](ScenePairContactVisitor visitor) {
      return pair_contacts(scene, visitor);
    });
  }
  return answer_pairs(scene, request.first_only,
                      [&](ScenePairVisitor visitor) { return contacts(scene, visitor); });
}

Result<Json> answer_pair(const Scene& scene, LayerMask layers, const Tree& second,
                         const PairRequest& request) {
  if (request.contacts) {
    return answer_pair_contacts(scene, request.first_only, [&](ScenePairContactVisitor visitor) {
      return pair_contacts(scene, second, request.second.pose, visitor, layers);
    });
  }
  return answer_pairs(scene, request.first_only, [&](ScenePairVisitor visitor) {
    return overlap_pairs(scene, second, request.second.pose, visitor, layers);
  });
}
Result<Json> answer_pair(const Scene& scene, LayerMask layers, const Tree& second,
                         const DistanceRequest& request) {
  const auto found = distance(scene, second, request.second.pose, layers, request.options);
  if (!found) return found.error();
  return distance_json(*found, [&](const ScenePair& faces) { return pair_json(scene, faces); });
}
Result<Json> answer_pair(const Scene&, LayerMask, const Tree&, const OverlapRequest&) {
  return not_for_scenes("whether two trees touch within a distance");
}

struct Move {
  std::string name;
  std::uint32_t instance;
  Pose pose;
};

// More names are not listed.
constexpr std::size_t kMostListed = 8;

// A name may not be found because it is misspelt, or names or the instance were left out.
Error no_instance(const File& file, const Scene& scene, const std::string& name) {
  std::vector<std::string> names;
  for (std::uint32_t i = 0; i < scene.instance_count(); ++i) {
    const Result<InstanceInfo> info = scene.info(i);
    if (info && !info->name.empty()) names.emplace_back(info->name);
  }
  if (names.empty()) {
    SceneOptions needed;
    needed.require_names = true;
    const Result<Scene> bound = Scene::bind(file, needed);
    if (!bound) {
      return {bound.code(), fmt::format("--move {}: {}; give the number of the instance", name,
                                        bound.error().detail)};
    }
  }
  std::string detail = fmt::format("--move: no instance is named \"{}\"", name);
  const std::uint32_t left_out = instances_left_out(scene);
  if (left_out > 0) {
    detail +=
        fmt::format(", and {} or more instances of the source were left out of the file", left_out);
  }
  if (const std::string meant = suggestion(name, names); !meant.empty()) {
    return {Errc::kInstanceIndex, detail + meant};
  }
  detail += names.size() <= kMostListed
                ? "; expected " + listed(names)
                : fmt::format("; info --json lists the {} names", names.size());
  // Instances after the last one that was kept leave no gap.
  if (left_out > 0 || profile_left_out(file)) {
    detail +=
        "; if the source has it, the profile left it out, by leave_out or queries = []: cook --why "
        "says which line";
  }
  return {Errc::kInstanceIndex, std::move(detail)};
}

// The instance of "INSTANCE=POSE", by name or number.
std::string name_in_move(const std::string& text) {
  return text.substr(0, text.rfind('='));
}

Result<Move> parse_move(const File& file, const Scene& scene, const std::string& text) {
  const std::size_t at = text.rfind('=');
  const std::string_view numbers =
      at == std::string::npos ? std::string_view() : std::string_view(text).substr(at + 1);
  const std::optional<Pose> pose = parse_pose(numbers);
  if (!pose) {
    return Error{Errc::kInvalidQuery,
                 fmt::format("--move: expected INSTANCE=X,Y,Z or INSTANCE= and 12 numbers, found "
                             "\"{}\"{}",
                             text, why_no_list(numbers))};
  }
  const std::string name = name_in_move(text);
  const Result<std::uint32_t> found = scene.find_instance(name);
  if (found) return Move{name, *found, *pose};
  const std::optional<std::uint32_t> number = number_of<std::uint32_t>(name);
  if (!number) return no_instance(file, scene, name);
  if (*number < scene.instance_count()) return Move{name, *number, *pose};
  return Error{Errc::kInstanceIndex, fmt::format("--move {}: expected a number from 0 to {}", name,
                                                 scene.instance_count() - 1)};
}

}  // namespace

Result<OpenedScene> open_scene(File file, std::span<const std::string> moves) {
  Result<Scene> scene = move_scene(file, moves);
  if (!scene) return scene.error();
  return OpenedScene{std::move(file), std::move(*scene)};
}

std::vector<std::string> hidden_by_names(const Scene& scene, std::span<const std::string> moves) {
  std::vector<std::string> hidden;
  for (const std::string& text : moves) {
    const std::string name = name_in_move(text);
    const Result<std::uint32_t> first = scene.find_instance(name);
    if (!first) continue;
    std::uint32_t count = 0;
    for (std::uint32_t i = *first; i < scene.instance_count(); ++i) {
      const Result<InstanceInfo> info = scene.info(i);
      if (info && info->name == name) ++count;
    }
    if (count > 1) {
      hidden.push_back(fmt::format(
          "--move {}: {} instances have this name; the first moves, number {}. --move NUMBER=POSE "
          "moves the instance of that number",
          name, count, *first));
    }
    const std::optional<std::uint32_t> number = number_of<std::uint32_t>(name);
    if (number && *number != *first && *number < scene.instance_count()) {
      hidden.push_back(
          fmt::format("--move {0}: the instance of that name moves, number {1}, and not number {0}",
                      name, *first));
    }
  }
  return hidden;
}

Result<Scene> move_scene(const File& file, std::span<const std::string> moves) {
  Result<Scene> scene = Scene::bind(file);
  if (!scene || moves.empty()) return scene;
  std::vector<Move> parsed;
  std::vector<std::uint32_t> moving;
  for (const std::string& text : moves) {
    const Result<Move> move = parse_move(file, *scene, text);
    if (!move) return move.error();
    parsed.push_back(*move);
    moving.push_back(move->instance);
  }
  SceneOptions options;
  options.moving = moving;
  scene = Scene::bind(file, options);
  if (!scene) return scene.error();
  for (const Move& move : parsed) {
    const Status status = scene->update(move.instance, move.pose);
    if (status.code() == Errc::kInvalidPose) {
      return explained_pose(fmt::format("--move {}: the", move.name), move.pose);
    }
    if (!status) return status.error();
  }
  return scene;
}

Result<LayerMask> layers_named(const Scene& scene, std::span<const std::string> names) {
  if (names.empty()) return kAllLayers;
  LayerMask layers = 0;
  std::vector<std::string> known;
  for (std::uint32_t i = 0; i < scene.layer_count(); ++i) known.emplace_back(scene.layer_name(i));
  for (const std::string& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      const std::string meant = suggestion(name, known);
      return Error{Errc::kInvalidQuery,
                   fmt::format("--layer: no layer is called \"{}\"{}", name,
                               meant.empty() ? "; expected " + listed(known) : meant)};
    }
    layers |= LayerMask{1} << (found - known.begin());
  }
  return layers;
}

Result<Json> answer(const File& file, const Scene& scene, LayerMask layers,
                    const QueryRequest& request, TreeCache& others) {
  Result<Json> answered = query_one_or_two(
      request, others, [&](const auto& q) { return answer(scene, layers, q); },
      [&](const Tree& second, const auto& q) { return answer_pair(scene, layers, second, q); });
  if (answered.code() != Errc::kPartLeftOut) return answered;
  // A query answers with a code alone; binding says by which line of the profile.
  SceneOptions needed;
  needed.queries = kind_of(request);
  const Result<Scene> bound = Scene::bind(file, needed);
  return bound ? answered : bound.error();
}

}  // namespace boxtree::cooker
