// SPDX-License-Identifier: MIT
// Reports of cooking.
#include "cooker/cli/cook_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "cooker/choose/work.h"
#include "cooker/choose/workload.h"
#include "cooker/cli/output.h"
#include "cooker/cli/standard_streams.h"
#include "cooker/cli/surface_text.h"
#include "cooker/import/f32_digits.h"
#include "cooker/import/file_error.h"
#include "cooker/text/at_most.h"
#include "cooker/text/counted.h"

namespace boxtree::cooker {
namespace {

double per_triangle(std::uint64_t bytes, const EncodedTree& tree) {
  return tree.triangle_count == 0
             ? 0
             : static_cast<double>(bytes) / static_cast<double>(tree.triangle_count);
}

Json work_json(const WorkOfKinds& work) {
  Json json;
  for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
    json[kQueryNames[kind]] = {{"nodes", work[kind].nodes}, {"leaves", work[kind].leaves}};
  }
  return json;
}

Json candidate_json(const Candidate& candidate, double slowdown, const EncodedTree& tree) {
  Json json;
  json["codec"] = codec_name(candidate.codec);
  json["geometry"] = geometry_name(candidate.geometry);
  json["bytes_per_triangle"] = {
      {"tree", per_triangle(candidate.tree_bytes, tree)},
      {"total", per_triangle(candidate.tree_bytes + candidate.geometry_bytes, tree)}};
  for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
    json["cost"][kQueryNames[kind]] = candidate.cost[kind];
  }
  json["slowdown"] = slowdown;
  json["work"] = work_json(candidate.work);
  json["error"] = {{"max_vertex_error", candidate.max_vertex_error}};
  json["rejected"] = candidate.rejected.empty() ? Json(nullptr) : Json(candidate.rejected);
  json["gates"] = {{"missed", candidate.gates.missed},
                   {"escapes", candidate.gates.escapes},
                   {"certificate", candidate.gates.certificate}};
  return json;
}

Json import_json(const ImportReport& report) {
  Json json = {{"meshes", report.meshes},
               {"source_faces", report.source_faces},
               {"points_skipped", report.points_skipped},
               {"lines_skipped", report.lines_skipped},
               {"quads_kept", report.quads_kept},
               {"quads_split", report.quads_split},
               {"ngons_split", report.ngons_split},
               {"vertices_welded", report.vertices_welded},
               {"degenerate_faces", report.degenerate_faces},
               {"moved_by_f32", report.moved_by_f32},
               {"open_end", report.has_open_end}};
  json["files_missing"] = Json::array();
  for (const std::filesystem::path& file : report.files_missing) {
    json["files_missing"].push_back(file.string());
  }
  json["unread"] = Json::array();
  for (const Unread& part : report.unread) {
    json["unread"].push_back({{"what", part.what},
                              {"count", part.count},
                              {"line", part.line > 0 ? Json(part.line) : Json(nullptr)}});
  }
  if (!report.groups.empty()) json["groups"] = Json::array_of(report.groups);
  if (!report.primitives.empty()) json["primitives"] = Json::array_of(report.primitives);
  json["skipped"] = Json::array();
  for (const SkippedFace& face : report.skipped) {
    json["skipped"].push_back({{"face", face.face_id}, {"reason", face.reason}});
  }
  return json;
}

// What was tried and what was not, with the reasons.
void add_contest(const CookedTree& cooked, std::string& text) {
  const std::vector<Candidate>& candidates = cooked.contest.candidates;
  const std::vector<double> slower = slowdowns(cooked.contest);
  text += fmt::format("    {:<10} {:<8} {:>10} {:>10}  {:>8} {:>7} {:>7} {:>7} {:>10}  {:>9}\n",
                      "codec", "geometry", "tree B/tri", "with geom.", "slowdown", "ray ns",
                      "box ns", "point ns", "shallow us", "error");
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    text += fmt::format(
        "  {} {:<10} {:<8} {:>10.2f} {:>10.2f}  {:>8.2f} {:>7.0f} {:>7.0f} {:>7.0f} {:>10.1f}"
        "  {:>9.2g}{}{}\n",
        candidate.rejected.empty() ? '*' : ' ', codec_name(candidate.codec),
        geometry_name(candidate.geometry), per_triangle(candidate.tree_bytes, cooked.tree),
        per_triangle(candidate.bytes(), cooked.tree), slower[i], candidate.cost[0],
        candidate.cost[1], candidate.cost[2], candidate.cost[3] / 1000, candidate.max_vertex_error,
        candidate.rejected.empty() ? "" : "  ", candidate.rejected);
  }
  text += fmt::format(
      "    times: means of a model, the same everywhere but for --costs: compare them with each "
      "other;\n"
      "    by AVX2 alone the slowdown of exact and grid is up to 0.2 more, the model's processor "
      "has AVX-512;\n"
      "    boxes: {};\n"
      "    shallow: {}\n",
      kBoxMeaning, kShallowMeaning);
  // Codecs that share a reason stand together.
  const std::vector<NotTried>& others = cooked.contest.not_tried;
  for (std::size_t i = 0; i < others.size();) {
    std::string names;
    const NotTried& first = others[i];
    for (; i < others.size() && others[i].why == first.why; ++i) {
      if (others[i].geometry != first.geometry) break;
      names += fmt::format("{}{}", names.empty() ? "" : ", ", codec_name(others[i].codec));
    }
    text += fmt::format("    not tried, geometry {}: {}: {}\n", geometry_name(first.geometry),
                        names, first.why);
  }
}

void add_import(const ImportReport& import, std::string& text) {
  std::string notes;
  if (import.points_skipped + import.lines_skipped > 0) {
    notes = fmt::format("skipped {} and {}", counted(import.points_skipped, "point"),
                        counted(import.lines_skipped, "line"));
  }
  if (import.degenerate_faces > 0) {
    notes += fmt::format("{}kept {} without area", notes.empty() ? "" : "; ",
                         counted(import.degenerate_faces, "face"));
  }
  if (!notes.empty()) text += fmt::format("  {}\n", notes);
  for (const SkippedFace& face : import.skipped) {
    text += fmt::format("  skipped face {}: {}\n", face.face_id, shown(face.reason));
  }
}

void add_grid(const CookedTree& cooked, std::string& text) {
  if (cooked.tree.geometry.geometry != GeometryId::kGrid) return;
  text += fmt::format("  grid: step 2^{}, {}", cooked.tree.geometry.grid_exponent,
                      moves_in_words(cooked.tree.geometry.max_vertex_error));
  if (cooked.collapsed > 0) {
    text +=
        fmt::format("; {} lost {} area and {} kept", counted(cooked.collapsed, "triangle"),
                    cooked.collapsed == 1 ? "its" : "their", cooked.collapsed == 1 ? "is" : "are");
  }
  text += "\n";
}

// What was chosen for the only tree.
void add_choice(const CookedTree& cooked, std::uint64_t file_bytes, std::string& text) {
  const std::vector<Candidate>& candidates = cooked.contest.candidates;
  const std::vector<double> slower = slowdowns(cooked.contest);
  text += fmt::format("{}: {}, {}\n", shown(cooked.tree.name),
                      counted(cooked.tree.triangle_count, "triangle"), surface_text(cooked.edges));
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    if (!candidate.rejected.empty()) continue;
    text += fmt::format(
        "  {}, geometry {}: {:.2f} bytes per triangle of tree, {:.2f} with geometry, {:.2f} in the "
        "file\n"
        "  slowdown {:.2f} ({}); {} tried\n",
        codec_name(candidate.codec), geometry_name(candidate.geometry),
        per_triangle(candidate.tree_bytes, cooked.tree),
        per_triangle(candidate.bytes(), cooked.tree), per_triangle(file_bytes, cooked.tree),
        slower[i], kSlowdownMeaning, candidates.size());
  }
  add_grid(cooked, text);
}

// Trees of a file share a grid, which the largest extent decides: its step, and how many the least
// of them has, where that is fewer by a power of two or more.
void add_shared_grid(const std::vector<CookedTree>& trees, std::string& text) {
  const EncodedTree* least = nullptr;
  int least_bits = 0, most_bits = 0;
  for (const CookedTree& cooked : trees) {
    const EncodedTree& tree = cooked.tree;
    const Box<double>& box = tree.nodes.root_box;
    double extent = 0;
    for (std::size_t k = 0; k < 3; ++k) extent = std::max(extent, box.high[k] - box.low[k]);
    if (tree.geometry.geometry != GeometryId::kGrid || !(extent > 0)) continue;
    const int bits = std::ilogb(extent) + tree.scale_exponent - tree.geometry.grid_exponent;
    if (least == nullptr || bits < least_bits) {
      least = &tree;
      least_bits = bits;
    }
    most_bits = std::max(most_bits, bits);
  }
  if (least == nullptr) return;
  if (least_bits == most_bits) {
    text += fmt::format("  grid: step 2^{}\n", least->geometry.grid_exponent);
    return;
  }
  text += fmt::format(
      "  one grid for all, step 2^{}: some 2^{} steps over {}, 2^{} over the largest; cooked apart "
      "it has a finer one, --exact keeps every bit\n",
      least->geometry.grid_exponent, least_bits, shown(least->name), most_bits);
}

// What was chosen for each tree, a line each.
void add_choices(const Summary& summary, std::string& text) {
  std::size_t width = 4;
  for (const CookedTree& cooked : summary.trees) width = std::max(width, cooked.tree.name.size());
  text += fmt::format("  {:<{}}  {:>9}  {:<10} {:<8} {:>10} {:>10}  {:>8}  {:>9}  {}\n", "tree",
                      width, "triangles", "codec", "geometry", "tree B/tri", "with geom.",
                      "slowdown", "error", "surface");
  for (const CookedTree& cooked : summary.trees) {
    const std::vector<Candidate>& candidates = cooked.contest.candidates;
    const std::vector<double> slower = slowdowns(cooked.contest);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const Candidate& candidate = candidates[i];
      if (!candidate.rejected.empty()) continue;
      text += fmt::format(
          "  {:<{}}  {:>9}  {:<10} {:<8} {:>10.2f} {:>10.2f}  {:>8.2f}  {:>9.2g}  {}\n",
          shown(cooked.tree.name), width, cooked.tree.triangle_count, codec_name(candidate.codec),
          geometry_name(candidate.geometry), per_triangle(candidate.tree_bytes, cooked.tree),
          per_triangle(candidate.bytes(), cooked.tree), slower[i], candidate.max_vertex_error,
          surface_text(cooked.edges));
    }
  }
  if (!summary.scene) add_shared_grid(summary.trees, text);
}

// The parts of one tree that were left out, for tools that look at trees alone.
void add_left_out(const Summary& summary, Json& trees) {
  for (const WhyLine& line : summary.why) {
    if (line.kept) continue;
    for (Json& tree : trees) {
      if (line.owner != "mesh " + tree["name"].get<std::string>()) continue;
      tree["left_out"].push_back(
          {{"what", line.part},
           {"bytes", line.bytes},
           {"why", line.line.empty() ? line.reason : line.reason + " (" + line.line + ")"}});
    }
  }
}

// How numbers of faces are stored, and what the other form would take.
void add_forms(const char* what, const std::optional<FaceNumberBytes>& forms, Json& tree) {
  if (!forms) return;
  tree[what] = {{"form", forms->keeps_runs() ? "runs" : "faces"},
                {"bytes", forms->kept()},
                {"bytes_by_runs", forms->runs ? Json(*forms->runs) : Json(nullptr)},
                {"bytes_by_face", forms->faces}};
}

// The same; several trees are told apart by their names.
void add_forms(const Summary& summary, std::string& text) {
  for (const CookedTree& cooked : summary.trees) {
    const std::string owner = summary.trees.size() == 1 ? "" : shown(cooked.tree.name) + ": ";
    for (const auto& [what, forms] : {std::pair("materials", &cooked.tree.material_forms),
                                      std::pair("user data", &cooked.tree.user_data_forms)}) {
      if (!*forms) continue;
      text += fmt::format("  {}{}: {}, {}\n", owner, what, counted((*forms)->kept(), "byte"),
                          forms_text(**forms));
    }
  }
}

// Which group or primitive has which number; of many the first ones.
void add_numbered(const char* what, const std::vector<std::string>& names, std::string& text) {
  constexpr std::size_t kMost = 12;
  if (names.empty()) return;
  text += fmt::format("  {}: ", what);
  for (std::size_t i = 0; i < std::min(names.size(), kMost); ++i) {
    text += fmt::format("{}{} {}", i == 0 ? "" : ", ", i, shown(names[i]));
  }
  if (names.size() > kMost) {
    text += fmt::format(", and {} more, which --json names", names.size() - kMost);
  }
  text += "\n";
}

void add_scene(const Summary& summary, Json& json) {
  const SceneSummary& scene = *summary.scene;
  add_left_out(summary, json["trees"]);
  json["imports"] = imports_json(summary.imports);
  json["scene"] = {{"instances", scene.instances},
                   {"moving", scene.moving},
                   {"instances_left_out", scene.instances_left_out},
                   {"source_meshes", scene.meshes},
                   {"placed_triangles", scene.placed_triangles},
                   {"file_bytes", summary.file_bytes}};
  json["notices"] = Json::array_of(scene.notices);
}

Json why_json(const std::vector<WhyLine>& why) {
  Json json = Json::array();
  for (const WhyLine& line : why) {
    json.push_back({{"part", line.part},
                    {"owner", line.owner},
                    {"kept", line.kept},
                    {"bytes", line.bytes},
                    {"estimate", line.is_estimate},
                    {"reason", line.reason},
                    {"line", line.line.empty() ? Json(nullptr) : Json(line.line)}});
  }
  return json;
}

}  // namespace

Json trees_json(const Summary& summary) {
  Json trees = Json::array();
  for (std::size_t i = 0; i < summary.trees.size(); ++i) {
    const CookedTree& cooked = summary.trees[i];
    Json tree = {{"name", cooked.tree.name},
                 {"triangles", cooked.tree.triangle_count},
                 {"lost_area", cooked.collapsed},
                 {"chosen", codec_name(cooked.tree.nodes.codec)},
                 {"chosen_geometry", geometry_name(cooked.tree.geometry.geometry)},
                 {"grid_step", grid_step_json(cooked.tree.geometry.geometry,
                                              cooked.tree.geometry.grid_exponent)},
                 {"surface", surface_json(cooked.edges)}};
    tree["candidates"] = Json::array();
    const std::vector<double> slower = slowdowns(cooked.contest);
    for (std::size_t c = 0; c < slower.size(); ++c) {
      tree["candidates"].push_back(
          candidate_json(cooked.contest.candidates[c], slower[c], cooked.tree));
    }
    tree["not_tried"] = Json::array();
    for (const NotTried& other : cooked.contest.not_tried) {
      tree["not_tried"].push_back({{"codec", codec_name(other.codec)},
                                   {"geometry", geometry_name(other.geometry)},
                                   {"why", other.why}});
    }
    add_forms("materials", cooked.tree.material_forms, tree);
    add_forms("user_data", cooked.tree.user_data_forms, tree);
    tree["left_out"] = Json::array();
    for (const LeftOut& part : cooked.left_out) {
      tree["left_out"].push_back({{"what", part.what}, {"bytes", part.bytes}, {"why", part.why}});
    }
    if (summary.imports.size() == summary.trees.size()) {
      tree["import"] = import_json(summary.imports[i]);
    }
    trees.push_back(tree);
  }
  return trees;
}

Json imports_json(const std::vector<ImportReport>& imports) {
  Json json = Json::array();
  for (const ImportReport& import : imports) json.push_back(import_json(import));
  return json;
}

Json summary_json(const Summary& summary) {
  Json json;
  json["trees"] = trees_json(summary);
  json["warnings"] = Json::array_of(warnings_of(summary));
  if (summary.scene) add_scene(summary, json);
  json["why"] = why_json(summary.why);
  return json;
}

namespace {

// "curv (line 7)", "curv (3, the first in line 7)", "EXT_mesh_gpu_instancing (3)".
std::string unread_text(const Unread& part) {
  std::string where = part.count == 1 && part.line > 0 ? "" : fmt::format("{}", part.count);
  if (part.line > 0) {
    where += fmt::format("{}line {}", where.empty() ? "" : ", the first in ", part.line);
  }
  return fmt::format("{} ({})", shown(part.what), where);
}

// One warning for all parts that have the same remedy.
void add_unread(const ImportReport& import, const std::string& source,
                std::vector<std::string>& warnings) {
  std::vector<std::pair<std::string, std::string>> lists;  // remedy, parts
  for (const Unread& part : import.unread) {
    const auto has_remedy = [&part](const auto& list) { return list.first == part.remedy; };
    const auto known = std::find_if(lists.begin(), lists.end(), has_remedy);
    if (known == lists.end()) {
      lists.emplace_back(part.remedy, unread_text(part));
    } else {
      known->second += ", " + unread_text(part);
    }
  }
  for (const auto& [remedy, parts] : lists) {
    warnings.push_back(
        fmt::format("{}: not read, and may be geometry: {}; {}", source, parts, remedy));
  }
}

}  // namespace

std::vector<std::string> warnings_of(const ImportReport& import) {
  const std::string source = input_name(source_of(import));
  std::vector<std::string> warnings;
  for (const std::filesystem::path& file : import.files_missing) {
    warnings.push_back(
        fmt::format("{}: {} is not there: no file of that name can be read. Faces and the "
                    "names of their materials are complete without it",
                    source, file.string()));
  }
  if (import.has_no_materials) {
    warnings.push_back(fmt::format(
        "{}: --materials finds no material: usemtl of OBJ files, glTF, FBX and others have some",
        source));
  }
  if (import.has_no_groups) {
    warnings.push_back(
        fmt::format("{}: no line 'g' begins a group: the user data of every face is 0", source));
  }
  if (import.has_open_end) {
    warnings.push_back(fmt::format(
        "{}: the last line has no end{}{}", source,
        import.has_half_face ? " and is half a face, which is left out" : "", kAsIfCut));
  }
  add_unread(import, source, warnings);
  if (import.moved_by_f32 > 0) {
    std::string remedy = cook_remedy_of(import.f32_loss);
    if (import.f32_loss != F32Loss::kReader) {
      remedy += ", and with --tolerance LENGTH or the tolerance of a profile in few bytes";
    }
    // So small a move is noticed in tiny meshes alone (unnoticed_move).
    const bool is_tiny = import.moved_by_f32 <= std::numeric_limits<float>::denorm_min();
    warnings.push_back(fmt::format(
        "{}: f32 has few digits for a mesh so {} and moved a vertex by up to {}; {}", source,
        is_tiny ? "small" : "far from the origin", at_most(import.moved_by_f32, 3), remedy));
  } else if (import.flattened_by_f32 > 0) {
    warnings.push_back(fmt::format("{}: {} of {} faces have an area in f64 and none in f32; {}",
                                   source, import.flattened_by_f32, import.source_faces,
                                   cook_remedy_of(import.f32_loss)));
  }
  if (import.has_f32_alone && import.moved_by_f32 == 0) {
    warnings.push_back(
        fmt::format("{}: its coordinates were read as f32, and --f64 keeps no more", source));
  }
  return warnings;
}

// With this share of its triangles gone, a surface is no longer that of the mesh.
constexpr double kShareToWarnOf = 0.5;

// Trees that a grid left little of.
std::vector<std::string> lost_surfaces(const std::vector<CookedTree>& trees) {
  std::vector<std::string> warnings;
  for (const CookedTree& cooked : trees) {
    const std::uint32_t all = cooked.tree.triangle_count;
    if (cooked.collapsed == 0 || cooked.collapsed < kShareToWarnOf * all) continue;
    warnings.push_back(fmt::format(
        "tree {}: {} of {} triangles lost their area on a grid of step 2^{}, which moved a vertex "
        "by up to {}; a smaller tolerance or more --grid-bits keep it, --exact keeps all",
        cooked.tree.name, cooked.collapsed, all, cooked.tree.geometry.grid_exponent,
        at_most(cooked.tree.geometry.max_vertex_error, 3)));
  }
  return warnings;
}

struct NamedTrees {
  std::size_t first;
  std::size_t count = 0;
};

// Names that are the number of another tree: the first in words, since a scene may have thousands.
std::string numbers_as_names(const std::vector<CookedTree>& trees,
                             const std::map<std::string, NamedTrees>& named) {
  std::string warning;
  std::size_t others = 0;
  for (std::size_t i = 0; i < trees.size(); ++i) {
    const auto found = named.find(fmt::format("{}", i));
    if (found == named.end() || found->second.first == i) continue;
    if (!warning.empty()) {
      ++others;
      continue;
    }
    const std::string& name = trees[i].tree.name;
    const bool has_name = !name.empty() && named.at(name).first == i;
    warning = fmt::format(
        "tree {0}: --tree {0} takes the tree of that name, number {1}; {2} tree number {0}, and "
        "\"tree\": {0} does in a line of a batch",
        i, found->second.first,
        has_name ? fmt::format("--tree {} takes", name) : "no --tree takes");
  }
  if (others > 0) {
    warning += fmt::format("; {} other {}, too", others,
                           others == 1 ? "number is a name" : "numbers are names");
  }
  return warning;
}

// What names hide that several inputs, or several meshes of a scene, gave their trees.
std::vector<std::string> hiding_names(const std::vector<CookedTree>& trees) {
  std::map<std::string, NamedTrees> named;
  for (std::size_t i = 0; i < trees.size(); ++i) {
    ++named.try_emplace(trees[i].tree.name, NamedTrees{i}).first->second.count;
  }
  std::vector<std::string> warnings;
  const std::string of_numbers = numbers_as_names(trees, named);
  if (!of_numbers.empty()) warnings.push_back(of_numbers);
  for (const auto& [name, of_name] : named) {
    if (of_name.count == 1 || name.empty()) continue;
    warnings.push_back(fmt::format(
        "tree {0}: {1} trees of the file have this name; --tree {0} and find_tree() take "
        "the first, --tree NUMBER {2}",
        name, of_name.count,
        of_numbers.empty() ? "any" : "those whose number is no name of another"));
  }
  return warnings;
}

std::vector<std::string> warnings_of(const Summary& summary) {
  std::vector<std::string> all;
  const auto add = [&all](const std::vector<std::string>& some) {
    for (const std::string& warning : some) {
      if (std::find(all.begin(), all.end(), warning) == all.end()) all.push_back(warning);
    }
  };
  if (!summary.costs_warning.empty()) add({"--costs: " + summary.costs_warning});
  for (const ImportReport& import : summary.imports) add(warnings_of(import));
  if (summary.scene) add(summary.scene->notices);
  add(hiding_names(summary.trees));
  add(lost_surfaces(summary.trees));
  return all;
}

std::string trees_text(const Summary& summary, bool candidates) {
  std::string text;
  if (candidates) {
    for (const CookedTree& cooked : summary.trees) {
      text +=
          fmt::format("{}: {}, {}\n", shown(cooked.tree.name),
                      counted(cooked.tree.triangle_count, "triangle"), surface_text(cooked.edges));
      add_contest(cooked, text);
      add_grid(cooked, text);
    }
  } else if (summary.trees.size() == 1 && !summary.scene) {
    add_choice(summary.trees.front(), summary.file_bytes, text);
  } else {
    add_choices(summary, text);
  }
  if (!summary.scene) add_forms(summary, text);
  for (const ImportReport& import : summary.imports) {
    add_numbered("groups", import.groups, text);
    add_numbered("primitives", import.primitives, text);
  }
  for (const ImportReport& import : summary.imports) add_import(import, text);
  return text;
}

std::string scene_text(const Summary& summary, bool candidates) {
  const SceneSummary& scene = *summary.scene;
  std::string text = trees_text(summary, candidates);
  text += fmt::format("scene: {} ({} moving) of {}, {} placed, {} bytes\n",
                      counted(scene.instances, "instance"), scene.moving,
                      counted(summary.trees.size(), "tree"),
                      counted(scene.placed_triangles, "triangle"), summary.file_bytes);
  if (scene.instances_left_out > 0 || scene.meshes > summary.trees.size()) {
    text += fmt::format("  left out: {}, {} {}\n", counted(scene.instances_left_out, "instance"),
                        scene.meshes - summary.trees.size(),
                        scene.meshes - summary.trees.size() == 1 ? "mesh" : "meshes");
  }
  return text;
}

std::string why_text(const Summary& summary) {
  std::string text;
  std::size_t part_width = 4, owner_width = 5;
  for (const WhyLine& line : summary.why) {
    part_width = std::max(part_width, line.part.size());
    owner_width = std::max(owner_width, line.owner.size());
  }
  std::uint64_t kept = 0;
  for (const bool wanted : {true, false}) {
    text +=
        fmt::format("{}\n", wanted ? "kept:" : "left out (about how much it would have taken):");
    const auto is_here = [wanted](const WhyLine& line) { return line.kept == wanted; };
    if (std::none_of(summary.why.begin(), summary.why.end(), is_here)) text += "  nothing\n";
    for (const WhyLine& line : summary.why) {
      if (!is_here(line)) continue;
      if (wanted) kept += line.bytes;
      const std::string bytes = wanted || !line.is_estimate ? fmt::format("{}", line.bytes)
                                                            : fmt::format("~{}", line.bytes);
      text += fmt::format("  {:<{}}  {:<{}}  {:>12}  {}{}{}\n", line.part, part_width,
                          shown(line.owner), owner_width, bytes, shown(line.reason),
                          line.line.empty() ? "" : "  <- ", shown(line.line));
    }
    if (wanted)
      text += fmt::format("  {:<{}}  {:<{}}  {:>12}\n", "sum", part_width, "", owner_width, kept);
  }
  return text;
}

Error explained(const Error& error, const CookJob& job, const std::string& output) {
  const std::string profile = job.profile.string();
  const bool is_of_profile = !profile.empty() && error.detail.starts_with(profile + ":");
  if (error.code == Errc::kInvalidPose) {
    if (!profile.empty()) return is_of_profile ? error : in_file(profile, error);
    const Error advised = {
        error.code, error.detail + "; --flatten makes one tree of a file, whatever its transforms"};
    return job.inputs.size() == 1 ? in_file(input_name(job.inputs[0]), advised) : advised;
  }
  if (error.code == Errc::kBudgetUnreachable && !is_of_profile) return in_file(output, error);
  return error;
}

}  // namespace boxtree::cooker
