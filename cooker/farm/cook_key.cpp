// SPDX-License-Identifier: MIT
#include "cooker/farm/cook_key.h"

#include <algorithm>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "cooker/farm/cooker_identity.h"
#include "cooker/farm/import_libraries.h"
#include "cooker/import/import.h"
#include "cooker/text/json.h"
#include "cooker/text/percent.h"
#include "format/container.h"

namespace boxtree::cooker {
namespace {

// Of the text that is hashed.
constexpr int kKeyForm = 1;

template <class T>
Json optional_form(const std::optional<T>& value) {
  if (!value) return nullptr;
  return *value;
}

// A new member of one of these structs does not compile here before it is named: those that change
// bytes go into the form.
Json form_of(const Wishes& wishes) {
  const auto& [goal, max_bytes_per_triangle, max_slowdown, queries] = wishes;
  return {{"for", goal_name(goal)},
          {"max_bytes_per_triangle", optional_form(max_bytes_per_triangle)},
          {"max_slowdown", optional_form(max_slowdown)},
          {"queries", static_cast<unsigned>(queries)}};
}

Json form_of(const GridChoice& grid) {
  const auto& [bits, tolerance, step_exponent] = grid;
  return {{"bits", bits},
          {"tolerance", optional_form(tolerance)},
          {"step_exponent", optional_form(step_exponent)}};
}

Json form_of(const SearchOptions& search) {
  const auto& [codec, wishes, builder, widths, geometry, may_use_grid, may_use_arrays, grid,
               try_all, keep_all, face_ids, face_order, is_part, active_edges, known_edges, costs,
               shrink_share] = search;
  return {{"codec", codec ? Json(codec_name(*codec)) : Json(nullptr)},
          {"wishes", form_of(wishes)},
          {"builder", static_cast<unsigned>(builder)},
          {"widths", static_cast<unsigned>(widths)},
          {"geometry", geometry_name(geometry)},
          {"may_use_grid", may_use_grid},
          {"may_use_arrays", may_use_arrays},
          {"grid", form_of(grid)},
          {"try_all", try_all},
          {"face_ids", face_ids},
          {"active_edges", optional_form(active_edges)},
          {"shrink_share", shrink_share}};
}

Json form_of(const ImportOptions& import) {
  const auto& [skip_bad, command, precision, keep_doubles, count_moves, try_first,
               keep_polygon_corners, materials, user_data, face_ids, bytes] = import;
  return {{"skip_bad", skip_bad},
          {"precision", precision_name(precision)},
          {"keep_doubles", keep_doubles},
          {"user_data", percent_encoded(user_data)},
          {"ids", percent_encoded(face_ids)}};
}

// How the inputs become trees.
const char* shape_of(const CookJob& job) {
  if (!job.profile.empty() || job.as_scene) return "scene";
  return job.flatten || job.inputs.size() != 1 ? "trees" : "file";
}

// Which of the inputs is bytes: they have no file among those that are listed.
Json place_of_bytes(const CookJob& job) {
  const std::optional<SourceBytes>& bytes = job.options.import.bytes;
  if (!bytes) return nullptr;
  return std::find(job.inputs.begin(), job.inputs.end(), bytes->input) - job.inputs.begin();
}

Json form_of(const CookJob& job) {
  const auto& [inputs, output, output_stream, profile, costs, depfile, reordered, as_scene, flatten,
               require_files, options] = job;
  return {{"shape", shape_of(job)},
          {"bytes_at", place_of_bytes(job)},
          {"blob", options.blob ? Json(static_cast<unsigned>(*options.blob)) : Json(nullptr)},
          {"cook_record", options.cook_record},
          {"materials", options.materials},
          {"require_files", require_files},  // else a hit would be one that lacks a file
          {"number_by_tree", options.number_by_tree || !reordered.empty()},
          {"search", form_of(static_cast<const SearchOptions&>(options))},
          {"import", form_of(options.import)}};
}

const char* role_name(FileRole role) {
  switch (role) {
    case FileRole::kProfile:
      return "profile";
    case FileRole::kHiddenFaces:
      return "hidden_faces";
    case FileRole::kMesh:
      return "mesh";
    case FileRole::kReferred:
      return "referred";
    case FileRole::kCosts:
      return "costs";
  }
  return "";
}

// Lists of hidden faces are named in the profile's text; costs nowhere.
bool has_name_in_key(FileRole role) {
  return role != FileRole::kHiddenFaces && role != FileRole::kCosts;
}

std::string line_of(FileRole role, const Digest& digest, const std::filesystem::path& path) {
  const std::string name =
      has_name_in_key(role) ? " " + percent_encoded(path.filename().string()) : "";
  return fmt::format("{} {}{}\n", role_name(role), hex_of(digest), name);
}

// Other meshes are read by this program alone.
bool is_read_by_assimp(const CookJob& job, const std::vector<KeyedFile>& files) {
  const std::optional<SourceBytes>& bytes = job.options.import.bytes;
  return (bytes && has_node_graph(bytes->file_name)) ||
         std::any_of(files.begin(), files.end(), [](const KeyedFile& each) {
           return each.file.role == FileRole::kMesh && has_node_graph(each.file.path);
         });
}

}  // namespace

std::string key_text(const CookJob& job, const std::vector<KeyedFile>& files) {
  std::string text = fmt::format("boxtree key {}\nformat {}.{}\n{}\n{}\n", kKeyForm, kVersionMajor,
                                 kVersionMinor, cooker_identity(), form_of(job).dump(-1, true));
  if (!import_libraries().empty() && is_read_by_assimp(job, files)) {
    text += "libraries " + import_libraries() + "\n";
  }
  if (const std::optional<SourceBytes>& bytes = job.options.import.bytes) {
    text += line_of(FileRole::kMesh, sha256_of(bytes->bytes), bytes->file_name);
  }
  for (const auto& [file, digest] : files) text += line_of(file.role, digest, file.path);
  return text;
}

Result<JobKey> key_of(const CookJob& job, const DigestOf& digest_of, const ListFiles& list_files) {
  Result<std::vector<JobFile>> listed = list_job_files(job, list_files);
  if (!listed) return listed.error();
  JobKey key;
  for (JobFile& file : *listed) {
    const Result<Digest> digest = digest_of(file.path);
    if (!digest) return digest.error();
    key.files.push_back({std::move(file), *digest});
  }
  key.key = sha256_of(key_text(job, key.files));
  return key;
}

}  // namespace boxtree::cooker
