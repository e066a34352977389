// SPDX-License-Identifier: MIT
// Gathers meshes and instances; numbers of a later file follow those of the earlier ones.
#include "cooker/scene/scene_source.h"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// Makes one scene of several: what is equal is there once, as in the scene of one file.
class SceneJoin {
 public:
  explicit SceneJoin(SourceScene& scene) : scene_(scene), meshes_(scene.meshes) {
    for (std::uint32_t i = 0; i < scene.materials.size(); ++i) note_material(i);
  }

  void add(SourceScene from) {
    std::vector<std::uint32_t> materials, meshes;  // their numbers here
    for (std::uint32_t i = 0; i < from.materials.size(); ++i) {
      const bool has_name = from.materials[i] != unnamed_material(i);
      materials.push_back(has_name ? add_material(from.materials[i]) : add_unnamed());
    }
    for (SceneMesh& mesh : from.meshes) {
      for (MaterialRun& run : mesh.materials) run.material = materials[run.material];
      meshes.push_back(meshes_.add(std::move(mesh)));
    }
    const auto instances = static_cast<std::uint32_t>(scene_.instances.size());
    for (SceneInstance& instance : from.instances) {
      instance.mesh = meshes[instance.mesh];
      instance.id += instances;
      scene_.instances.push_back(std::move(instance));
    }
  }

 private:
  void note_material(std::uint32_t number) {
    const std::string& name = scene_.materials[number];
    if (name != unnamed_material(number)) by_name_.emplace(name, number);
  }

  std::uint32_t add_material(const std::string& name) {
    const auto known = by_name_.find(name);
    if (known != by_name_.end()) return known->second;
    const auto number = static_cast<std::uint32_t>(scene_.materials.size());
    scene_.materials.push_back(name);
    by_name_.emplace(name, number);
    return number;
  }

  // Of two without a name nobody knows whether they are one.
  std::uint32_t add_unnamed() {
    const auto number = static_cast<std::uint32_t>(scene_.materials.size());
    scene_.materials.push_back(unnamed_material(number));
    return number;
  }

  SourceScene& scene_;
  MeshMerger meshes_;
  std::map<std::string, std::uint32_t> by_name_;  // numbers of materials
};

// The meshes of a profile become those of the scene, one each; a file that several name is read
// once for each, as each may be cooked in another way.
Result<LoadedScene> load_listed(const Profile& profile, const ImportOptions& options,
                                const std::function<void(const std::string&)>& progress) {
  LoadedScene loaded;
  loaded.scene.name = profile.path.stem().string();
  std::vector<std::uint32_t> numbers;  // of the profile's meshes, in the scene
  for (const ProfileMesh& listed : profile.meshes) {
    numbers.push_back(static_cast<std::uint32_t>(loaded.scene.meshes.size()));
    if (!listed.file) continue;
    const fs::path& path = listed.file->value;
    progress("import " + path.filename().string());
    Result<Imported> imported = import_mesh(path, options);
    if (!imported) return imported.error();
    imported->mesh.name = listed.name.value;
    loaded.scene.meshes.push_back({std::move(imported->mesh), {}});
    loaded.imports.push_back(std::move(imported->report));
    loaded.import_names.push_back(path.filename().string());
  }
  for (const ProfileInstance& placed : profile.instances) {
    loaded.scene.instances.push_back({placed.name, numbers[placed.mesh],
                                      static_cast<std::uint32_t>(loaded.scene.instances.size()),
                                      placed.pose});
  }
  return loaded;
}

}  // namespace

Result<LoadedScene> load_scene(std::span<const fs::path> inputs, const Profile& profile,
                               const ImportOptions& options,
                               const std::function<void(const std::string&)>& progress) {
  const bool is_listed = !profile.instances.empty();
  const bool has_source = is_listed || profile.source.has_value();
  if (has_source == !inputs.empty()) {
    return Error{Errc::kProfileInvalid,
                 has_source ? profile.path.string() +
                                  ": says what to cook, so that no other input can be given"
                            : "nothing to cook: give an input, or a profile that names a source or "
                              "lists instances"};
  }
  if (is_listed) return load_listed(profile, options, progress);
  LoadedScene loaded;
  const std::span<const fs::path> files =
      profile.source ? std::span(&profile.source->value, 1) : inputs;
  std::optional<SceneJoin> join;  // of the first and all others
  for (const fs::path& file : files) {
    progress("import " + file.filename().string());
    Result<SourceScene> scene = import_scene(file, options);
    if (!scene) return scene.error();
    loaded.imports.push_back(std::move(scene->report));
    loaded.import_names.push_back(file.filename().string());
    if (loaded.imports.size() == 1) {
      loaded.scene = std::move(*scene);
      join.emplace(loaded.scene);
    } else {
      join->add(std::move(*scene));
    }
  }
  return loaded;
}

}  // namespace boxtree::cooker
