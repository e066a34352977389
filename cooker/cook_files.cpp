// SPDX-License-Identifier: MIT
// Files through all stages, and the record of how they were cooked.
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <boxtree/cooker/cook.h>
#include <boxtree/cooker/version.h>
#include <boxtree/cooker/write/blob_writer.h>
#include <boxtree/runtime/query/float_state.h>

namespace boxtree::cooker {
namespace {

nlohmann::ordered_json grid_record(const CookOptions& options) {
  if (options.geometry != GeometryId::kGrid && !options.may_use_grid) return nullptr;
  if (options.grid.tolerance) return {{"tolerance", *options.grid.tolerance}};
  return {{"bits", options.grid.bits}};
}

nlohmann::ordered_json budget(const std::optional<double>& limit) {
  if (!limit) return nullptr;
  return *limit;
}

std::string cook_record(const CookOptions& options, const std::vector<CookedTree>& trees,
                        const std::vector<ImportReport>& imports) {
  nlohmann::ordered_json record;
  record["tool"] = fmt::format("boxtree {}", kVersion);
  record["options"] = {
      {"codec", options.codec ? std::string(codec_name(*options.codec)) : "auto"},
      {"for", goal_name(options.wishes.goal)},
      {"max_bytes_per_triangle", budget(options.wishes.max_bytes_per_triangle)},
      {"max_slowdown", budget(options.wishes.max_slowdown)},
      {"builder", options.builder == Builder::kPaper ? "paper" : "sah"},
      {"widths", options.widths == FieldWidths::kExact ? "exact" : "estimated"},
      {"geometry", options.may_use_grid ? "auto" : std::string(geometry_name(options.geometry))},
      {"grid", grid_record(options)},
      {"face_ids", options.face_ids},
      {"precision", options.import.precision == Precision::kF64 ? "f64" : "f32"},
      {"skip_bad", options.import.skip_bad}};
  record["sources"] = nlohmann::ordered_json::array();
  for (std::size_t i = 0; i < imports.size(); ++i) {
    record["sources"].push_back({{"name", trees[i].tree.name},
                                 {"xxh3", fmt::format("{:016x}", imports[i].content_hash)},
                                 {"faces", imports[i].source_faces}});
  }
  return record.dump(-1, ' ', true, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

// One grid for all inputs, so that what touches still does. Each is imported for its bounds, and
// later again: memory, not time, is what inputs cost.
Result<Grid> scene_grid(const std::vector<std::filesystem::path>& inputs,
                        const CookOptions& options) {
  Eigen::AlignedBox3d bounds;
  for (const std::filesystem::path& input : inputs) {
    const Result<Imported> imported = import_mesh(input, options.import);
    if (!imported) return imported.error();
    bounds.extend(bounds_of(imported->mesh));
  }
  return choose_grid(bounds, options.grid);
}

// Keeps what the report tells of a tree and gives its bytes back.
void release(CookedTree& cooked) {
  cooked.tree.nodes.bytes = {};
  cooked.tree.geometry.vertices = {};
  cooked.tree.geometry.corners = {};
  cooked.tree.geometry.face_ids = {};
}

}  // namespace

Result<CookReport> cook(const std::vector<std::filesystem::path>& inputs,
                        const std::filesystem::path& output, const CookOptions& options,
                        const Progress& progress) {
  const DefaultFloatState state;
  const auto step = [&](const std::string& what) {
    if (progress) progress(what);
  };
  const bool is_scene =
      inputs.size() > 1 && (options.geometry == GeometryId::kGrid || options.may_use_grid);
  std::optional<Grid> scene;
  if (is_scene) {
    step("measure the scene");
    Result<Grid> grid = scene_grid(inputs, options);
    if (!grid && !options.may_use_grid) return grid.error();
    if (grid) scene = *grid;
  }
  // All that may be chosen stays until the geometry store, which the trees share, is known.
  std::vector<TriedTree> tried;
  std::vector<Contest> contests;
  CookReport report;
  for (const std::filesystem::path& input : inputs) {
    const std::string name = input.filename().string();
    step("import " + name);
    Result<Imported> imported = import_mesh(input, options.import);
    if (!imported) return imported.error();
    imported->mesh.name = input.stem().string();
    step("build " + name);
    Result<TriedTree> tree = try_encodings(imported->mesh, options, scene);
    if (!tree) return tree.error();
    contests.push_back(std::move(tree->contest));
    tried.push_back(std::move(*tree));
    report.imports.push_back(std::move(imported->report));
  }
  const auto chosen = choose(contests, options.wishes);
  if (!chosen) return chosen.error();
  std::vector<EncodedTree> trees;
  for (std::size_t i = 0; i < tried.size(); ++i) {
    tried[i].contest = std::move(contests[i]);
    CookedTree cooked = cooked_of(std::move(tried[i]), (*chosen)[i], options);
    trees.push_back(std::move(cooked.tree));
    cooked.tree.name = trees.back().name;
    report.trees.push_back(std::move(cooked));
  }
  step("write " + output.filename().string());
  const std::string record =
      options.cook_record ? cook_record(options, report.trees, report.imports) : std::string();
  const Status written = options.blob ? write_blob(output, trees, record, *options.blob)
                                      : write_file(output, trees, record);
  if (!written) return written.error();
  for (std::size_t i = 0; i < trees.size(); ++i) {
    report.trees[i].tree = std::move(trees[i]);
    release(report.trees[i]);
  }
  return report;
}

}  // namespace boxtree::cooker
