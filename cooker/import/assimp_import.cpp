// SPDX-License-Identifier: MIT
// import_mesh: our own reader, or one assimp import without post-processing, checked before and
// after.
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <utility>

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/scene.h>

#include <boxtree/cooker/import/binary_ply.h>
#include <boxtree/cooker/import/binary_stl.h>
#include <boxtree/cooker/import/flatten.h>
#include <boxtree/cooker/import/header_checks.h>
#include <boxtree/cooker/import/import.h>
#include <boxtree/cooker/import/obj_faults.h>
#include <boxtree/cooker/import/off_text.h>
#include <boxtree/cooker/import/ply_positions.h>
#include <boxtree/cooker/import/source_files.h>
#include <boxtree/cooker/import/text_tokens.h>

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

// What assimp's readers make up, leave out or reorder unless told otherwise, and what costs time
// without being geometry.
void configure(Assimp::Importer& importer) {
  // Made up: a mesh around the bones of a file without meshes.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  // Made up: faces of a subdivision surface instead of those in the file.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_AC_EVAL_SUBDIVISION, false);
  // Made up: other files, found by their names, joined to the one asked for.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_MD3_HANDLE_MULTIPART, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_MD5_NO_ANIM_AUTOLOAD, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_SMD_LOAD_ANIMATION_LIST, false);
  // Reordered: faces sorted by material.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_MATERIALS, false);
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
// `files`. No post-processing flags: each of them may drop, reorder, merge or generate.
Result<std::unique_ptr<aiScene>> read_scene(const fs::path& path, const StandIn* stand_in,
                                            std::vector<fs::path>& files) {
  const CLocaleScope numbers_in_c_locale;
  Assimp::Importer importer;
  configure(importer);
  auto io = std::make_unique<RecordingIo>(files);
  if (stand_in != nullptr) io->replace(stand_in->name, stand_in->text, path);
  importer.SetIOHandler(io.release());  // the importer owns it from here
  if (importer.ReadFile(stand_in != nullptr ? stand_in->name : path.string(), 0) == nullptr) {
    const std::string why = importer.GetErrorString();
    return Error{Errc::kImportFailed, path.string() + ": " + (why.empty() ? "no scene" : why)};
  }
  return std::unique_ptr<aiScene>(importer.GetOrphanedScene());
}

Status import_once(const fs::path& path, const ImportOptions& options, const StandIn* stand_in,
                   Imported& out) {
  out = Imported();
  if (Status status = check_ply_header(path); !status.ok()) return status;
  auto scene = read_scene(path, stand_in, out.report.files_read);
  if (!scene.ok()) return scene.error();
  if (Status status = check_gltf_faces(path, *scene.value()); !status.ok()) return status;
  static const StandIn kNone;
  const StandIn& aside = stand_in != nullptr ? *stand_in : kNone;
  return flatten_scene(*scene.value(), options, path.string(), aside.known, aside.exact, out);
}

Error in_file(const fs::path& path, const Error& error) {
  return Error{error.code, path.string() + ": " + error.detail};
}

// Assimp refuses an OBJ file with one bad vertex number as a whole and says not where, and numbers
// its vertices anew. So when an OBJ file fails, look at its text, mark what is wrong, and import it
// once more: then each bad face is known by its number, its line and its own vertex number.
Status import_obj(const fs::path& path, const ImportOptions& options, Imported& out) {
  Result<std::string> text = read_source_file(path);
  if (!text.ok()) return text.error();
  const Result<bool> is_unknown = has_unknown_vertex_forms(text.value());
  if (!is_unknown.ok()) return in_file(path, is_unknown.error());
  const bool is_exact = options.precision == Precision::kF64;
  Status status;
  if (!is_unknown.value() && !is_exact) {
    text.value() = std::string();  // not to stand beside assimp's own copy
    status = import_once(path, options, nullptr, out);
    if (status.ok() && out.report.skipped.empty()) return status;
    text = read_source_file(path);
    if (!text.ok()) return text.error();
  }
  StandIn marked{path.string(), std::move(text).value(), {}, {}};
  bool changed = false;
  marked.known = mark_obj_faults(marked.text, changed, is_exact ? &marked.exact : nullptr);
  return changed || is_exact ? import_once(path, options, &marked, out) : status;
}

Status import_off(const fs::path& path, const ImportOptions& options, Imported& out) {
  Result<std::string> off = read_source_file(path);
  if (!off.ok()) return off.error();
  StandIn obj{path.string() + ".obj", {}, {}, {}};
  const bool is_exact = options.precision == Precision::kF64;
  Result<std::string> text = obj_from_off(off.value(), obj.known, is_exact ? &obj.exact : nullptr);
  if (!text.ok()) return in_file(path, text.error());
  off.value() = std::string();
  obj.text = std::move(text).value();
  return import_once(path, options, &obj, out);
}

// Files of text, for f64. A file whose vertices cannot be found is read as any other: with f32
// positions.
Status import_exact_ply(const fs::path& path, const ImportOptions& options, Imported& out) {
  Result<std::string> file = read_source_file(path);
  if (!file.ok()) return file.error();
  StandIn numbered{path.string(), std::move(file).value(), {}, {}};
  const bool is_numbered = number_ply_vertices(numbered.text, numbered.exact);
  return import_once(path, options, is_numbered ? &numbered : nullptr, out);
}

Status import_any(const fs::path& path, const ImportOptions& options, Imported& out) {
  if (has_extension(path, "obj")) return import_obj(path, options, out);
  if (has_extension(path, "off")) return import_off(path, options, out);
  const bool is_exact = options.precision == Precision::kF64;
  if (is_exact && has_extension(path, "ply")) return import_exact_ply(path, options, out);
  return import_once(path, options, nullptr, out);
}

// Formats of large meshes, read past assimp. False if this file is for assimp.
Result<bool> import_directly(const fs::path& path, const ImportOptions& options, Imported& out) {
  if (has_extension(path, "ply")) return import_binary_ply(path, options, out);
  if (has_extension(path, "stl")) return import_binary_stl(path, options, out);
  return false;
}

Result<Imported> import_checked(const fs::path& path, const ImportOptions& options) {
  if (Status status = check_source_file(path); !status.ok()) return status.error();
  Imported out;
  const Result<bool> is_read = import_directly(path, options, out);
  if (!is_read.ok()) return is_read.error();
  if (!is_read.value()) {
    const Status status = import_any(path, options, out);
    if (!status.ok()) return status.error();
    // Hashed only now, so that a refused file costs no second reading.
    const Result<std::uint64_t> hash = hash_source_files(out.report.files_read);
    if (!hash.ok()) return hash.error();
    out.report.content_hash = hash.value();
  }
  out.mesh.name = path.stem().string();
  return out;
}

}  // namespace

Result<Imported> import_mesh(const fs::path& path, const ImportOptions& options) {
  try {
    return import_checked(path, options);
  } catch (const std::bad_alloc&) {
    return Error{Errc::kMeshTooLarge, path.string() + ": not enough memory to import it"};
  } catch (const std::exception& error) {
    return Error{Errc::kImportFailed, path.string() + ": " + error.what()};
  } catch (...) {
    return Error{Errc::kImportFailed, path.string() + ": unknown exception while reading"};
  }
}

}  // namespace boxtree::cooker
