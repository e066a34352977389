// SPDX-License-Identifier: MIT
// Chooses the reader of a file by the extension of its name.
#include "cooker/import/import.h"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "cooker/import/assimp_import.h"
#include "cooker/import/exception_error.h"
#include "cooker/import/f32_digits.h"
#include "cooker/import/face_materials.h"
#include "cooker/import/file_error.h"
#include "cooker/import/foreign_file.h"
#include "cooker/import/obj_import.h"
#include "cooker/import/off_import.h"
#include "cooker/import/ply_import.h"
#include "cooker/import/source_files.h"
#include "cooker/import/source_scene.h"
#include "cooker/import/stl_import.h"
#include "cooker/import/text_tokens.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

struct Request {
  const SourceFile source;
  const ImportOptions& options;
  ImportWanted wanted;
};

// Formats with one mesh and no nodes. Only OBJ has materials.
struct MeshReader {
  const char* extension;
  bool has_user_data;  // of faces
  Status (*read)(const SourceFile& source, const ImportOptions& options, Imported& out,
                 FaceMaterials& materials);
};

template <Status (*read)(const SourceFile&, const ImportOptions&, Imported&)>
Status without_materials(const SourceFile& source, const ImportOptions& options, Imported& out,
                         FaceMaterials& /*materials*/) {
  return read(source, options, out);
}

constexpr std::array kMeshReaders = {
    MeshReader{"obj", true, import_obj},
    MeshReader{"off", false, without_materials<import_off>},
    MeshReader{"ply", true, without_materials<import_ply>},
    MeshReader{"stl", false, without_materials<import_stl>},
};

SourceScene scene_of(Imported&& imported, FaceMaterials&& materials, const std::string& name) {
  SourceScene scene;
  scene.report = std::move(imported.report);
  const auto source_faces = static_cast<std::uint32_t>(scene.report.source_faces);
  scene.meshes.push_back({std::move(imported.mesh), source_faces, std::move(materials.runs),
                          std::move(imported.user_data)});
  scene.meshes[0].mesh.name = name;
  scene.materials = std::move(materials.names);
  scene.instances.push_back({name, 0, 0, Pose::Identity()});
  return scene;
}

// Whether it is worth another reading to know what f32 has to do with that.
bool is_mostly_flat(const ImportReport& report) {
  return report.degenerate_faces > 0 && 2 * report.degenerate_faces >= report.source_faces;
}

Status measure_digits(const MeshReader& reader, const Request& request, Imported& mesh) {
  const Positions& positions = mesh.mesh.positions;
  const bool may_be_flattened = is_mostly_flat(mesh.report);
  if (positions.precision != Precision::kF32 || mesh.report.has_f32_alone ||
      !(request.options.count_moves || may_be_flattened || may_have_moved(positions))) {
    return {};
  }
  ImportOptions options = request.options;
  options.precision = Precision::kF64;
  Imported exact;
  FaceMaterials materials;
  if (Status status = reader.read(request.source, options, exact, materials); !status.ok()) {
    return status;
  }
  const double moved = moved_by_f32(exact.mesh.positions);
  const bool is_told = moved > unnoticed_move(positions);
  if (is_told) mesh.report.moved_by_f32 = moved;
  if (is_told || request.options.count_moves) mesh.mesh.moved_by_f32 = moved;
  if (may_be_flattened) {
    // f32 can give a face an area, too: three points on a line that it moves off each other.
    mesh.report.flattened_by_f32 =
        mesh.report.degenerate_faces -
        std::min(mesh.report.degenerate_faces, exact.report.degenerate_faces);
  }
  return {};
}

Status read_mesh(const MeshReader& reader, const Request& request, ImportedFile& out) {
  Imported mesh;
  FaceMaterials materials;
  if (Status status = reader.read(request.source, request.options, mesh, materials); !status.ok()) {
    return status;
  }
  if (Status status = measure_digits(reader, request, mesh); !status.ok()) return status;
  if (request.wanted == ImportWanted::kScene) {
    out = scene_of(std::move(mesh), std::move(materials), request.source.path().stem().string());
  } else {
    if (request.options.materials) mesh.materials = std::move(materials);
    out = std::move(mesh);
  }
  return {};
}

bool has_mesh_ending(const fs::path& path) {
  const std::string ending = path.extension().string();
  return !ending.empty() && is_mesh_ending(ending.substr(1));
}

// A file of another kind, or one whose ending no reader knows, in the place of a mesh. The error of
// the reader that was chosen by the ending or the first bytes would be about a format that nobody
// meant.
Error explained(const SourceFile& source, const Error& error) {
  if (error.code != Errc::kImportFailed && error.code != Errc::kNoFaces) return error;
  const std::string& title = source.title();
  const auto is = [&](const char* format) { return has_extension(source.path(), format); };
  if ((is("gltf") || is("off") || is("ply") || is("stl")) && begins_with_mark(source)) {
    return {error.code,
            title +
                ": it begins with a byte order mark (EF BB BF), which its format has not: save "
                "it as UTF-8 without one"};
  }
  if (const char* const what = foreign_file(source)) {
    return {error.code, fmt::format("{}: expected a mesh, found {}", title, what)};
  }
  const std::string ending = source.path().extension().string();
  if (const char* const meant = misnamed_mesh(source); meant != nullptr && !ending.empty()) {
    return {error.code,
            fmt::format("{0}: expected what {1} files hold, found one that begins as {2} "
                        "files do: rename it to end in {2}",
                        title, ending, meant)};
  }
  if (has_mesh_ending(source.path())) return error;
  const char* const remedy = ending == ".toml" ? "; cook --profile takes a profile" : "";
  return {
      error.code,
      fmt::format("{}: expected a mesh by its ending: .obj, .off, .ply, .stl, .gltf, .glb, .fbx, "
                  ".dae or another one that assimp reads; found {}{}",
                  title, ending.empty() ? "none" : ending, remedy)};
}

Result<ImportedFile> import_checked(const Request& request) {
  const fs::path& path = request.source.path();
  if (Status status = check_source_file(request.source); !status.ok()) return status.error();
  // Not by its first bytes, as assimp would: an OBJ without its ending became another mesh than
  // with it.
  if (!has_mesh_ending(path)) return explained(request.source, Error{Errc::kImportFailed, {}});
  const MeshReader* const reader = find_extension(kMeshReaders, path);
  const bool has_user_data = reader != nullptr ? reader->has_user_data : is_gltf(path);
  if (!request.options.user_data.empty() && !has_user_data) {
    return Error{
        Errc::kMeshUnsupported,
        fmt::format("{}: user data of faces '{}': expected a PLY file, whose faces have "
                    "properties, an OBJ file, which has {}, or a glTF file, which has {} "
                    "and extras",
                    request.source.title(), request.options.user_data, kGroups, kPrimitives)};
  }
  if (!request.options.face_ids.empty() && !has_extension(path, "ply")) {
    return Error{Errc::kMeshUnsupported,
                 fmt::format("{}: ids of faces '{}': expected a PLY file, whose faces have "
                             "properties",
                             request.source.title(), request.options.face_ids)};
  }
  ImportedFile out;
  const Status status =
      reader != nullptr ? read_mesh(*reader, request, out)
                        : import_with_assimp(request.source, request.options, request.wanted, out);
  if (!status.ok()) return explained(request.source, status.error());
  std::visit(
      [&](auto& imported) {
        imported.report.has_f32_alone &= request.options.precision == Precision::kF64;
      },
      out);
  const bool wants_materials = request.options.materials;
  if (auto* mesh = std::get_if<Imported>(&out)) {
    mesh->mesh.name = path.stem().string();
    mesh->report.has_no_materials = wants_materials && mesh->materials.runs.empty();
  }
  if (auto* scene = std::get_if<SourceScene>(&out)) {
    scene->name = path.stem().string();
    scene->report.has_no_materials = wants_materials && scene->materials.empty();
  }
  return out;
}

Result<ImportedFile> import_guarded(const fs::path& path, const ImportOptions& options,
                                    ImportWanted wanted) {
  try {
    return import_checked({SourceFile(path, options.bytes), options, wanted});
  } catch (...) {
    return in_file(SourceFile(path, options.bytes).title(), error_of_exception());
  }
}

// T is Imported or SourceScene.
template <class T>
Result<T> only(Result<ImportedFile>&& file) {
  if (!file.ok()) return file.error();
  return std::get<T>(std::move(*file));
}

}  // namespace

Result<Imported> import_mesh(const fs::path& path, const ImportOptions& options) {
  return only<Imported>(import_guarded(path, options, ImportWanted::kMesh));
}

Result<SourceScene> import_scene(const fs::path& path, const ImportOptions& options) {
  return only<SourceScene>(import_guarded(path, options, ImportWanted::kScene));
}

Result<ImportedFile> import_file(const fs::path& path, const ImportOptions& options) {
  return import_guarded(path, options, ImportWanted::kFitting);
}

Result<std::vector<fs::path>> list_source_files(const fs::path& path,
                                                const ImportOptions& options) {
  Result<SourceFileList> found = find_source_files(path, options);
  if (!found) return found.error();
  return std::move(found->files);
}

Result<SourceFileList> find_source_files(const fs::path& path, const ImportOptions& options) {
  const SourceFile source(path, options.bytes);
  try {
    if (Status status = check_source_file(source); !status.ok()) return status.error();
    if (!has_mesh_ending(source.path())) return explained(source, Error{Errc::kImportFailed, {}});
    if (has_extension(source.path(), "obj")) return list_obj_files(source);
    if (has_node_graph(source.path())) return list_assimp_files(source, options);
    SourceFileList found;
    if (!source.bytes()) found.files = {tidied(source.path())};
    return found;
  } catch (...) {
    return in_file(source.title(), error_of_exception());
  }
}

bool may_refer_to_files(const fs::path& path) {
  return has_extension(path, "obj") || has_node_graph(path);
}

bool has_node_graph(const fs::path& path) {
  return find_extension(kMeshReaders, path) == nullptr;
}

bool is_mesh_ending(std::string_view ending) {
  static const std::vector<std::string> endings = mesh_endings();
  return std::binary_search(endings.begin(), endings.end(), in_lower_case(ending));
}

std::vector<std::string> mesh_endings() {
  std::vector<std::string> endings = assimp_endings();
  for (const MeshReader& reader : kMeshReaders) endings.emplace_back(reader.extension);
  std::sort(endings.begin(), endings.end());
  endings.erase(std::unique(endings.begin(), endings.end()), endings.end());
  return endings;
}

}  // namespace boxtree::cooker
