// SPDX-License-Identifier: MIT
// Runs one assimp import without post-processing, with checks before and after.
#include "cooker/import/assimp_import.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <new>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include <assimp/Importer.hpp>
#include <assimp/commonMetaData.h>
#include <assimp/config.h>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>
#include <assimp/version.h>
#include <fmt/format.h>

#include "cooker/import/collada_values.h"
#include "cooker/import/f32_digits.h"
#include "cooker/import/face_materials.h"
#include "cooker/import/file_error.h"
#include "cooker/import/flatten.h"
#include "cooker/import/gltf_document.h"
#include "cooker/import/gltf_extensions.h"
#include "cooker/import/gltf_positions.h"
#include "cooker/import/gltf_primitives.h"
#include "cooker/import/gltf_stated_faces.h"
#include "cooker/import/gltf_unread.h"
#include "cooker/import/gltf_user_data.h"
#include "cooker/import/gltf_values.h"
#include "cooker/import/node_graph.h"
#include "cooker/import/reader_log.h"
#include "cooker/import/recording_io.h"
#include "cooker/import/scene_hash.h"
#include "cooker/import/scene_intake.h"
#include "cooker/import/source_files.h"
#include "cooker/import/text_ends.h"
#include "cooker/import/text_tokens.h"
#include "cooker/import/trial.h"

namespace boxtree::cooker {
namespace {

enum class ReadOrder : std::uint8_t { kOfFile, kByMaterial };

// Turns off what assimp's readers add, omit or reorder by default, and work on data other than
// geometry.
void configure(Assimp::Importer& importer, ReadOrder order) {
  // Added: a mesh around the bones of a file without meshes.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  // Added: faces of a subdivision surface instead of those in the file.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_AC_EVAL_SUBDIVISION, false);
  // Added: other files, found by their names, joined to the one requested.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_MD3_HANDLE_MULTIPART, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_MD5_NO_ANIM_AUTOLOAD, true);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_SMD_LOAD_ANIMATION_LIST, false);
  // Reordered: faces sorted by material.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_MATERIALS, order == ReadOrder::kByMaterial);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_AC_SEPARATE_BFCULL, false);
  // Turned: what a Collada file says is up.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  // Not geometry.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_TEXTURES, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_CAMERAS, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_LIGHTS, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_WEIGHTS, false);
}

// Text formats of which assimp accepts a truncated file.
struct TextFormat {
  const char* extension;
  Status (*check_end)(std::string_view file);  // null if the format defines no end
};
constexpr std::array kTextFormats = {
    TextFormat{"ac", check_ac_end},   TextFormat{"ase", check_blocks_end},
    TextFormat{"dxf", check_dxf_end}, TextFormat{"md5mesh", check_blocks_end},
    TextFormat{"nff", nullptr},       TextFormat{"raw", nullptr},
    TextFormat{"smd", check_smd_end},
};

// See TextMends::commas.
bool parts_numbers_by_commas(const SourceFile& source) {
  return has_extension(source.path(), "x") || has_extension(source.path(), "x3d") ||
         has_extension(source.path(), "xgl");
}

// Its reader of Collada gives the root, which has no transform in the file, a scale: the metres of
// a unit. Without it coordinates are those of the file.
void undo_unit(aiScene& scene) {
  aiString format;
  const bool is_collada = scene.mMetaData != nullptr &&
                          scene.mMetaData->Get(AI_METADATA_SOURCE_FORMAT, format) &&
                          std::string_view(format.C_Str()) == "Collada Importer";
  if (is_collada && scene.mRootNode != nullptr) scene.mRootNode->mTransformation = aiMatrix4x4();
}

// Where none of its readers takes a file by its ending, assimp tries all of them by the first
// bytes: the name of the reader that has read it, if it is not one for this ending; else empty. Of
// .xml too, which several formats end in.
std::string other_format(const Assimp::Importer& importer, const SourceFile& source) {
  const int index = importer.GetPropertyInteger("importerIndex", -1);
  const aiImporterDesc* const reader =
      index < 0 ? nullptr : importer.GetImporterInfo(static_cast<std::size_t>(index));
  if (reader == nullptr || has_extension(source.path(), "xml")) return {};
  std::istringstream endings(reader->mFileExtensions);
  for (std::string ending; endings >> ending;) {
    if (has_extension(source.path(), ending)) return {};
  }
  return reader->mName;
}

// Records the files read in `use`. Errors do not name the source. No post-processing flags: each
// may drop, reorder, merge or generate data.
Result<std::unique_ptr<aiScene>> read_scene(const SourceFile& source, ReadOrder order,
                                            SourceUse& use) {
  const CLocaleScope numbers_in_c_locale;
  Assimp::Importer importer;
  configure(importer, order);
  const ReaderLog log;
  const bool is_text = find_extension(kTextFormats, source.path()) != nullptr;
  const TextMends mends{.line_end = is_text, .commas = parts_numbers_by_commas(source)};
  // The importer owns it from here.
  importer.SetIOHandler(new RecordingIo(source, use, mends));
  if (importer.ReadFile(source.path().string(), 0) == nullptr) {
    const std::string why = importer.GetErrorString();
    if (why == std::bad_alloc().what()) throw std::bad_alloc();  // as when we run out of memory
    if (!use.inaccessible.empty()) {
      return Error{
          Errc::kImportFailed,
          fmt::format("it refers to {}, which only a file can that has a name: name it, or "
                      "give it in one piece, as glTF in .glb",
                      use.inaccessible.string())};
    }
    // Its reader of glTF opens buffers alone, without which there is no mesh; others try files that
    // need not be there.
    if (is_gltf(source.path()) && use.failure) {
      return Error{use.failure->code, "it refers to " + use.failure->detail};
    }
    if (std::string fault = gltf_fault(source); !fault.empty()) {
      return Error{Errc::kImportFailed, std::move(fault)};
    }
    if (why.starts_with("No suitable reader found")) {
      return Error{
          Errc::kImportFailed,
          fmt::format("no reader knows how it begins; expected a file of the format {}{}",
                      source.path().extension().string(),
                      has_extension(source.path(), "gltf")
                          ? ", JSON from its first byte on with \"version\": \"2.0\" of its asset"
                          : "")};
    }
    if (has_extension(source.path(), "step") || has_extension(source.path(), "stp")) {
      return Error{
          Errc::kImportFailed,
          fmt::format("expected IFC, which of STEP alone has a reader; shapes of CAD have no "
                      "faces yet: mesh them, e.g. as .stl by gmsh or FreeCAD ({})",
                      why)};
    }
    return Error{Errc::kImportFailed, why.empty() ? "no scene" : why};
  }
  if (const std::string format = other_format(importer, source); !format.empty()) {
    return Error{Errc::kImportFailed,
                 fmt::format("expected a file of the format {}, found one that assimp's \"{}\" "
                             "takes: give it the ending of its format",
                             source.path().extension().string(), format)};
  }
  if (!log.loss().empty()) {
    return Error{Errc::kImportFailed,
                 fmt::format("assimp's reader leaves out or makes up a part of it, and says: {}",
                             log.loss())};
  }
  use.guessed_material = log.guessed_material();
  std::unique_ptr<aiScene> scene(importer.GetOrphanedScene());
  undo_unit(*scene);
  return scene;
}

// Faces have their own materials, or none. A file without any is left to has_no_materials.
Status check_materials(const ImportOptions& options, const SourceUse& use, const aiScene& scene) {
  if (!options.materials || use.guessed_material.empty()) return {};
  const bool has_some = std::any_of(
      scene.mMaterials, scene.mMaterials + scene.mNumMaterials, [](const aiMaterial* material) {
        return std::string_view(material->GetName().C_Str()) != kDefaultMaterial;
      });
  if (!has_some) return {};
  return Error{Errc::kImportFailed,
               fmt::format("assimp's reader gives faces without a material that of others, and "
                           "says: {}; give each a material, or cook without --materials",
                           use.guessed_material)};
}

// Runs of materials; the materials themselves are added to `scene`. If assimp cannot read the
// materials, there are none; it has read the geometry before.
std::vector<MeshMaterials> read_fbx_materials(const SourceFile& source, aiScene& scene) {
  SourceUse read_already;
  const auto sorted = read_scene(source, ReadOrder::kByMaterial, read_already);
  return sorted.ok() ? match_materials(scene, *sorted.value()) : std::vector<MeshMaterials>();
}

Status take_over(const SourceFile& source, ImportWanted wanted, aiScene& scene,
                 SourceContext context, ImportReport&& report, ImportedFile& out) {
  const Placements placements = find_placements(scene);
  const bool is_scene = wanted == ImportWanted::kScene ||
                        (wanted == ImportWanted::kFitting && places_several(scene, placements));
  std::vector<MeshMaterials> materials;
  if ((is_scene || context.options.materials) && has_extension(source.path(), "fbx")) {
    materials = read_fbx_materials(source, scene);
  }
  context.materials = materials;
  if (!is_scene) {
    Imported& mesh = out.emplace<Imported>();
    mesh.report = std::move(report);
    std::vector<FaceRun> runs;
    Status status = flatten_scene(scene, placements, context, mesh, runs);
    if (status.ok() && context.options.materials) mesh.materials = take_materials(scene, runs);
    return status;
  }
  SourceScene& whole = out.emplace<SourceScene>();
  whole.report = std::move(report);
  return take_scene(scene, placements, context, whole);
}

// Runs all of assimp's reading in a copy of this process. Returns a hash of what it read there.
Result<std::uint64_t> try_reading(const SourceFile& source) {
  const Result<std::uint64_t> size = source.size();
  if (!size.ok()) return size.error();
  const TrialLimits limits = trial_limits(*size);
  const Result<std::uint64_t> hash =
      try_in_child(limits, [&source, &size]() -> Result<std::uint64_t> {
        SourceUse use;
        use.opened = [&size](std::uint64_t bytes) {  // of all files that it refers to
          extend_trial(trial_limits(std::max(*size, bytes)));
        };
        const auto scene = read_scene(source, ReadOrder::kOfFile, use);
        if (!scene.ok()) return scene.error();
        if (has_extension(source.path(), "fbx")) {  // once more for its materials
          static_cast<void>(read_scene(source, ReadOrder::kByMaterial, use));
        }
        return geometry_hash(*scene.value());
      });
  // No fault of the machine's as long as a larger file would be allowed more.
  if (hash.code() == Errc::kOutOfMemory && limits.bytes < trial_limits(~std::uint64_t{0}).bytes) {
    return Error{Errc::kImportFailed,
                 fmt::format("assimp's reader wants more than the {} MB of memory that a file of "
                             "this size may take",
                             limits.bytes >> 20)};
  }
  return hash;
}

struct GltfFacts {
  StatedFaces faces;
  bool is_quantized = false;  // has_quantized_positions
};

// Checks a glTF file before assimp reads it.
Result<GltfFacts> check_gltf(const SourceFile& source, ImportReport& report) {
  const Result<Json> document = read_gltf(source);
  if (!document.ok()) return document.error();
  // What is no JSON to us may be some to assimp, and would be read without a check.
  if (document->is_null()) {
    const std::string fault = gltf_fault(source);
    if (!fault.empty()) return in_file(source.title(), Error{Errc::kImportFailed, fault});
  }
  Status status = check_required_extensions(*document);
  if (status.ok()) status = check_types(*document);
  if (status.ok()) status = check_values(*document);
  if (!status.ok()) return in_file(source.title(), status.error());
  report.unread = unread_of_gltf(*document);
  return GltfFacts{stated_faces(*document), has_quantized_positions(*document)};
}

// What assimp has not read of a glTF file: positions that are no f32, and of each mesh its user
// data. The document is read anew, so that it is not kept while the scene is read.
Result<std::vector<std::uint32_t>> complete_gltf(const SourceFile& source, const GltfFacts& facts,
                                                 const ImportOptions& options, aiScene& scene,
                                                 ImportReport& report) {
  if (!facts.is_quantized && options.user_data.empty()) return std::vector<std::uint32_t>();
  const Result<Json> document = read_gltf(source);
  if (!document.ok()) return document.error();
  if (facts.is_quantized) {
    const Status status = read_quantized_positions(*document, scene);
    if (!status.ok()) return in_file(source.title(), status.error());
  }
  if (options.user_data.empty()) return std::vector<std::uint32_t>();
  const Result<PrimitiveNumbers> numbers = numbers_of_primitives(*document, options.user_data);
  if (!numbers.ok()) return in_file(source.title(), numbers.error());
  Result<std::vector<std::uint32_t>> of_meshes =
      numbers_of_meshes(*document, *numbers, scene, "user data of faces");
  if (!of_meshes.ok()) return in_file(source.title(), of_meshes.error());
  if (options.user_data == kPrimitives) report.primitives = names_of_primitives(*document);
  return of_meshes;
}

struct TextFacts {
  bool has_open_end = false;  // in formats in which a truncated file is otherwise valid
  double loss = 0;            // loss_in_text
};

Result<TextFacts> check_text(const SourceFile& source) {
  const TextFormat* const format = find_extension(kTextFormats, source.path());
  const bool is_collada = has_extension(source.path(), "dae");
  const bool is_xml = has_extension(source.path(), "xml");
  if (format == nullptr && !is_collada && !is_xml) return TextFacts();
  const Result<std::string> file = source.read();
  if (!file.ok()) return file.error();
  if (is_collada || (is_xml && file->find("<COLLADA") != std::string::npos)) {
    const Status status = check_collada(*file);
    if (!status.ok()) return in_file(source.title(), status.error());
  }
  if (is_xml) return TextFacts();
  TextFacts facts;
  if (format != nullptr && format->check_end != nullptr) {
    const Status status = format->check_end(*file);
    if (!status.ok()) return in_file(source.title(), status.error());
  }
  facts.has_open_end = format != nullptr && format->check_end == nullptr && has_open_end(*file);
  facts.loss = loss_in_text(*file);
  return facts;
}

struct Checks {
  TextFacts text;
  GltfFacts gltf;
  std::optional<std::uint64_t> tried_hash;  // of what was read when it was tried
};

// All that is checked before assimp reads a file in this process.
Result<Checks> check_source(const SourceFile& source, const ImportOptions& options,
                            ImportReport& report) {
  const Result<TextFacts> text = check_text(source);
  if (!text.ok()) return text.error();
  const Result<GltfFacts> gltf = check_gltf(source, report);
  if (!gltf.ok()) return gltf.error();
  Checks checks{*text, *gltf, std::nullopt};
  if (options.try_first) {
    const Result<std::uint64_t> tried = try_reading(source);
    if (!tried.ok()) return in_file(source.title(), tried.error());
    checks.tried_hash = *tried;
  }
  return checks;
}

bool has_f32_alone(const Positions& positions) {
  return positions.precision == Precision::kF64 && moved_by_f32(positions) == 0;
}

void state_precision(Imported& mesh) {
  mesh.report.has_f32_alone = has_f32_alone(mesh.mesh.positions);
}

void state_precision(SourceScene& scene) {
  scene.report.has_f32_alone =
      std::all_of(scene.meshes.begin(), scene.meshes.end(),
                  [](const SceneMesh& each) { return has_f32_alone(each.mesh.positions); });
}

}  // namespace

Status import_with_assimp(const SourceFile& source, const ImportOptions& options,
                          ImportWanted wanted, ImportedFile& out) {
  ImportReport report;
  const Result<Checks> checks = check_source(source, options, report);
  if (!checks.ok()) return checks.error();
  report.has_open_end = checks->text.has_open_end;
  SourceUse use;
  auto scene = read_scene(source, ReadOrder::kOfFile, use);
  if (!scene.ok()) return in_file(source.title(), scene.error());
  if (checks->tried_hash && *checks->tried_hash != geometry_hash(*scene.value())) {
    return in_file(source.title(),
                   Error{Errc::kImportFailed,
                         "assimp's reader makes up a part of it, of memory that it has not set: "
                         "read twice, it differs (or the file was changed in between)"});
  }
  Status status = check_stated_faces(checks->gltf.faces, *scene.value());
  if (status.ok()) status = check_materials(options, use, *scene.value());
  if (!status.ok()) return in_file(source.title(), status.error());
  report.files_read = use.files;
  const Result<std::vector<std::uint32_t>> user_data =
      complete_gltf(source, checks->gltf, options, *scene.value(), report);
  if (!user_data.ok()) return user_data.error();
  status = take_over(source, wanted, *scene.value(),
                     {options, source.title(), {}, *user_data, checks->text.loss},
                     std::move(report), out);
  if (!status.ok()) return status;
  // Hashed last, so that a refused file is not read twice.
  const Result<std::uint64_t> hash = source.bytes()
                                         ? Result<std::uint64_t>(hash_source_bytes(*source.bytes()))
                                         : hash_source_files(use.files);
  if (!hash.ok()) return hash.error();
  std::visit(
      [&](auto& imported) {
        imported.report.content_hash = hash.value();
        state_precision(imported);
      },
      out);
  return {};
}

Result<SourceFileList> list_assimp_files(const SourceFile& source, const ImportOptions& options) {
  ImportReport unused;
  if (const auto checks = check_source(source, options, unused); !checks.ok()) {
    return checks.error();
  }
  SourceUse use;
  const auto scene = read_scene(source, ReadOrder::kOfFile, use);
  if (!scene.ok()) return in_file(source.title(), scene.error());
  if (Status status = check_materials(options, use, *scene.value()); !status.ok()) {
    return in_file(source.title(), status.error());
  }
  const bool is_all = std::all_of(use.present.begin(), use.present.end(), [&](const auto& name) {
    return std::find(use.named.begin(), use.named.end(), name) != use.named.end();
  });
  return SourceFileList{std::move(use.files), std::move(use.named), std::move(use.absent), is_all};
}

std::vector<std::string> assimp_endings() {
  aiString list;  // "*.3ds;*.obj;..."
  Assimp::Importer().GetExtensionList(list);
  std::vector<std::string> endings;
  std::istringstream patterns(list.C_Str());
  for (std::string pattern; std::getline(patterns, pattern, ';');) {
    endings.push_back(in_lower_case(std::string_view(pattern).substr(pattern.rfind('.') + 1)));
  }
  return endings;
}

std::string assimp_version() {
  return fmt::format("{}.{}.{}", aiGetVersionMajor(), aiGetVersionMinor(), aiGetVersionPatch());
}

}  // namespace boxtree::cooker
