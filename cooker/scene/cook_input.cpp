// SPDX-License-Identifier: MIT
// Collects meshes and instances; numbers of a later file follow those of the earlier ones.
#include "cooker/scene/cook_input.h"

#include <cerrno>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "cooker/import/file_error.h"
#include "cooker/system/input_failure.h"
#include "cooker/system/path.h"
#include "format/limits.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// Joins several scenes into one; equal meshes are stored once, as in the scene of one file.
class SceneJoin {
 public:
  explicit SceneJoin(SourceScene& scene)
      : scene_(scene), meshes_(scene.meshes), materials_(scene.materials) {}

  void add(SourceScene from) {
    const std::vector<std::uint32_t> materials = materials_.add(from.materials);
    std::vector<std::uint32_t> meshes;  // their numbers here
    for (SceneMesh& mesh : from.meshes) {
      renumber(mesh.materials, materials);
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
  SourceScene& scene_;
  MeshMerger meshes_;
  MaterialJoin materials_;
};

void note_import(CookInput& input, ImportReport&& report, std::string name) {
  input.imports.push_back(std::move(report));
  input.import_names.push_back(std::move(name));
}

// What a profile lists, as one mesh; with its materials, unless nodes are flattened.
Result<SourceScene> import_listed(const fs::path& path, const ImportOptions& options) {
  if (!has_node_graph(path)) return import_scene(path, options);
  Result<Imported> imported = import_mesh(path, options);
  if (!imported) return imported.error();
  SourceScene scene;
  scene.report = std::move(imported->report);
  scene.meshes.push_back({std::move(imported->mesh), {}});
  return scene;
}

// Whether a file that the profile names by `key` is there, since its name counts from the folder of
// the profile.
Status check_named(const Profile& profile, std::string_view key, const Stated<fs::path>& file) {
  std::error_code error;
  if (status_of(file.value, error).type() != fs::file_type::not_found) return {};
  const std::string path = profile.path.string();
  return in_file(fmt::format("{}:{}: {}", path, file.line, key),
                 input_failure(file.value.string(), ENOENT, path));
}

// Each mesh of a profile becomes a mesh of the scene. A file that several name is read once for
// each, because each may be cooked differently.
Result<CookInput> load_listed(const Profile& profile, const ImportOptions& options,
                              const Progress& progress) {
  CookInput input;
  input.scene.name = profile.path.stem().string();
  MaterialJoin materials(input.scene.materials);
  std::vector<std::uint32_t> numbers;  // the scene's numbers of the profile's meshes
  for (const ProfileMesh& listed : profile.meshes) {
    numbers.push_back(static_cast<std::uint32_t>(input.scene.meshes.size()));
    if (!listed.file) continue;
    if (Status status = check_named(profile, "file", *listed.file); !status) return status.error();
    const std::string name = listed.file->value.filename().string();
    announce(progress, "import " + name);
    Result<SourceScene> imported = import_listed(listed.file->value, options);
    if (!imported) return imported.error();
    SceneMesh& mesh = imported->meshes.front();
    mesh.mesh.name = listed.name.value;
    renumber(mesh.materials, materials.add(imported->materials));
    input.scene.meshes.push_back(std::move(mesh));
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

Result<std::vector<fs::path>> scene_files(std::span<const fs::path> inputs,
                                          const Profile& profile) {
  const bool is_listed = !profile.instances.empty();
  const bool has_source = is_listed || profile.source.has_value();
  if (has_source == !inputs.empty()) {
    const std::string place = profile.path.empty() ? "the scene" : profile.path.string();
    return Error{
        Errc::kProfileInvalid,
        place + (has_source ? ": names what to cook; leave MESH out of the command, or "
                              "\"source\" and [[instance]] out of the profile"
                            : ": names nothing to cook; give MESH in the command, or \"source\" "
                              "or [[instance]] in a profile")};
  }
  std::vector<fs::path> files;
  if (is_listed) {
    for (const ProfileMesh& mesh : profile.meshes) {
      if (mesh.file) files.push_back(mesh.file->value);
    }
  } else if (profile.source) {
    files.push_back(profile.source->value);
  } else {
    files.assign(inputs.begin(), inputs.end());
  }
  return files;
}

Result<CookInput> load_scene(std::span<const fs::path> inputs, const Profile& profile,
                             const ImportOptions& options, const Progress& progress) {
  const Result<std::vector<fs::path>> files = scene_files(inputs, profile);
  if (!files) return files.error();
  if (!profile.instances.empty()) return load_listed(profile, options, progress);
  if (profile.source) {
    if (Status status = check_named(profile, "source", *profile.source); !status) {
      return status.error();
    }
  }
  CookInput input;
  std::optional<SceneJoin> join;  // of the first and all others
  for (const fs::path& file : *files) {
    const SourceFile source(file, options.bytes);
    announce(progress, "import " + source.short_title());
    Result<SourceScene> scene = import_scene(file, options);
    if (!scene) return scene.error();
    note_import(input, std::move(scene->report), source.path().filename().string());
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
  const SourceFile source(path, options.bytes);
  announce(progress, "import " + source.short_title());
  Result<ImportedFile> file = import_file(path, options);
  if (!file) return file.error();
  CookInput input;
  if (auto* mesh = std::get_if<Imported>(&*file)) {
    input.has_top_level = false;
    note_import(input, std::move(mesh->report), mesh->mesh.name);
    input.scene.meshes.push_back(
        {std::move(mesh->mesh), {}, std::move(mesh->materials.runs), std::move(mesh->user_data)});
    input.scene.materials = std::move(mesh->materials.names);
  } else {
    input.scene = std::move(std::get<SourceScene>(*file));
    note_import(input, std::move(input.scene.report), source.path().filename().string());
  }
  return input;
}

Result<CookInput> load_trees(std::span<const fs::path> inputs, const ImportOptions& options,
                             const Progress& progress) {
  // Reported before hours of work, not after.
  if (inputs.size() > kMaxTrees) {
    return Error{Errc::kMeshTooLarge,
                 fmt::format("{} inputs, each a tree: a file holds {} at most; "
                             "cook files of their own, and pack these",
                             inputs.size(), kMaxTrees)};
  }
  CookInput input;
  input.has_top_level = false;
  input.scene.meshes.resize(inputs.size());
  for (const fs::path& path : inputs) {
    input.import_names.push_back(SourceFile(path, options.bytes).path().stem().string());
  }
  input.importer = [paths = std::vector(inputs.begin(), inputs.end()), options,
                    progress](std::size_t mesh) {
    announce(progress, "import " + SourceFile(paths[mesh], options.bytes).short_title());
    return import_mesh(paths[mesh], options);
  };
  return input;
}

}  // namespace boxtree::cooker
