// SPDX-License-Identifier: MIT
// Gathers meshes and instances; numbers of a later file follow those of the earlier ones.
#include <utility>

#include <boxtree/cooker/scene/scene_source.h>

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

void append(SourceScene& to, SourceScene from) {
  const auto meshes = static_cast<std::uint32_t>(to.meshes.size());
  const auto materials = static_cast<std::uint32_t>(to.materials.size());
  const auto instances = static_cast<std::uint32_t>(to.instances.size());
  for (SceneMesh& mesh : from.meshes) {
    for (MaterialRun& run : mesh.materials) run.material += materials;
    to.meshes.push_back(std::move(mesh));
  }
  for (SceneInstance& instance : from.instances) {
    instance.mesh += meshes;
    instance.id += instances;
    to.instances.push_back(std::move(instance));
  }
  std::move(from.materials.begin(), from.materials.end(), std::back_inserter(to.materials));
}

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
  for (const fs::path& file : files) {
    progress("import " + file.filename().string());
    Result<SourceScene> scene = import_scene(file, options);
    if (!scene) return scene.error();
    loaded.imports.push_back(std::move(scene->report));
    loaded.import_names.push_back(file.filename().string());
    if (loaded.imports.size() == 1) {
      loaded.scene = std::move(*scene);
    } else {
      append(loaded.scene, std::move(*scene));
    }
  }
  return loaded;
}

}  // namespace boxtree::cooker
