// SPDX-License-Identifier: MIT
// Collects meshes and instances; numbers of a later file follow those of the earlier ones.
#include "cooker/scene/cook_input.h"

#include <map>
#include <optional>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "format/limits.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// Joins several scenes into one; equal meshes are stored once, as in the scene of one file.
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

  // Materials without a name are never merged, because they may differ.
  std::uint32_t add_unnamed() {
    const auto number = static_cast<std::uint32_t>(scene_.materials.size());
    scene_.materials.push_back(unnamed_material(number));
    return number;
  }

  SourceScene& scene_;
  MeshMerger meshes_;
  std::map<std::string, std::uint32_t> by_name_;  // numbers of materials
};

void note_import(CookInput& input, ImportReport&& report, std::string name) {
  input.imports.push_back(std::move(report));
  input.import_names.push_back(std::move(name));
}

// Each mesh of a profile becomes a mesh of the scene. A file that several name is read once for
// each, because each may be cooked differently.
Result<CookInput> load_listed(const Profile& profile, const ImportOptions& options,
                              const Progress& progress) {
  CookInput input;
  input.scene.name = profile.path.stem().string();
  std::vector<std::uint32_t> numbers;  // the scene's numbers of the profile's meshes
  for (const ProfileMesh& listed : profile.meshes) {
    numbers.push_back(static_cast<std::uint32_t>(input.scene.meshes.size()));
    if (!listed.file) continue;
    const std::string name = listed.file->value.filename().string();
    announce(progress, "import " + name);
    Result<Imported> imported = import_mesh(listed.file->value, options);
    if (!imported) return imported.error();
    imported->mesh.name = listed.name.value;
    input.scene.meshes.push_back({std::move(imported->mesh), {}});
    note_import(input, std::move(imported->report), name);
  }
  for (const ProfileInstance& placed : profile.instances) {
    input.scene.instances.push_back({placed.name, numbers[placed.mesh],
                                     static_cast<std::uint32_t>(input.scene.instances.size()),
                                     placed.pose});
  }
  return input;
}

}  // namespace

Result<CookInput> load_scene(std::span<const fs::path> inputs, const Profile& profile,
                             const ImportOptions& options, const Progress& progress) {
  const bool is_listed = !profile.instances.empty();
  const bool has_source = is_listed || profile.source.has_value();
  if (has_source == !inputs.empty()) {
    return Error{Errc::kProfileInvalid,
                 has_source
                     ? profile.path.string() +
                           ": names what to cook; leave MESH out of the command, or \"source\" and "
                           "[[instance]] out of the profile"
                     : "nothing to cook: give an input, or a profile that names a source or "
                       "lists instances"};
  }
  if (is_listed) return load_listed(profile, options, progress);
  CookInput input;
  const std::span<const fs::path> files =
      profile.source ? std::span(&profile.source->value, 1) : inputs;
  std::optional<SceneJoin> join;  // of the first and all others
  for (const fs::path& file : files) {
    const std::string name = file.filename().string();
    announce(progress, "import " + name);
    Result<SourceScene> scene = import_scene(file, options);
    if (!scene) return scene.error();
    note_import(input, std::move(scene->report), name);
    if (join) {
      join->add(std::move(*scene));
    } else {
      input.scene = std::move(*scene);
      join.emplace(input.scene);
    }
  }
  return input;
}

Result<CookInput> load_file(const fs::path& path, const ImportOptions& options,
                            const Progress& progress) {
  const std::string name = path.filename().string();
  announce(progress, "import " + name);
  Result<ImportedFile> file = import_file(path, options);
  if (!file) return file.error();
  CookInput input;
  if (auto* mesh = std::get_if<Imported>(&*file)) {
    input.has_top_level = false;
    note_import(input, std::move(mesh->report), mesh->mesh.name);
    input.scene.meshes.push_back({std::move(mesh->mesh), {}});
  } else {
    input.scene = std::move(std::get<SourceScene>(*file));
    note_import(input, std::move(input.scene.report), name);
  }
  return input;
}

Result<CookInput> load_trees(std::span<const fs::path> inputs, const ImportOptions& options,
                             const Progress& progress) {
  // Reported before hours of work, not after.
  if (inputs.size() > kMaxTrees) {
    return Error{Errc::kMeshTooLarge, fmt::format("{} inputs, each a tree: a file holds {} at most",
                                                  inputs.size(), kMaxTrees)};
  }
  CookInput input;
  input.has_top_level = false;
  input.scene.meshes.resize(inputs.size());
  for (const fs::path& path : inputs) input.import_names.push_back(path.stem().string());
  input.importer = [paths = std::vector(inputs.begin(), inputs.end()), options,
                    progress](std::size_t mesh) {
    announce(progress, "import " + paths[mesh].filename().string());
    return import_mesh(paths[mesh], options);
  };
  return input;
}

}  // namespace boxtree::cooker
