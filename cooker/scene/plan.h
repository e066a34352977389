// SPDX-License-Identifier: MIT
// Plans a cook from a profile: the instances and meshes that stay, their layers, parts and
// precision, and for each decision the line that made it. The plan never loses a contact unless the
// profile gives it up explicitly.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cooker/import/source_scene.h"
#include "cooker/scene/profile.h"

namespace boxtree::cooker {

/// The subject of a decision.
enum class Aspect : std::uint8_t {
  kFaceIds,
  kMaterials,
  kNames,
  kRay,  // queries of this kind
  kBox,
  kPoint,
  kPair,
  kInstances,
  kMesh,
  kGeometry,  // external or in the file
  kPrecision,
  kCodec,
  kHiddenFaces,
  kContacts,  // between the layers of the file
};

/// The aspects of the kinds of queries, in the order of QueryKinds' bits.
inline constexpr std::array kQueryAspects = {Aspect::kRay, Aspect::kBox, Aspect::kPoint,
                                             Aspect::kPair};

/// "face ids".
[[nodiscard]] const char* aspect_name(Aspect aspect) noexcept;

/// The part that a reader lacks if the aspect was dropped; empty if it lacks none.
[[nodiscard]] std::optional<Part> part_of(Aspect aspect) noexcept;

/// The owner of a decision.
enum class OwnerKind : std::uint8_t {
  kFile,
  kObject,  // index into Profile::objects
  kMesh,    // index into SourceScene::meshes
};

struct Decision {
  Aspect aspect{};
  OwnerKind owner_kind = OwnerKind::kFile;
  std::uint32_t owner = 0;  // for kFile: 0
  bool kept = true;         // kPrecision: no vertex may move farther than the default allows
  std::string reason;       // "no object that uses it needs them"
  std::uint32_t line = 0;   // of the profile; 0: a default
};

struct PlannedInstance {
  bool kept = true;
  std::uint32_t object = 0;  // index into Profile::objects
  std::uint32_t layer = 0;   // index into ScenePlan::layers, if kept
  bool moves = false;
  bool names = true;  // its name is kept
};

/// If several objects use a mesh, it has the most demanding needs of them.
struct PlannedMesh {
  bool kept = true;
  /// If set, the mesh is not kept: it equals this mesh except for materials that no object needs,
  /// and its instances use this mesh.
  std::optional<std::uint32_t> same_as;
  bool face_ids = true;
  bool materials = true;
  bool names = true;
  bool external = false;             // only if no object needs the geometry in the file
  QueryKinds queries = kAllQueries;  // that some instance of it answers
  std::optional<CodecId> codec;
  Goal goal = Goal::kBalance;

  bool exact = false;  // vertices keep every bit; the next two have no effect then
  /// Object space: no vertex moves farther, so that every instance, kept or placed later, keeps to
  /// the profile's tolerance in the world.
  std::optional<double> tolerance;
  /// Some object states no tolerance: no coarser than the cooker's default.
  bool default_precision = true;
  double largest_scale = 0;  // of its instances and bodies; 0: there are none

  std::vector<FaceRange> hidden_faces;  // source face numbers to drop, ascending
  std::uint32_t hidden_face_count = 0;  // number of faces of SourceMesh with these numbers
};

struct PlannedLayer {
  std::string name;
  std::uint32_t object = 0;  // index into Profile::objects
  bool moves = false;
  QueryKinds queries = kAllQueries;
  std::uint32_t collides_with = 0;  // bit n: layer n; symmetric
};

struct ScenePlan {
  QueryKinds queries = kAllQueries;        // of the scene
  bool material_names = true;              // some object needs materials and names
  std::vector<PlannedInstance> instances;  // one for each of SourceScene::instances
  std::vector<PlannedMesh> meshes;         // one for each of SourceScene::meshes
  std::vector<PlannedLayer> layers;        // those that have or may get instances; at least one
  std::vector<Decision> decisions;
  std::vector<std::string> notices;  // statements of the profile without effect, with their lines

  void decide(Aspect aspect, OwnerKind owner_kind, std::uint32_t owner, bool kept,
              std::string reason, std::uint32_t line);
};

/// Plans a scene. Deterministic. An instance belongs to the object that the profile names for it
/// (in a scene whose instances the profile lists, SceneInstance::id is the index in that list),
/// else to the first object whose globs match the name of the instance or of its mesh, else to
/// "other". An object is dropped if the profile states so, or if it answers no query, because then
/// no query can reach it. Settings for a mesh apply to all meshes with its name. Errors:
/// kProfileInvalid for a mesh that is not in the source, and for hidden faces that a mesh does not
/// have; kMeshUnsupported for a mesh that f32 has moved farther than the profile tolerates.
Result<ScenePlan> plan_scene(const SourceScene& scene, const Profile& profile = {});

}  // namespace boxtree::cooker
