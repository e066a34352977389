// SPDX-License-Identifier: MIT
// import_mesh, import_scene: our own reader, or one assimp import without post-processing, checked
// before and after.
#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/scene.h>

#include <boxtree/cooker/import/binary_ply.h>
#include <boxtree/cooker/import/binary_stl.h>
#include <boxtree/cooker/import/exception_error.h>
#include <boxtree/cooker/import/file_error.h>
#include <boxtree/cooker/import/flatten.h>
#include <boxtree/cooker/import/gltf_nesting.h>
#include <boxtree/cooker/import/header_checks.h>
#include <boxtree/cooker/import/import.h>
#include <boxtree/cooker/import/node_graph.h>
#include <boxtree/cooker/import/obj_text.h>
#include <boxtree/cooker/import/off_text.h>
#include <boxtree/cooker/import/ply_header.h>
#include <boxtree/cooker/import/ply_positions.h>
#include <boxtree/cooker/import/scene_intake.h>
#include <boxtree/cooker/import/source_files.h>
#include <boxtree/cooker/import/source_scene.h>
#include <boxtree/cooker/import/text_checks.h>
#include <boxtree/cooker/import/text_ends.h>
#include <boxtree/cooker/import/text_ply.h>
#include <boxtree/cooker/import/text_stl.h>
#include <boxtree/cooker/import/text_tokens.h>
#include <boxtree/cooker/import/trial.h>
#include <boxtree/cooker/import/whole_file.h>

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

enum class FaceOrder : std::uint8_t { kOfFile, kByMaterial };

// What assimp's readers make up, leave out or reorder unless told otherwise, and what costs time
// without being geometry.
void configure(Assimp::Importer& importer, FaceOrder order) {
  // Made up: a mesh around the bones of a file without meshes.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  // Made up: faces of a subdivision surface instead of those in the file.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_AC_EVAL_SUBDIVISION, false);
  // Made up: other files, found by their names, joined to the one asked for.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_MD3_HANDLE_MULTIPART, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_MD5_NO_ANIM_AUTOLOAD, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_SMD_LOAD_ANIMATION_LIST, false);
  // Reordered: faces sorted by material.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_MATERIALS, order == FaceOrder::kByMaterial);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_AC_SEPARATE_BFCULL, false);
  // Not geometry.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_TEXTURES, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_CAMERAS, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_LIGHTS, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_WEIGHTS, false);
}

// A file's text as assimp is to see it, under the name that tells it the format.
struct StandIn {
  std::string name;
  std::string text;
  KnownFaults known;
  ExactPositions exact;
};

// Reads the scene, from the file or from what stands in for it; the files read are noted in
// `files`. Errors do not name the file. No post-processing flags: each of them may drop, reorder,
// merge or generate.
Result<std::unique_ptr<aiScene>> read_scene(const fs::path& path, const StandIn* stand_in,
                                            FaceOrder order, std::vector<fs::path>& files) {
  const CLocaleScope numbers_in_c_locale;
  Assimp::Importer importer;
  configure(importer, order);
  auto io = std::make_unique<RecordingIo>(files);
  if (stand_in != nullptr) io->replace(stand_in->name, stand_in->text, path);
  importer.SetIOHandler(io.release());  // the importer owns it from here
  if (importer.ReadFile(stand_in != nullptr ? stand_in->name : path.string(), 0) == nullptr) {
    const std::string why = importer.GetErrorString();
    if (why == std::bad_alloc().what()) throw std::bad_alloc();  // as when we run out of memory
    return Error{Errc::kImportFailed, why.empty() ? "no scene" : why};
  }
  return std::unique_ptr<aiScene>(importer.GetOrphanedScene());
}

enum class Wanted : std::uint8_t { kMesh, kScene, kFitting };

struct Request {
  const fs::path& path;
  const ImportOptions& options;
  Wanted wanted;
};

ImportReport& report_of(ImportedFile& file) {
  return std::visit([](auto& imported) -> ImportReport& { return imported.report; }, file);
}

// Formats of meshes. Groups of an OBJ file are nodes to assimp, but all of them are in one space.
bool has_node_graph(const fs::path& path) {
  return !has_extension(path, "obj") && !has_extension(path, "off") &&
         !has_extension(path, "ply") && !has_extension(path, "stl");
}

// Runs of materials, and the materials themselves in `scene`. Where assimp cannot read them they
// are not known; the geometry it has read.
std::vector<MeshMaterials> read_fbx_materials(const fs::path& path, aiScene& scene) {
  std::vector<fs::path> read_already;
  const auto sorted = read_scene(path, nullptr, FaceOrder::kByMaterial, read_already);
  return sorted.ok() ? match_materials(scene, *sorted.value()) : std::vector<MeshMaterials>();
}

Status take_over(const Request& request, aiScene& scene, SourceContext context,
                 ImportReport&& report, ImportedFile& out) {
  const Placements placements = find_placements(scene);
  const bool has_graph = has_node_graph(request.path);
  const bool is_scene =
      request.wanted == Wanted::kScene ||
      (request.wanted == Wanted::kFitting && has_graph && places_several(scene, placements));
  if (!is_scene) {
    Imported& mesh = out.emplace<Imported>();
    mesh.report = std::move(report);
    std::vector<MaterialRun> unwanted;
    return flatten_scene(scene, placements, context, mesh, unwanted);
  }
  SourceScene& whole = out.emplace<SourceScene>();
  whole.report = std::move(report);
  std::vector<MeshMaterials> materials;
  if (has_extension(request.path, "fbx")) materials = read_fbx_materials(request.path, scene);
  context.materials = materials;
  return has_graph ? take_scene(scene, placements, context, whole)
                   : take_whole(scene, placements, context, request.path.stem().string(), whole);
}

// All that assimp is going to read, read in a copy of this process.
Status try_reading(const fs::path& path) {
  std::error_code unknown;
  const std::uintmax_t bytes = fs::file_size(path, unknown);
  return try_in_child(trial_limits(unknown ? 0 : bytes), [&path] {
    std::vector<fs::path> files;
    const auto scene = read_scene(path, nullptr, FaceOrder::kOfFile, files);
    if (!scene.ok()) return Status(scene.error());
    if (has_extension(path, "fbx")) {  // once more for its materials
      static_cast<void>(read_scene(path, nullptr, FaceOrder::kByMaterial, files));
    }
    return Status();
  });
}

Status import_once(const Request& request, const StandIn* stand_in, ImportedFile& out) {
  const fs::path& path = request.path;
  if (Status status = check_ply_header(path); !status.ok()) return status;
  if (Status status = check_gltf_nesting(path); !status.ok()) return status;
  if (stand_in == nullptr && request.options.try_first) {
    const Status tried = try_reading(path);
    if (!tried.ok()) return in_file(path, tried.error());
  }
  ImportReport report;
  auto scene = read_scene(path, stand_in, FaceOrder::kOfFile, report.files_read);
  if (!scene.ok()) return in_file(path, scene.error());
  if (Status status = check_gltf_faces(path, *scene.value()); !status.ok()) return status;
  static const StandIn kNone;
  const StandIn& aside = stand_in != nullptr ? *stand_in : kNone;
  const SourceContext context{request.options, path.string(), aside.known, aside.exact};
  return take_over(request, *scene.value(), context, std::move(report), out);
}

// Calls `read_text(file's text, stand-in)` to make what assimp is to see as `name`, and imports it.
template <class Read>
Status import_text(const Request& request, const std::string& name, const Read& read_text,
                   ImportedFile& out) {
  const fs::path& path = request.path;
  Result<std::string> file = read_whole_file(path, kAnyBytes);
  if (!file.ok()) return file.error();
  StandIn seen{name, {}, {}, ExactPositions(request.options.precision)};
  Result<std::string> text = read_text(file.value(), seen.known, seen.exact);
  if (!text.ok()) return in_file(path, text.error());
  const bool is_open = has_open_end(*file);
  file.value() = std::string();  // not to stand beside what assimp makes of it
  seen.text = std::move(text).value();
  if (Status status = import_once(request, &seen, out); !status.ok()) return status;
  report_of(out).has_open_end = is_open;
  return {};
}

// Old Macintosh files end lines by a carriage return alone, which readers of PLY do not know.
std::string with_line_feeds(std::string text) {
  if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
  return text;
}

// A file whose vertices cannot be found is read as any other.
Status import_ply(const Request& request, ImportedFile& out) {
  const fs::path& path = request.path;
  Result<std::string> file = read_whole_file(path, kAnyBytes);
  if (!file.ok()) return file.error();
  StandIn numbered{path.string(),
                   with_line_feeds(std::move(file).value()),
                   {},
                   ExactPositions(request.options.precision)};
  if (Status status = check_ply_text(numbered.text); !status.ok()) {
    return in_file(path, status.error());
  }
  const std::optional<PlyHeader> header = read_ply_header(numbered.text);
  const bool is_open =
      header && header->form == PlyHeader::Form::kText && has_open_end(numbered.text);
  const bool is_numbered = number_ply_vertices(numbered.text, numbered.exact);
  if (!is_numbered) numbered.text = std::string();
  if (Status status = import_once(request, is_numbered ? &numbered : nullptr, out); !status.ok()) {
    return status;
  }
  report_of(out).has_open_end = is_open;
  return {};
}

// Texts of which assimp takes the beginning for the whole.
struct TextCheck {
  const char* extension;
  Status (*check)(std::string_view file);
};
constexpr std::array kTextChecks = {
    TextCheck{"ac", check_ac_end},
    TextCheck{"ase", check_blocks_end},
    TextCheck{"dxf", check_dxf_end},
    TextCheck{"md5mesh", check_blocks_end},
};

Status check_text(const fs::path& path) {
  for (const TextCheck& format : kTextChecks) {
    if (!has_extension(path, format.extension)) continue;
    const Result<std::string> file = read_whole_file(path, kAnyBytes);
    if (!file.ok()) return file.error();
    if (Status status = format.check(*file); !status.ok()) return in_file(path, status.error());
  }
  return {};
}

Status import_any(const Request& request, ImportedFile& out) {
  const fs::path& path = request.path;
  if (has_extension(path, "obj")) {
    return import_text(request, path.string(), obj_for_assimp, out);
  }
  if (has_extension(path, "off")) {
    return import_text(request, path.string() + ".obj", obj_from_off, out);
  }
  if (has_extension(path, "ply")) return import_ply(request, out);
  if (Status status = check_text(path); !status.ok()) return status;
  return import_once(request, nullptr, out);
}

// Read past assimp, each if it says so. What of a format no reader takes is for assimp.
struct MeshReader {
  const char* extension;
  Result<bool> (*import)(const fs::path& path, const ImportOptions& options, Imported& out);
};
constexpr std::array kReaders = {
    MeshReader{"ply", import_binary_ply},
    MeshReader{"ply", import_text_ply},
    MeshReader{"stl", import_binary_stl},
    MeshReader{"stl", import_text_stl},
};

// False if this file is for assimp.
Result<bool> import_directly(const Request& request, ImportedFile& out) {
  const fs::path& path = request.path;
  Imported mesh;
  Result<bool> is_read = false;
  for (const auto& [extension, import] : kReaders) {
    if (!has_extension(path, extension)) continue;
    is_read = import(path, request.options, mesh);
    if (!is_read.ok() || is_read.value()) break;
  }
  if (!is_read.ok() || !is_read.value()) return is_read;
  if (request.wanted == Wanted::kScene) {
    out = scene_of(std::move(mesh), path.stem().string());
  } else {
    out = std::move(mesh);
  }
  return true;
}

Result<ImportedFile> import_checked(const Request& request) {
  const fs::path& path = request.path;
  if (Status status = check_source_file(path); !status.ok()) return status.error();
  ImportedFile out;
  const Result<bool> is_read = import_directly(request, out);
  if (!is_read.ok()) return is_read.error();
  if (!is_read.value()) {
    const Status status = import_any(request, out);
    if (!status.ok()) return status.error();
    // Hashed only now, so that a refused file costs no second reading.
    const Result<std::uint64_t> hash = hash_source_files(report_of(out).files_read);
    if (!hash.ok()) return hash.error();
    report_of(out).content_hash = hash.value();
  }
  if (auto* mesh = std::get_if<Imported>(&out)) mesh->mesh.name = path.stem().string();
  if (auto* scene = std::get_if<SourceScene>(&out)) scene->name = path.stem().string();
  return out;
}

Result<ImportedFile> import_guarded(const Request& request) {
  try {
    return import_checked(request);
  } catch (...) {
    return in_file(request.path, error_of_exception());
  }
}

// Imported or SourceScene, whichever was asked for.
template <class T>
Result<T> only(Result<ImportedFile>&& file) {
  if (!file.ok()) return file.error();
  return std::get<T>(std::move(*file));
}

}  // namespace

Result<Imported> import_mesh(const fs::path& path, const ImportOptions& options) {
  return only<Imported>(import_guarded({path, options, Wanted::kMesh}));
}

Result<SourceScene> import_scene(const fs::path& path, const ImportOptions& options) {
  return only<SourceScene>(import_guarded({path, options, Wanted::kScene}));
}

Result<ImportedFile> import_file(const fs::path& path, const ImportOptions& options) {
  return import_guarded({path, options, Wanted::kFitting});
}

}  // namespace boxtree::cooker
