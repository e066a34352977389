// SPDX-License-Identifier: MIT
// Plans instances and layers; plan_meshes.cpp plans the meshes.
#include "cooker/scene/plan.h"

#include <algorithm>
#include <array>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "cooker/scene/plan_meshes.h"
#include "cooker/text/nearest_name.h"
#include "runtime/primitive/float_state.h"

namespace boxtree::cooker {
namespace {

// Whether a glob matches an instance or its mesh by name.
bool matches(const std::vector<Stated<std::string>>& globs, const SourceScene& scene,
             const SceneInstance& instance) {
  const std::string& mesh = scene.meshes[instance.mesh].mesh.name;
  return std::any_of(globs.begin(), globs.end(), [&](const Stated<std::string>& glob) {
    return glob_matches(glob.value, instance.name) || glob_matches(glob.value, mesh);
  });
}

std::vector<std::uint32_t> objects_of(const SourceScene& scene, const Profile& profile) {
  const auto other = static_cast<std::uint32_t>(profile.objects.size() - 1);
  std::vector<std::uint32_t> objects;
  objects.reserve(scene.instances.size());
  for (const SceneInstance& instance : scene.instances) {
    if (instance.id < profile.instances.size() && profile.instances[instance.id].object) {
      objects.push_back(profile.instances[instance.id].object->value);
      continue;
    }
    std::uint32_t object = 0;
    while (object < other && !matches(profile.objects[object].match, scene, instance)) ++object;
    objects.push_back(object);
  }
  return objects;
}

// The line that drops an object, if any. An object that answers no query is dropped, whether its
// instances move or not: pair queries, too, need both sides to answer them.
std::optional<std::uint32_t> line_that_drops(const ProfileObject& object) {
  if (object.leave_out.value) return object.leave_out.line;
  if (object.needs.queries.value == 0) return object.needs.queries.line;
  return std::nullopt;
}

bool is_spawned(const Profile& profile, std::uint32_t object) {
  return std::any_of(profile.meshes.begin(), profile.meshes.end(), [&](const ProfileMesh& mesh) {
    return mesh.spawned_as && mesh.spawned_as->value == object;
  });
}

// Of instances and of their meshes.
std::vector<std::string> names_of(const SourceScene& scene) {
  std::set<std::string> names;
  for (const SceneInstance& instance : scene.instances) names.insert(instance.name);
  for (const SceneMesh& mesh : scene.meshes) names.insert(mesh.mesh.name);
  names.erase(std::string());
  return {names.begin(), names.end()};
}

// Why an object that matches names has no instance: others come first, or its names are misspelt.
std::string why_none(const SourceScene& scene, const Profile& profile,
                     std::span<const std::uint32_t> objects, std::uint32_t object) {
  const auto& globs = profile.objects[object].match;
  for (std::size_t i = 0; i < objects.size(); ++i) {
    const SceneInstance& instance = scene.instances[i];
    if (!matches(globs, scene, instance)) continue;
    const std::string& mesh = scene.meshes[instance.mesh].mesh.name;
    const bool is_stated =
        instance.id < profile.instances.size() && profile.instances[instance.id].object;
    return fmt::format(": it matches \"{}\", which is of \"{}\", {}",
                       instance.name.empty() ? mesh : instance.name,
                       profile.objects[objects[i]].name.value,
                       is_stated ? "as the instance states" : "an object that comes first");
  }
  const std::vector<std::string> names = names_of(scene);
  const std::string meant = suggestion(globs.front().value, names);
  return meant.empty() ? expected_if_few(names) : meant;
}

void plan_instances(const SourceScene& scene, const Profile& profile, ScenePlan& plan) {
  const std::vector<std::uint32_t> objects = objects_of(scene, profile);
  std::vector<std::size_t> count(profile.objects.size(), 0);
  for (const std::uint32_t object : objects) ++count[object];

  constexpr std::uint32_t kNoLayer = 0xffffffffu;
  std::vector<std::uint32_t> layer(profile.objects.size(), kNoLayer);
  for (std::uint32_t o = 0; o < profile.objects.size(); ++o) {
    const ProfileObject& object = profile.objects[o];
    const bool is_other = o + 1 == profile.objects.size();
    const auto dropped = line_that_drops(object);
    if (count[o] > 0) {
      const char* why = object.leave_out.value ? "left out" : "no query reaches them";
      plan.decide(Aspect::kInstances, OwnerKind::kObject, o, !dropped,
                  fmt::format("{} {}{}{}", count[o], object.moves.value ? "moving" : "static",
                              dropped ? ": " : "", dropped ? why : ""),
                  dropped ? *dropped : object.name.line);
    } else if (!object.match.empty()) {
      plan.notices.push_back(fmt::format("{}: no instance is of object \"{}\"{}",
                                         profile.cite(object.match.front().line), object.name.value,
                                         why_none(scene, profile, objects, o)));
    }
    if (count[o] == 0 && is_spawned(profile, o) && !object.never_collides_with.empty()) {
      plan.notices.push_back(
          fmt::format("{}: object \"{}\" has no instances, and bodies that a "
                      "program places have no layer: it leaves layers out of the mask that "
                      "overlap_pairs() takes",
                      profile.cite(object.never_collides_with.front().line), object.name.value));
    }
    const bool is_idle =
        is_other && count[o] == 0 && !plan.layers.empty() && !is_spawned(profile, o);
    if (dropped || is_idle) continue;
    layer[o] = static_cast<std::uint32_t>(plan.layers.size());
    plan.layers.push_back(
        {object.name.value, o, object.moves.value, object.needs.queries.value, 0});
  }
  for (const std::uint32_t o : objects) {
    const bool kept = layer[o] != kNoLayer;
    const ProfileObject& object = profile.objects[o];
    plan.instances.push_back(
        {kept, o, kept ? layer[o] : 0, object.moves.value, kept && object.needs.names.value});
  }
  const bool is_all_dropped =
      !objects.empty() && std::ranges::none_of(plan.instances, &PlannedInstance::kept);
  if (is_all_dropped) {
    const ProfileObject& first = profile.objects[objects.front()];
    plan.notices.push_back(fmt::format("{}: no instance of the scene is kept",
                                       profile.cite(line_that_drops(first).value_or(0))));
  }
}

bool never_collide(const ProfileObject& object, std::uint32_t other) {
  return std::any_of(object.never_collides_with.begin(), object.never_collides_with.end(),
                     [&](const Stated<std::uint32_t>& name) { return name.value == other; });
}

// Applications may move static instances when they bind the scene (SceneOptions::moving), so layers
// of static objects collide like any others. Two instances at rest are never compared.
void plan_contacts(const Profile& profile, ScenePlan& plan) {
  for (std::size_t a = 0; a < plan.layers.size(); ++a) {
    PlannedLayer& first = plan.layers[a];
    if ((first.queries & kPairQueries) == 0) continue;
    for (std::size_t b = a; b < plan.layers.size(); ++b) {
      PlannedLayer& second = plan.layers[b];
      if ((second.queries & kPairQueries) == 0) continue;
      if (never_collide(profile.objects[first.object], second.object) ||
          never_collide(profile.objects[second.object], first.object)) {
        continue;
      }
      first.collides_with |= 1u << b;
      second.collides_with |= 1u << a;
    }
  }
  for (const PlannedLayer& layer : plan.layers) {
    for (const Stated<std::uint32_t>& name : profile.objects[layer.object].never_collides_with) {
      plan.decide(Aspect::kContacts, OwnerKind::kObject, layer.object, false,
                  fmt::format("never collides with \"{}\"", profile.objects[name.value].name.value),
                  name.line);
    }
  }
}

void decide_queries(const Profile& profile, ScenePlan& plan) {
  plan.queries = 0;
  for (const PlannedLayer& layer : plan.layers) {
    plan.queries = static_cast<QueryKinds>(plan.queries | layer.queries);
  }
  for (std::size_t kind = 0; kind < kQueryAspects.size(); ++kind) {
    const auto bit = static_cast<QueryKinds>(1u << kind);
    const bool of_scene = (profile.scene.queries.value & bit) != 0;
    std::uint32_t line = profile.scene.queries.line;
    for (const PlannedLayer& layer : plan.layers) {
      if (!of_scene || (layer.queries & bit) != 0) continue;
      const ProfileObject& object = profile.objects[layer.object];
      plan.decide(kQueryAspects[kind], OwnerKind::kObject, layer.object, false,
                  "its instances do not answer them", object.needs.queries.line);
      if ((plan.queries & bit) == 0) line = object.needs.queries.line;
    }
    const bool kept = (plan.queries & bit) != 0;
    plan.decide(kQueryAspects[kind], OwnerKind::kFile, 0, kept,
                kept       ? "requested"
                : of_scene ? "no object answers them"
                           : "the scene never answers them",
                line);
  }
}

void decide_names(const Profile& profile, ScenePlan& plan) {
  bool any = false;
  std::uint32_t line = profile.scene.names.line;
  for (const PlannedLayer& layer : plan.layers) {
    const Stated<bool>& names = profile.objects[layer.object].needs.names;
    any = any || names.value;
    line = std::max(line, names.line);
    if (names.value) continue;
    plan.decide(Aspect::kNames, OwnerKind::kObject, layer.object, false,
                "no object needs names of its instances", names.line);
  }
  if (any) return;
  plan.decide(Aspect::kNames, OwnerKind::kFile, 0, false, "no object needs them", line);
}

}  // namespace

const char* aspect_name(Aspect aspect) noexcept {
  switch (aspect) {
    case Aspect::kFaceIds:
      return "face ids";
    case Aspect::kMaterials:
      return "materials";
    case Aspect::kNames:
      return "names";
    case Aspect::kRay:
      return "ray queries";
    case Aspect::kBox:
      return "box queries";
    case Aspect::kPoint:
      return "point queries";
    case Aspect::kPair:
      return "pair queries";
    case Aspect::kInstances:
      return "instances";
    case Aspect::kMesh:
      return "mesh";
    case Aspect::kGeometry:
      return "geometry";
    case Aspect::kPrecision:
      return "precision";
    case Aspect::kCodec:
      return "codec";
    case Aspect::kHiddenFaces:
      return "hidden faces";
    case Aspect::kContacts:
      break;
  }
  return "contacts";
}

std::optional<Part> part_of(Aspect aspect) noexcept {
  switch (aspect) {
    case Aspect::kFaceIds:
      return Part::kFaceIds;
    case Aspect::kMaterials:
      return Part::kMaterials;
    case Aspect::kNames:
      return Part::kNames;
    case Aspect::kRay:
      return Part::kRays;
    case Aspect::kBox:
      return Part::kBoxes;
    case Aspect::kPoint:
      return Part::kPoints;
    case Aspect::kPair:
      return Part::kPairs;
    default:
      return std::nullopt;
  }
}

// Member by member: g++ 12 warns of the bounds of a temporary Decision made around a short reason.
void ScenePlan::decide(Aspect aspect, OwnerKind owner_kind, std::uint32_t owner, bool kept,
                       std::string reason, std::uint32_t line) {
  Decision& decision = decisions.emplace_back();
  decision.aspect = aspect;
  decision.owner_kind = owner_kind;
  decision.owner = owner;
  decision.kept = kept;
  decision.reason = std::move(reason);
  decision.line = line;
}

Result<ScenePlan> plan_scene(const SourceScene& scene, const Profile& profile) {
  const DefaultFloatState state;
  ScenePlan plan;
  plan_instances(scene, profile, plan);
  plan_contacts(profile, plan);
  decide_queries(profile, plan);
  decide_names(profile, plan);
  if (Status status = plan_meshes(scene, profile, plan); !status) return status.error();
  return plan;
}

}  // namespace boxtree::cooker
