// SPDX-License-Identifier: MIT
// `boxtree info`: what a file holds and what each part costs.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <boxtree/boxtree.h>

#include "cooker/cli/command.h"
#include "cooker/cli/commands.h"
#include "cooker/cli/json_output.h"
#include "cooker/cli/open_file.h"
#include "cooker/cli/output.h"
#include "cooker/cli/scene_info.h"
#include "cooker/cli/standard_streams.h"
#include "cooker/cli/surface_text.h"
#include "cooker/export/decoded_faces.h"
#include "cooker/import/file_error.h"
#include "cooker/text/at_most.h"
#include "cooker/text/counted.h"
#include "format/active_edges.h"
#include "format/container.h"
#include "format/face_numbers.h"
#include "format/pack.h"
#include "format/tree_record.h"
#include "runtime/file/open_file.h"
#include "runtime/tree/frame.h"
#include "runtime/tree/materials.h"

namespace boxtree::cooker {
namespace {

struct InfoArguments {
  std::vector<std::filesystem::path> files;
  bool json = false;
};

struct TreeBytes {
  std::uint64_t tree = 0;
  std::uint64_t geometry = 0;
  std::uint64_t face_ids = 0;
  std::uint64_t active_edges = 0;
  std::uint64_t materials = 0;
  std::uint64_t user_data = 0;
  std::uint64_t other = 0;
};

TreeBytes bytes_of(const File& file, std::uint32_t index) {
  const auto size = [&](SectionKind kind) {
    return OpenFile::of(file).section(kind, index).size();
  };
  return {size(SectionKind::kNodes) + size(SectionKind::kDuplicates),
          size(SectionKind::kVertices) + size(SectionKind::kCorners),
          size(SectionKind::kFaceIds),
          size(SectionKind::kActiveEdges),
          size(SectionKind::kMaterialRuns) + size(SectionKind::kFaceMaterials),
          size(SectionKind::kUserDataRuns) + size(SectionKind::kFaceUserData),
          sizeof(TreeRecord)};
}

double per_triangle(std::uint64_t bytes, const TreeRecord& record) {
  return record.triangle_count == 0
             ? 0
             : static_cast<double>(bytes) / static_cast<double>(record.triangle_count);
}

// Of what is stored: on a grid, vertices and edges of the rounded mesh. Faces that cannot be read
// keep nothing from being said of the rest of the file.
void add_surface(const File& file, std::uint32_t index, GeometryId geometry, Json& json) {
  json["vertices"] = nullptr;
  json["surface"] = nullptr;
  if (geometry == GeometryId::kExternal) return;
  const Result<Tree> tree = Tree::bind(file, index);
  const Result<DecodedFaces> faces =
      tree ? DecodedFaces::decode(*tree, ExportOrder::kTree) : tree.error();
  if (!faces) {
    json["surface"] = {{"error", faces.error().message()}};
    return;
  }
  json["vertices"] = faces->vertex_count();
  json["surface"] = surface_json(count_surface_edges(faces->arrays()));
}

std::string text_of_surface(const Json& surface) {
  if (surface.is_null()) return "not in the file";
  if (surface.contains("error")) return "unreadable: " + shown(surface["error"].get<std::string>());
  return surface_text(surface_of(surface));
}

// The degrees by more than which the surface bends at active edges; null without these.
Json edge_angle_json(const File& file, std::uint32_t index) {
  const Bytes section = OpenFile::of(file).section(SectionKind::kActiveEdges, index);
  if (section.size() < sizeof(ActiveEdgesHeader)) return nullptr;
  return load<ActiveEdgesHeader>(section.data()).degrees;
}

// How numbers of faces are stored; null without any. `runs`: the section of one form.
Json form_of(const File& file, SectionKind runs, std::uint32_t index) {
  const OpenFile& opened = OpenFile::of(file);
  if (!opened.section(by_face(runs), index).empty()) return "faces";
  if (!opened.section(runs, index).empty()) return "runs";
  return nullptr;
}

void print_form(const char* what, const Json& tree, const char* key) {
  const Json& form = tree[key];
  if (form.is_null()) return;
  fmt::print("  {}: {}, {:.2f} bytes per triangle\n", what,
             form.get<std::string>() == "runs" ? "by runs of the source's faces" : "of each face",
             tree["bytes_per_triangle"][key].get<double>());
}

// Of a file without a scene.
Json material_names(const File& file) {
  const MaterialNames materials(OpenFile::of(file).section(SectionKind::kMaterials),
                                OpenFile::of(file).section(SectionKind::kNames));
  Json names = Json::array();
  for (std::uint32_t i = 0; i < materials.count(); ++i) names.push_back(materials[i]);
  return names;
}

// As a tree of one file has it; `name`: that of a pack is another.
Json tree_json(const File& file, std::uint32_t index, std::string_view name) {
  const TreeRecord record = OpenFile::of(file).tree_record(index);
  const TreeBytes bytes = bytes_of(file, index);
  Json json = {{"name", name},
               {"codec", codec_name(record.codec)},
               {"geometry", geometry_name(record.geometry)},
               {"triangles", record.triangle_count},
               {"faces", record.face_count},
               {"duplicates", record.duplicate_count},
               {"nodes", record.node_count},
               {"depth", record.depth}};
  json["bytes"] = {{"tree", bytes.tree},           {"geometry", bytes.geometry},
                   {"face_ids", bytes.face_ids},   {"active_edges", bytes.active_edges},
                   {"materials", bytes.materials}, {"user_data", bytes.user_data},
                   {"other", bytes.other}};
  json["bytes_per_triangle"] = {{"tree", per_triangle(bytes.tree, record)},
                                {"total", per_triangle(bytes.tree + bytes.geometry, record)},
                                {"face_ids", per_triangle(bytes.face_ids, record)},
                                {"active_edges", per_triangle(bytes.active_edges, record)},
                                {"materials", per_triangle(bytes.materials, record)},
                                {"user_data", per_triangle(bytes.user_data, record)}};
  json["grid_step"] = grid_step_json(record.geometry, record.grid_exponent);
  json["max_vertex_error"] = record.max_vertex_error;
  json["face_ids"] = bytes.face_ids > 0                              ? "stored"
                     : (record.flags & kTreeFacesInSourceOrder) != 0 ? "source order"
                                                                     : "none";
  json["active_edges"] = edge_angle_json(file, index);
  json["materials"] = form_of(file, SectionKind::kMaterialRuns, index);
  json["user_data"] = form_of(file, SectionKind::kUserDataRuns, index);
  const Frame frame(record.origin, record.scale_exponent);
  Eigen::Vector3d low;
  Eigen::Vector3d high;
  for (std::size_t k = 0; k < 3; ++k) {
    low[static_cast<Eigen::Index>(k)] = record.root_low[k];
    high[static_cast<Eigen::Index>(k)] = record.root_high[k];
  }
  json["bounds"] = {{"min", to_json(frame.to_object(low))},
                    {"max", to_json(frame.to_object(high))}};
  add_surface(file, index, record.geometry, json);
  return json;
}

// As it is stored, since any tool may have written it; null if it was left out.
Json cook_record_json(const File& file) {
  const Bytes record = OpenFile::of(file).section(SectionKind::kCookRecord);
  if (record.empty()) return nullptr;
  return std::string_view(reinterpret_cast<const char*>(record.data()), record.size());
}

Result<Json> file_json(const File& file) {
  const FileHeader& header = OpenFile::of(file).container().header;
  Json json = {{"version", fmt::format("{}.{}", header.version_major, header.version_minor)},
               {"file_bytes", file.bytes().size()}};
  json["cook_record"] = cook_record_json(file);
  json["trees"] = Json::array();
  std::set<std::uint64_t> members;  // where they begin
  for (std::uint32_t i = 0; i < file.tree_count(); ++i) {
    if (!file.is_pack()) {
      json["trees"].push_back(tree_json(file, i, file.tree_name(i)));
      continue;
    }
    const PackRow row = OpenFile::of(file).pack_row(i);
    members.insert(row.offset);
    const Result<Member> member = file.member(i);
    if (!member) return member.error();
    Json tree = tree_json(member->file, member->tree, file.tree_name(i));
    tree["member"] = {{"name", file.tree_name(i).substr(0, row.member_name_bytes)},
                      {"tree", row.tree},
                      {"bytes", row.bytes},
                      {"has_scene", member->file.has_scene()}};
    tree["cook_record"] = cook_record_json(member->file);
    tree["material_names"] = material_names(member->file);
    json["trees"].push_back(std::move(tree));
  }
  if (file.is_pack()) json["members"] = members.size();
  json["sections"] = Json::array();
  for (const SectionEntry& entry : OpenFile::of(file).container().sections) {
    json["sections"].push_back(
        {{"kind", section_name(entry.kind)},
         {"tree", entry.owner == kNoOwner ? Json(nullptr) : Json(entry.owner)},
         {"offset", entry.offset},
         {"bytes", entry.size}});
  }
  return json;
}

// What stands behind the bytes of face ids.
const char* meaning_of_ids(const std::string& face_ids) {
  if (face_ids == "stored") return "stored, those of the source's faces";
  if (face_ids == "source order") return "none needed, the tree's faces are in the source's order";
  return "none, queries number faces in the tree's order";
}

// How far vertices were moved, and onto which grid; empty if nothing moved them.
std::string text_of_moves(const Json& tree) {
  const auto moved = tree["max_vertex_error"].get<double>();
  const Json& step = tree["grid_step"];
  if (!step.is_null()) {
    return fmt::format("  grid: step 2^{}, {}\n", std::ilogb(step.get<double>()),
                       moves_in_words(moved));
  }
  return moved > 0 ? fmt::format("  f32 moved a vertex by up to {}\n", at_most(moved, 3))
                   : std::string();
}

// All bytes of the file, by the kind of section; the rest is what a reader opens it by.
std::string text_of_bytes(const Json& json) {
  std::vector<std::pair<std::string, std::uint64_t>> kinds;
  std::uint64_t rest = json["file_bytes"].get<std::uint64_t>();
  for (const Json& section : json["sections"]) {
    const auto kind = section["kind"].get<std::string>();
    const auto bytes = section["bytes"].get<std::uint64_t>();
    const auto known = std::find_if(kinds.begin(), kinds.end(),
                                    [&](const auto& each) { return each.first == kind; });
    if (known == kinds.end()) {
      kinds.emplace_back(kind, bytes);
    } else {
      known->second += bytes;
    }
    rest -= bytes;
  }
  std::string text;
  for (const auto& [kind, bytes] : kinds) text += fmt::format("{} {}, ", kind, bytes);
  return text + fmt::format("header, section table and alignment {}", rest);
}

void print_file(const Json& json) {
  fmt::print("format {}, {} bytes\n", json["version"].get<std::string>(),
             json["file_bytes"].get<std::uint64_t>());
  if (json.contains("blob")) {
    fmt::print("compressed whole, to {} bytes: it is decompressed before the first answer\n",
               json["blob"]["file_bytes"].get<std::uint64_t>());
  }
  if (json.contains("members")) {
    fmt::print("pack: {} of {}\n", counted(json["trees"].size(), "tree"),
               counted(json["members"].get<std::uint64_t>(), "file"));
  }
  for (std::size_t i = 0; i < json["trees"].size(); ++i) {
    const Json& tree = json["trees"][i];
    const auto name = tree["name"].get<std::string>();
    fmt::print("{}: {}, {}, geometry {}, {}, depth {}\n",
               name.empty() ? fmt::format("tree {}", i) : shown(name),
               counted(tree["triangles"].get<std::uint32_t>(), "triangle"),
               tree["codec"].get<std::string>(), tree["geometry"].get<std::string>(),
               counted(tree["nodes"].get<std::uint32_t>(), "node"),
               tree["depth"].get<std::uint32_t>());
    if (const auto copies = tree["duplicates"].get<std::uint32_t>(); copies > 0) {
      fmt::print("  {} of {} faces {} of others\n", copies, tree["faces"].get<std::uint32_t>(),
                 copies == 1 ? "is a copy" : "are copies");
    }
    fmt::print("  bytes per triangle: tree {:.2f}, with geometry {:.2f}, face ids {:.2f}\n",
               tree["bytes_per_triangle"]["tree"].get<double>(),
               tree["bytes_per_triangle"]["total"].get<double>(),
               tree["bytes_per_triangle"]["face_ids"].get<double>());
    fmt::print("  face ids: {}\n", meaning_of_ids(tree["face_ids"].get<std::string>()));
    if (const Json& degrees = tree["active_edges"]; !degrees.is_null()) {
      fmt::print(
          "  active edges: boundaries, and bends by more than {:g} degrees; {:.2f} bytes per "
          "triangle\n",
          degrees.get<double>(), tree["bytes_per_triangle"]["active_edges"].get<double>());
    }
    print_form("materials", tree, "materials");
    print_form("user data", tree, "user_data");
    fmt::print("{}", text_of_moves(tree));
    fmt::print("  surface{}: {}\n",
               tree["geometry"].get<std::string>() == "grid" ? " on the grid" : "",
               text_of_surface(tree["surface"]));
    fmt::print("  bounds {} to {}\n", line_of(tree["bounds"]["min"]),
               line_of(tree["bounds"]["max"]));
  }
  if (json.contains("materials")) fmt::print("materials {}\n", line_of(json["materials"]));
  if (json.contains("scene")) print_scene(json["scene"]);
  fmt::print("bytes: {}\n", text_of_bytes(json));
}

Result<Json> info_of(const OpenedFile& opened) {
  const File* const file = &opened.file;
  for (std::uint32_t i = 0; i < file->tree_count(); ++i) {
    if (file->is_pack()) {
      if (const Result<Member> member = file->member(i); !member) return member.error();
    }
    if (Status status = check_tree_record(record_of(*file, i), i); !status) return status.error();
  }
  Result<Json> content = file_json(*file);
  if (!content) return content.error();
  Json& json = *content;
  Result<Json> scene = scene_json(*file);
  if (!scene) return scene.error();
  if (!scene->is_null()) {
    json["scene"] = std::move(*scene);
  } else if (Json names = material_names(*file); !names.empty()) {
    json["materials"] = std::move(names);
  }
  if (opened.blob_bytes != 0) {
    json["blob"] = {{"file_bytes", opened.blob_bytes}, {"resident_bytes", file->bytes().size()}};
  }
  return content;
}

Result<Json> info_on(const std::filesystem::path& path) {
  const Result<OpenedFile> opened = open_file(path);
  if (!opened) return opened.error();
  Result<Json> content = info_of(*opened);
  if (!content) return in_file(input_name(path), content.error());
  return content;
}

// A file that cannot be read keeps nothing from being said of the others.
int run(const InfoArguments& arguments) {
  int status = 0;
  std::vector<Json> documents;
  for (const std::filesystem::path& path : arguments.files) {
    Result<Json> json = info_on(path);
    if (!json) {
      const int failed = fail(json.error());
      if (status == 0) status = failed;
      continue;
    }
    if (arguments.files.size() > 1) {
      if (arguments.json) {
        Json named = {{"file", path.string()}};
        named.update(*json);
        *json = std::move(named);
      } else {
        fmt::print("{}:\n", shown(path.string()));
      }
    }
    if (arguments.json) {
      documents.push_back(std::move(*json));
    } else {
      print_file(*json);
    }
  }
  const bool are_several = arguments.files.size() > 1;
  if (arguments.json && (are_several || !documents.empty())) {
    print_files(std::move(documents), are_several);
  }
  return status;
}

}  // namespace

void add_info_command(Command& program, int& status) {
  const auto arguments = std::make_shared<InfoArguments>();
  Command& command =
      program.add_command("info", "Show what a .bxt file holds and what each part takes");
  command
      .add_file("FILE", arguments->files, Values::kCookedFiles,
                "Files to look into; - is standard input")
      ->required();
  command.add_flag("--json", arguments->json, "Print one JSON document");
  command.example("What is in a file", "boxtree info bunny.bxt");
  command.example("The names of its trees",
                  "boxtree info level.bxt --json | jq -r '.trees[].name'");
  command.callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace boxtree::cooker
