// SPDX-License-Identifier: MIT
// Chooses the writer by the ending of the names.
#include "cooker/reorder/reordered_mesh.h"

#include <array>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <boxtree/blob.h>
#include <boxtree/file.h>

#include "cooker/import/file_error.h"
#include "cooker/import/mesh_arrays.h"
#include "cooker/import/text_tokens.h"
#include "cooker/import/whole_file.h"
#include "cooker/reorder/reorder.h"
#include "format/tree_record.h"
#include "runtime/file/open_file.h"

namespace boxtree::cooker {
namespace {

namespace fs = std::filesystem;

struct Format {
  const char* extension;
  Status (*write)(const Reordering& reordering, ByteSink& out);
};

constexpr std::array kFormats = {
    Format{"obj", reorder_obj},
    Format{"ply", reorder_ply},
    Format{"gltf", [](const Reordering& r, ByteSink& out) { return reorder_gltf(r, false, out); }},
    Format{"glb", [](const Reordering& r, ByteSink& out) { return reorder_gltf(r, true, out); }},
};

fs::path full_folder_of(const fs::path& file) {
  std::error_code error;
  const fs::path absolute = fs::absolute(file, error);
  if (error) return file.parent_path();
  const fs::path folder = fs::weakly_canonical(absolute.parent_path(), error);
  return error ? absolute.parent_path() : folder;
}

}  // namespace

std::string Reordering::way() const {
  const fs::path way = from.lexically_relative(to);
  return way.empty() || way == "." ? std::string() : way.generic_string() + "/";
}

std::string Reordering::moved(const std::string& reference) const {
  return reference.starts_with('/') ? reference : way() + reference;
}

Error has_changed(std::string_view what) {
  return {Errc::kImportFailed, fmt::format("has changed while it was cooked: {}", what)};
}

Status check_reordered_names(const fs::path& source, const fs::path& target) {
  const Format* const format = find_extension(kFormats, target);
  if (format == nullptr) {
    return Error{
        Errc::kMeshUnsupported,
        fmt::format("{}: a mesh is written as .obj, .ply, .gltf or .glb", target.string())};
  }
  if (find_extension(kFormats, source) == format) return {};
  return Error{Errc::kMeshUnsupported,
               fmt::format("{}: only faces are reordered, so the file is written in the format of "
                           "{}, and needs its ending",
                           target.string(), source.string())};
}

Result<AtomicFile> write_reordered(const fs::path& source, std::span<const SourceCorners> faces,
                                   const fs::path& target) {
  if (Status status = check_reordered_names(source, target); !status) return status.error();
  const Result<std::string> text = read_whole_file(source, kAnyBytes);
  if (!text) return text.error();
  Result<AtomicFile> file = AtomicFile::create(target);
  if (!file) return file;
  ByteSink out(*file);
  const Reordering reordering{*text, faces, full_folder_of(source), full_folder_of(target)};
  const Status written = find_extension(kFormats, target)->write(reordering, out);
  if (!written) return in_file(source, written.error());
  if (Status status = out.finish(); !status) return status.error();
  return file;
}

bool is_mesh_of(const fs::path& mesh, const fs::path& cooked, ImportOptions import) {
  Result<File> file = File::open(cooked.string());
  if (!file) file = open_blob(cooked.string());
  if (!file || file->tree_count() != 1) return false;
  const TreeRecord record = OpenFile::of(*file).tree_record(0);
  if ((record.flags & kTreeFacesInSourceOrder) == 0) return false;
  const bool is_f64 = (record.flags & kTreePositionsF64) != 0;
  import.precision = is_f64 ? Precision::kF64 : Precision::kF32;
  const Result<Imported> imported = import_mesh(mesh, import);
  return imported && hash_of(imported->mesh) == record.geometry_hash;
}

}  // namespace boxtree::cooker
