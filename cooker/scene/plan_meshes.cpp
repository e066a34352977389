// SPDX-License-Identifier: MIT
// Plans each mesh by the most demanding needs of all objects that use it.
#include "cooker/scene/plan_meshes.h"

#include <algorithm>
#include <array>
#include <map>
#include <unordered_map>

#include <fmt/format.h>

#include "cooker/import/f32_digits.h"
#include "cooker/scene/hidden_faces.h"
#include "cooker/scene/precision.h"
#include "cooker/scene/profile_fields.h"
#include "cooker/text/at_most.h"
#include "cooker/text/nearest_name.h"

namespace boxtree::cooker {
namespace {

// An object that uses a mesh, and the largest scale of that use.
struct Use {
  std::uint32_t object;
  double largest_scale;
};

// From the least demanding to the most, by the times in docs/MEASUREMENTS.md. Codecs that are not
// listed cannot be stated.
constexpr std::array kCodecsBySpeed = {CodecId::kPackedF64, CodecId::kDedup,    CodecId::kPackedF16,
                                       CodecId::kPackedF32, CodecId::kPlainF16, CodecId::kPlainF32,
                                       CodecId::kWide4,     CodecId::kWide8};
static_assert(kCodecsBySpeed.size() == kCodecs.size());

// Memory is below all codecs, balance between wide4 and wide8, speed above all codecs; a goal that
// is not stated is below memory.
std::size_t demand_of(const Needs& needs) {
  constexpr std::size_t kCodec = 2;  // of the first codec; each takes two numbers
  if (needs.codec) {
    const auto found = std::find(kCodecsBySpeed.begin(), kCodecsBySpeed.end(), needs.codec->value);
    return kCodec + 2 * static_cast<std::size_t>(found - kCodecsBySpeed.begin());
  }
  if (needs.goal.line == 0) return 0;
  switch (needs.goal.value) {
    case Goal::kMemory:
      return 1;
    case Goal::kSpeed:
      return kCodec + 2 * kCodecsBySpeed.size();
    case Goal::kBalance:
      break;
  }
  return kCodec + 2 * (kCodecsBySpeed.size() - 2) + 1;
}

std::string kept_for(std::string_view object, std::uint32_t line, std::string_view what) {
  if (line == 0) return "kept unless the profile says otherwise";
  return fmt::format("object \"{}\" {}", object, what);
}

class MeshPlanner {
 public:
  MeshPlanner(const SourceScene& scene, const Profile& profile, ScenePlan& plan)
      : scene_(scene), profile_(profile), plan_(plan) {}

  Status run();

 private:
  Status find_statements();
  void find_uses();
  void add_use(std::uint32_t mesh, std::uint32_t object, double scale);
  void share_shapes();
  [[nodiscard]] bool can_be_shared(std::uint32_t mesh) const;
  void drop(std::uint32_t mesh);
  void decide_parts(std::uint32_t mesh);
  void decide_part(std::uint32_t mesh, Aspect aspect, Stated<bool> Needs::*needed, bool& kept);
  void decide_queries(std::uint32_t mesh);
  void decide_geometry(std::uint32_t mesh);
  Status decide_precision(std::uint32_t mesh);
  void decide_codec(std::uint32_t mesh);
  Status decide_hidden_faces(std::uint32_t mesh);
  void decide(std::uint32_t mesh, Aspect aspect, bool kept, std::string reason,
              std::uint32_t line) {
    plan_.decide(aspect, OwnerKind::kMesh, mesh, kept, std::move(reason), line);
  }
  [[nodiscard]] const ProfileObject& object_of(const Use& use) const {
    return profile_.objects[use.object];
  }
  [[nodiscard]] Error error(std::uint32_t line, const std::string& text) const {
    return {Errc::kProfileInvalid, fmt::format("{}:{}: {}", profile_.path.string(), line, text)};
  }

  const SourceScene& scene_;
  const Profile& profile_;
  ScenePlan& plan_;
  std::vector<std::vector<Use>> uses_;       // of each mesh, by object
  std::vector<const ProfileMesh*> said_of_;  // of each mesh, or nullptr
};

Status MeshPlanner::find_statements() {
  std::map<std::string, const ProfileMesh*> by_name;
  for (const ProfileMesh& mesh : profile_.meshes) by_name.emplace(mesh.name.value, &mesh);
  std::vector<std::string> names;
  for (const SceneMesh& mesh : scene_.meshes) {
    names.push_back(mesh.mesh.name);
    const auto said = by_name.find(mesh.mesh.name);
    said_of_.push_back(said == by_name.end() ? nullptr : said->second);
  }
  for (const ProfileMesh& mesh : profile_.meshes) {
    if (std::find(names.begin(), names.end(), mesh.name.value) != names.end()) continue;
    if (!mesh.file) {
      return error(mesh.name.line,
                   fmt::format("name: expected a mesh of the source{}, found \"{}\"",
                               nearest_in_words(mesh.name.value, names), mesh.name.value));
    }
    plan_.notices.push_back(fmt::format(
        "{}: mesh \"{}\" equals another one, under whose name it is stored; what is said here "
        "of its faces, geometry and later instances has no effect",
        profile_.cite(mesh.name.line), mesh.name.value));
  }
  return {};
}

void MeshPlanner::add_use(std::uint32_t mesh, std::uint32_t object, double scale) {
  const auto& said = profile_.objects[object].needs.largest_scale;
  if (said) scale = std::max(scale, said->value);
  std::vector<Use>& uses = uses_[mesh];
  const auto found =
      std::lower_bound(uses.begin(), uses.end(), object,
                       [](const Use& use, std::uint32_t number) { return use.object < number; });
  if (found == uses.end() || found->object != object) {
    uses.insert(found, {object, scale});
  } else {
    found->largest_scale = std::max(found->largest_scale, scale);
  }
}

void MeshPlanner::find_uses() {
  uses_.resize(scene_.meshes.size());
  for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
    const SceneInstance& instance = scene_.instances[i];
    if (!plan_.instances[i].kept) continue;
    add_use(instance.mesh, plan_.instances[i].object, largest_stretch(instance.pose.linear()));
  }
  for (std::uint32_t mesh = 0; mesh < scene_.meshes.size(); ++mesh) {
    const ProfileMesh* said = said_of_[mesh];
    if (said == nullptr || !said->spawned_as) continue;
    const std::uint32_t object = said->spawned_as->value;
    const auto& needs = profile_.objects[object].needs;
    if (needs.queries.value == 0) continue;  // the object is dropped
    add_use(mesh, object, needs.largest_scale ? needs.largest_scale->value : 1);
  }
}

// False if the profile has settings for this mesh.
bool MeshPlanner::can_be_shared(std::uint32_t mesh) const {
  const std::vector<Use>& uses = uses_[mesh];
  const auto wants_materials = [&](const Use& use) { return object_of(use).needs.materials.value; };
  return said_of_[mesh] == nullptr && !uses.empty() &&
         std::none_of(uses.begin(), uses.end(), wants_materials);
}

// Meshes that differ only in materials that no object needs are merged into the first of them.
void MeshPlanner::share_shapes() {
  std::unordered_multimap<std::uint64_t, std::uint32_t> firsts;  // by shape
  for (std::uint32_t mesh = 0; mesh < scene_.meshes.size(); ++mesh) {
    if (!can_be_shared(mesh)) continue;
    const SceneMesh& source = scene_.meshes[mesh];
    const std::uint64_t hash = hash_of_shape(source);
    const auto [begin, end] = firsts.equal_range(hash);
    const auto first = std::find_if(begin, end, [&](const auto& candidate) {
      const SceneMesh& other = scene_.meshes[candidate.second];
      const bool differ_in_materials = !source.materials.empty() || !other.materials.empty();
      return differ_in_materials && has_same_shape(source, other);
    });
    if (first == end) {
      firsts.emplace(hash, mesh);
      continue;
    }
    plan_.meshes[mesh].same_as = first->second;
    for (const Use& use : uses_[mesh]) add_use(first->second, use.object, use.largest_scale);
  }
}

void MeshPlanner::drop(std::uint32_t mesh) {
  PlannedMesh& planned = plan_.meshes[mesh];
  planned.kept = planned.face_ids = planned.materials = planned.names = false;
  planned.queries = 0;
  if (planned.same_as) {
    decide(mesh, Aspect::kMesh, false,
           fmt::format("equals mesh {} but for materials that no object needs",
                       scene_.meshes[*planned.same_as].mesh.name),
           object_of(uses_[mesh].front()).needs.materials.line);
    return;
  }
  std::uint32_t line = 0;
  for (std::size_t i = 0; i < scene_.instances.size() && line == 0; ++i) {
    if (scene_.instances[i].mesh != mesh) continue;
    const ProfileObject& object = profile_.objects[plan_.instances[i].object];
    line = object.leave_out.value ? object.leave_out.line : object.needs.queries.line;
  }
  decide(mesh, Aspect::kMesh, false,
         line == 0 ? "it has no instances" : "none of its instances is kept", line);
}

// Kept if any object needs it; otherwise dropped by the line of the first object.
void MeshPlanner::decide_part(std::uint32_t mesh, Aspect aspect, Stated<bool> Needs::*needed,
                              bool& kept) {
  const std::vector<Use>& uses = uses_[mesh];
  const auto needs_it = [&](const Use& use) { return (object_of(use).needs.*needed).value; };
  const auto first_need = std::find_if(uses.begin(), uses.end(), needs_it);
  kept = first_need != uses.end();
  const ProfileObject& by = object_of(kept ? *first_need : uses.front());
  decide(mesh, aspect, kept,
         kept ? kept_for(by.name.value, (by.needs.*needed).line, "needs them")
              : "no object that uses it needs them",
         (by.needs.*needed).line);
}

void MeshPlanner::decide_parts(std::uint32_t mesh) {
  PlannedMesh& planned = plan_.meshes[mesh];
  decide_geometry(mesh);
  if (planned.external) {
    const std::uint32_t line = plan_.decisions.back().line;
    decide(mesh, Aspect::kFaceIds, true, "they lead into the application's arrays", line);
  } else {
    decide_part(mesh, Aspect::kFaceIds, &Needs::face_ids, planned.face_ids);
  }
  planned.materials = false;
  if (!scene_.meshes[mesh].materials.empty()) {
    decide_part(mesh, Aspect::kMaterials, &Needs::materials, planned.materials);
  }
  planned.names = false;
  if (!scene_.meshes[mesh].mesh.name.empty()) {
    decide_part(mesh, Aspect::kNames, &Needs::names, planned.names);
  }
  for (const Use& use : uses_[mesh]) {
    const Needs& needs = object_of(use).needs;
    plan_.material_names |= planned.materials && needs.materials.value && needs.names.value;
  }
}

void MeshPlanner::decide_queries(std::uint32_t mesh) {
  PlannedMesh& planned = plan_.meshes[mesh];
  planned.queries = 0;
  for (const Use& use : uses_[mesh]) {
    planned.queries = static_cast<QueryKinds>(planned.queries | object_of(use).needs.queries.value);
  }
  for (std::size_t kind = 0; kind < kQueryAspects.size(); ++kind) {
    // Kinds that the whole file does not answer are decided already.
    if (((plan_.queries & ~planned.queries) >> kind & 1) == 0) continue;
    decide(mesh, kQueryAspects[kind], false, "no object that uses it answers them",
           object_of(uses_[mesh].front()).needs.queries.line);
  }
}

// External if stated for the mesh or by all objects that use it.
void MeshPlanner::decide_geometry(std::uint32_t mesh) {
  PlannedMesh& planned = plan_.meshes[mesh];
  constexpr const char* kShared = "the application has these arrays";
  if (said_of_[mesh] != nullptr && said_of_[mesh]->external) {
    const Stated<bool>& external = *said_of_[mesh]->external;
    planned.external = external.value;
    decide(mesh, Aspect::kGeometry, !external.value, external.value ? kShared : "requested",
           external.line);
    return;
  }
  const std::vector<Use>& uses = uses_[mesh];
  const auto keeping = std::find_if(uses.begin(), uses.end(), [&](const Use& use) {
    return !object_of(use).needs.external.value;
  });
  planned.external = keeping == uses.end();
  const ProfileObject& by = object_of(planned.external ? uses.front() : *keeping);
  decide(mesh, Aspect::kGeometry, !planned.external,
         planned.external ? std::string(kShared)
                          : kept_for(by.name.value, by.needs.external.line, "needs it here"),
         by.needs.external.line);
}

Status MeshPlanner::decide_precision(std::uint32_t mesh) {
  PlannedMesh& planned = plan_.meshes[mesh];
  planned.default_precision = false;
  std::string reason = "the cooker's own choice";
  std::uint32_t line = 0;
  // Applies a limit in world lengths if it is tighter than the previous ones.
  const auto limit = [&](double world, double scale, const char* what, std::uint32_t said) {
    const double length = divided_below(world, scale);
    if (planned.tolerance && *planned.tolerance <= length) return;
    planned.tolerance = length;
    reason = fmt::format("{}: at most {:.3g} off in the world, {:.3g} in the mesh at scale {:.3g}",
                         what, world, length, scale);
    line = said;
  };
  for (const Use& use : uses_[mesh]) {
    const Needs& needs = object_of(use).needs;
    planned.largest_scale = std::max(planned.largest_scale, use.largest_scale);
    if (needs.exact.value && !planned.exact) {
      planned.exact = true;
      decide(mesh, Aspect::kPrecision, true,
             fmt::format("exact for object \"{}\"", object_of(use).name.value), needs.exact.line);
    }
    if (needs.tolerance) {
      limit(needs.tolerance->value, use.largest_scale, "tolerance", needs.tolerance->line);
    } else {
      planned.default_precision = true;
    }
    // Rays alone make no contact, unless the object itself states a contact rule.
    const auto contact_kinds = static_cast<QueryKinds>(~kRayQueries);
    const bool has_contacts =
        needs.contact && (needs.contact->of_object || (needs.queries.value & contact_kinds) != 0);
    if (has_contacts) {
      limit(largest_surface_error(*needs.contact), use.largest_scale,
            needs.contact->invisible.value ? "stiff contact, invisible" : "stiff contact",
            needs.contact->stiffness.line);
    }
  }
  if (planned.external) return {};
  const SourceMesh& source = scene_.meshes[mesh].mesh;
  if (planned.tolerance && source.moved_by_f32 > *planned.tolerance) {
    return Error{Errc::kMeshUnsupported,
                 fmt::format("{}:{}: {}; f32 moves a vertex of mesh \"{}\" by up to {}, farther "
                             "than that; {}",
                             profile_.path.string(), line, reason, source.name,
                             at_most(source.moved_by_f32, 3), cook_remedy_of(source.f32_loss))};
  }
  if (planned.exact) return {};
  decide(mesh, Aspect::kPrecision, !planned.tolerance, std::move(reason), line);
  return {};
}

void MeshPlanner::decide_codec(std::uint32_t mesh) {
  const std::vector<Use>& uses = uses_[mesh];
  const auto most = std::max_element(uses.begin(), uses.end(), [&](const Use& a, const Use& b) {
    return demand_of(object_of(a).needs) < demand_of(object_of(b).needs);
  });
  const ProfileObject& by = object_of(*most);
  PlannedMesh& planned = plan_.meshes[mesh];
  planned.goal = by.needs.goal.value;
  if (by.needs.codec) planned.codec = by.needs.codec->value;
  decide(mesh, Aspect::kCodec, true,
         fmt::format("{} for object \"{}\"",
                     planned.codec ? codec_name(*planned.codec) : goal_name(planned.goal),
                     by.name.value),
         planned.codec ? by.needs.codec->line : by.needs.goal.line);
}

Status MeshPlanner::decide_hidden_faces(std::uint32_t mesh) {
  const ProfileMesh* said = said_of_[mesh];
  if (said == nullptr || said->hidden_faces.empty()) return {};
  const SourceMesh& source = scene_.meshes[mesh].mesh;
  PlannedMesh& planned = plan_.meshes[mesh];
  std::uint32_t largest = 0;
  for (std::size_t face = 0; face < source.faces.size(); ++face) {
    const std::uint32_t id = source.face_id(face);
    largest = std::max(largest, id);
    planned.hidden_face_count += is_hidden(said->hidden_faces, id) ? 1u : 0u;
  }
  const std::uint32_t last = said->hidden_faces.back().last;
  if (source.faces.empty() || last > largest) {
    return error(said->hidden_faces_line,
                 fmt::format("hidden_faces: expected numbers of at most {}, the last face of mesh "
                             "\"{}\", found {}",
                             largest, source.name, last));
  }
  planned.hidden_faces = said->hidden_faces;
  decide(mesh, Aspect::kHiddenFaces, false,
         fmt::format("{} of {} faces, which the profile gives up: queries miss them",
                     planned.hidden_face_count, source.faces.size()),
         said->hidden_faces_line);
  return {};
}

Status MeshPlanner::run() {
  if (Status status = find_statements(); !status) return status;
  find_uses();
  plan_.material_names = false;
  plan_.meshes.resize(scene_.meshes.size());
  share_shapes();
  for (std::uint32_t mesh = 0; mesh < scene_.meshes.size(); ++mesh) {
    if (uses_[mesh].empty() || plan_.meshes[mesh].same_as) {
      drop(mesh);
      continue;
    }
    const ProfileMesh* said = said_of_[mesh];
    const bool is_spawned = said != nullptr && said->spawned_as;
    decide(mesh, Aspect::kMesh, true,
           is_spawned ? std::string("the program places bodies of it")
                      : fmt::format("object \"{}\" has instances of it",
                                    object_of(uses_[mesh].front()).name.value),
           is_spawned ? said->spawned_as->line : object_of(uses_[mesh].front()).name.line);
    decide_parts(mesh);
    decide_queries(mesh);
    if (Status status = decide_precision(mesh); !status) return status;
    decide_codec(mesh);
    if (Status status = decide_hidden_faces(mesh); !status) return status;
  }
  return {};
}

}  // namespace

Status plan_meshes(const SourceScene& scene, const Profile& profile, ScenePlan& plan) {
  return MeshPlanner(scene, profile, plan).run();
}

}  // namespace boxtree::cooker
