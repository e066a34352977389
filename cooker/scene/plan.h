// SPDX-License-Identifier: MIT
// From a profile to what is cooked: which instances and meshes stay, in which layers, with which
// parts and how precise; and for each decision the line that made it. Nothing here can lose a
// contact that the profile does not give up by name.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cooker/import/source_scene.h"
#include "cooker/scene/profile.h"

namespace boxtree::cooker {

/// What a decision is about.
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

/// "face ids".
[[nodiscard]] const char* aspect_name(Aspect aspect) noexcept;

/// The part that a reader misses when the aspect was dropped; nothing where it misses none.
[[nodiscard]] std::optional<Part> part_of(Aspect aspect) noexcept;

/// Whom a decision is about.
enum class OwnerKind : std::uint8_t {
  kFile,
  kObject,  // number in Profile::objects
  kMesh,    // number in SourceScene::meshes
};

struct Decision {
  Aspect aspect{};
  OwnerKind owner_kind = OwnerKind::kFile;
  std::uint32_t owner = 0;  // of kFile: 0
  bool kept = true;  // of kPrecision: no vertex may move farther than the cooker lets it by itself
  std::string reason;      // "no object that uses it needs them"
  std::uint32_t line = 0;  // of the profile; 0: a default
};

struct PlannedInstance {
  bool kept = true;
  std::uint32_t object = 0;  // in Profile::objects
  std::uint32_t layer = 0;   // in ScenePlan::layers, if kept
  bool moves = false;
  bool names = true;  // its name is kept
};

/// Where several objects use a mesh, it has what the most demanding of them needs.
struct PlannedMesh {
  bool kept = true;
  /// Not kept, because this mesh is the same but for materials that nobody wants: its instances are
  /// of that one.
  std::optional<std::uint32_t> same_as;
  bool face_ids = true;
  bool materials = true;
  bool names = true;
  bool external = false;             // only if nobody wants the geometry in the file
  QueryKinds queries = kAllQueries;  // that some instance of it answers
  std::optional<CodecId> codec;
  Goal goal = Goal::kBalance;

  bool exact = false;  // vertices keep every bit; the next two say nothing then
  /// Object space: no vertex moves farther, so that in the world, in every instance kept or said
  /// to come, it keeps to the profile.
  std::optional<double> tolerance;
  /// Somebody states no tolerance: no coarser than the cooker chooses by itself, either.
  bool default_precision = true;
  double largest_scale = 0;  // of its instances, kept or said to come; 0: there are none

  std::vector<FaceRange> hidden_faces;  // source face numbers to drop, ascending
  std::uint32_t hidden_face_count = 0;  // faces of SourceMesh that have these numbers
};

struct PlannedLayer {
  std::string name;
  std::uint32_t object = 0;  // in Profile::objects
  bool moves = false;
  QueryKinds queries = kAllQueries;
  std::uint32_t collides_with = 0;  // bit n: layer n; symmetric
};

struct ScenePlan {
  QueryKinds queries = kAllQueries;        // of the scene
  bool material_names = true;              // somebody wants materials, and names
  std::vector<PlannedInstance> instances;  // of SourceScene::instances, one each
  std::vector<PlannedMesh> meshes;         // of SourceScene::meshes, one each
  std::vector<PlannedLayer> layers;        // those that have or may get instances; at least one
  std::vector<Decision> decisions;
  std::vector<std::string> notices;  // what the profile says without effect, with its line
};

/// Plans a scene. Deterministic. Instances belong to the object that the profile names for them
/// (of a scene whose instances the profile lists: SceneInstance::id counts these), else to the
/// first whose globs match the name of the instance or of its mesh, else to "other". An object is
/// dropped if it says so, or if it answers no query: then none can reach it. Errors:
/// kProfileInvalid, for a mesh that is not in the source, and hidden faces that a mesh does not
/// have. What is said of a mesh holds for all meshes of its name.
Result<ScenePlan> plan_scene(const SourceScene& scene, const Profile& profile = {});

}  // namespace boxtree::cooker
