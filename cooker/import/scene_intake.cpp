// SPDX-License-Identifier: MIT
// Flattens each distinct list of meshes of a node once, in its own space, then merges meshes of
// equal content.
#include "cooker/import/scene_intake.h"

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include <Eigen/LU>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include "cooker/text/pose_fault.h"

namespace boxtree::cooker {
namespace {

// Names of the materials in use, in order of first use. Materials with the same name are one.
class MaterialIntake {
 public:
  MaterialIntake(const aiScene& scene, std::vector<std::string>& names)
      : scene_(scene), names_(names), numbers_(scene.mNumMaterials, kNoMaterial) {}

  // Turns runs of aiScene::mMaterials into runs of `names`.
  std::vector<FaceRun> take(std::span<const FaceRun> runs) {
    std::vector<FaceRun> taken;
    for (const FaceRun& run : runs) {
      const std::uint32_t material = number_of(run.number);
      if (taken.empty() || taken.back().number != material) {
        taken.push_back({run.first_face, material});
      }
    }
    return taken;
  }

  // Whether the materials distinguish faces, or at least have a name: assimp gives faces without a
  // material a default one.
  [[nodiscard]] bool are_known() const {
    return names_.size() > 1 ||
           (!by_name_.empty() && by_name_.begin()->first != AI_DEFAULT_MATERIAL_NAME);
  }

 private:
  std::uint32_t number_of(std::uint32_t source) {
    if (source >= numbers_.size()) return number_of_name(AI_DEFAULT_MATERIAL_NAME);
    if (numbers_[source] == kNoMaterial) {
      const std::string name = name_of(source);
      numbers_[source] = name.empty() ? number_of_unnamed() : number_of_name(name);
    }
    return numbers_[source];
  }
  [[nodiscard]] std::string name_of(std::uint32_t source) const {
    aiString name;
    const aiMaterial* material = scene_.mMaterials[source];
    if (material != nullptr) material->Get(AI_MATKEY_NAME, name);
    return name.C_Str();
  }
  std::uint32_t number_of_name(const std::string& name) {
    const auto [known, is_new] = by_name_.try_emplace(name, next());
    if (is_new) names_.push_back(name);
    return known->second;
  }
  std::uint32_t number_of_unnamed() {
    const std::uint32_t number = next();
    names_.push_back(unnamed_material(number));
    return number;
  }
  [[nodiscard]] std::uint32_t next() const { return static_cast<std::uint32_t>(names_.size()); }

  const aiScene& scene_;
  std::vector<std::string>& names_;
  std::vector<std::uint32_t> numbers_;  // of each source material; kNoMaterial if not in use yet
  std::map<std::string, std::uint32_t> by_name_;
};

Pose pose_of(const Transform& transform) {
  Pose pose = Pose::Identity();
  for (Eigen::Index i = 0; i < 3; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      pose(i, j) = transform.row[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
    }
  }
  return pose;
}

// Assimp's reader of glTF numbers the primitives of a mesh: wheel-0, wheel-1.
std::string name_of(const aiScene& scene, const Placement& placement) {
  constexpr std::string_view kFirst = "-0";
  std::string name = scene.mMeshes[placement.meshes[0]]->mName.C_Str();
  if (placement.meshes.size() > 1 && name.ends_with(kFirst)) {
    name.resize(name.size() - kFirst.size());
  }
  return name.empty() ? placement.name : name;
}

void drop_materials(SourceScene& out) {
  out.materials.clear();
  for (SceneMesh& mesh : out.meshes) mesh.materials.clear();
}

class SceneIntake {
 public:
  SceneIntake(aiScene& scene, const SourceContext& context, SourceScene& out)
      : scene_(scene),
        context_(context),
        out_(out),
        materials_(scene, out.materials),
        uses_(scene.mNumMeshes, 0),
        meshes_(out.meshes) {}

  Status take(const Placements& placements);

 private:
  Result<std::uint32_t> take_meshes(const Placement& placement);

  aiScene& scene_;
  const SourceContext& context_;
  SourceScene& out_;
  MaterialIntake materials_;
  MeshUses uses_;
  MeshMerger meshes_;
};

Status SceneIntake::take(const Placements& placements) {
  // Nodes with the same meshes of the file in the same order share one result.
  std::map<std::vector<unsigned>, std::optional<std::uint32_t>> taken;
  for (const Placement& placement : placements.all) {
    if (!taken.try_emplace(placement.meshes).second) continue;
    for (const unsigned mesh : placement.meshes) ++uses_[mesh];
  }
  for (const Placement& placement : placements.all) {
    std::optional<std::uint32_t>& mesh = taken.find(placement.meshes)->second;
    if (!mesh) {
      const Result<std::uint32_t> number = take_meshes(placement);
      if (!number.ok()) return number.error();
      mesh = *number;
    }
    if (*mesh == kNoMesh) continue;
    const Pose pose = pose_of(placement.transform);
    const bool is_finite = pose.matrix().allFinite();
    if (!is_finite || !has_double_inverse(pose)) {
      return Error{Errc::kImportFailed,
                   fmt::format("{}: node '{}': its transform {}{}", context_.file, placement.name,
                               pose_fault(pose),
                               is_finite ? "; --flatten makes one tree of a file, also of what it "
                                           "flattens"
                                         : " in single precision, in which assimp reads it: at "
                                           "most 3.4e38, with the transforms above it")};
    }
    const auto id = static_cast<std::uint32_t>(out_.instances.size());
    out_.instances.push_back({placement.name, *mesh, id, pose});
  }
  if (!materials_.are_known()) drop_materials(out_);
  return check_any_taken(context_.file, out_.instances.size(), out_.report);
}

Result<std::uint32_t> SceneIntake::take_meshes(const Placement& placement) {
  SceneMesh mesh;
  Imported imported;
  imported.mesh.name = name_of(scene_, placement);
  imported.report = std::move(out_.report);
  const std::size_t faces_before = imported.report.source_faces;
  const std::size_t skipped_before = imported.report.skipped.size();
  const SourceContext context{context_.options,
                              fmt::format("{}: mesh of '{}'", context_.file, placement.name),
                              context_.materials, context_.user_data, context_.loss_in_text};
  std::vector<MeshInstance> parts;
  for (const unsigned part : placement.meshes) parts.push_back({part, Transform()});
  std::vector<FaceRun> runs;
  const Status status = flatten_instances(scene_, parts, uses_, context, imported, runs);
  out_.report = std::move(imported.report);
  if (!status.ok()) return status.error();
  mesh.mesh = std::move(imported.mesh);
  mesh.user_data = std::move(imported.user_data);
  mesh.source_faces = static_cast<std::uint32_t>(out_.report.source_faces - faces_before);
  std::uint32_t number = kNoMesh;
  if (!mesh.mesh.faces.empty()) {
    mesh.materials = materials_.take(runs);
    number = meshes_.add(std::move(mesh));
  }
  for (std::size_t i = skipped_before; i < out_.report.skipped.size(); ++i) {
    out_.report.skipped[i].mesh = number;
  }
  return number;
}

}  // namespace

FaceMaterials take_materials(const aiScene& scene, std::span<const FaceRun> runs) {
  FaceMaterials taken;
  MaterialIntake intake(scene, taken.names);
  taken.runs = intake.take(runs);
  return intake.are_known() ? taken : FaceMaterials();
}

Status take_scene(aiScene& scene, const Placements& placements, const SourceContext& context,
                  SourceScene& out) {
  free_attributes(scene);
  out.report.meshes_unplaced = placements.unplaced;
  return SceneIntake(scene, context, out).take(placements);
}

}  // namespace boxtree::cooker
