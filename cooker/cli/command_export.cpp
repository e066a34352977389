// SPDX-License-Identifier: MIT
// `boxtree export`: triangles and boxes as a file for viewers.
#include <charconv>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <boxtree/cooker/cli/open_file.h>
#include <boxtree/cooker/cli/output.h>
#include <boxtree/cooker/export/export.h>
#include <boxtree/cooker/import/import.h>
#include <boxtree/cooker/import/mesh_arrays.h>

namespace boxtree::cooker {
namespace {

struct Arguments {
  std::filesystem::path file;
  std::filesystem::path output;
  std::string tree;
  std::filesystem::path mesh;
  std::string levels;
  std::string order;
  bool triangles = false;
  bool boxes = false;
  bool leaves = false;
  bool solid = false;
  bool json = false;
};

int usage(const std::string& what) {
  fmt::print(stderr, "boxtree: {}\n", what);
  return kExitUsage;
}

// "0-3,6": levels and ranges of levels.
std::optional<std::vector<LevelRange>> parse_levels(std::string_view text) {
  std::vector<LevelRange> ranges;
  const char* at = text.data();
  const char* const end = at + text.size();
  while (true) {
    LevelRange range;
    const auto [first_end, first_error] = std::from_chars(at, end, range.first);
    if (first_error != std::errc()) return std::nullopt;
    at = first_end;
    range.last = range.first;
    if (at != end && *at == '-') {
      const auto [last_end, last_error] = std::from_chars(at + 1, end, range.last);
      if (last_error != std::errc() || range.last < range.first) return std::nullopt;
      at = last_end;
    }
    ranges.push_back(range);
    if (at == end) return ranges;
    if (*at++ != ',') return std::nullopt;
  }
}

// What is asked for by name is shown; without any name, triangles and the first levels.
std::optional<ExportOptions> options_of(const Arguments& arguments) {
  ExportOptions options;
  options.triangles = arguments.triangles || !arguments.boxes;
  const bool named_boxes = arguments.boxes || arguments.leaves || !arguments.levels.empty();
  if (!arguments.levels.empty()) {
    std::optional<std::vector<LevelRange>> levels = parse_levels(arguments.levels);
    if (!levels) return std::nullopt;
    options.levels = std::move(*levels);
  } else if (arguments.leaves || (arguments.triangles && !named_boxes)) {
    options.levels.clear();
  }
  options.leaves = arguments.leaves;
  options.solid_boxes = arguments.solid;
  if (arguments.order == "source") options.order = ExportOrder::kSource;
  if (arguments.order == "tree") options.order = ExportOrder::kTree;
  return options;
}

bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::error_code ignored;  // a file that is not there is no other
  return !a.empty() && !b.empty() && std::filesystem::equivalent(a, b, ignored);
}

// The trees asked for, bound to `mesh` where their geometry is external.
Result<std::vector<Tree>> bind_trees(const Arguments& arguments, const File& file,
                                     bool with_triangles, Imported& mesh) {
  std::vector<std::uint32_t> numbers;
  if (arguments.tree.empty()) {
    for (std::uint32_t i = 0; i < file.tree_count(); ++i) numbers.push_back(i);
  } else {
    const Result<std::uint32_t> number = find_tree(file, arguments.tree);
    if (!number) return number.error();
    numbers.push_back(*number);
  }
  BindOptions options;
  if (!arguments.mesh.empty()) {
    ImportOptions import;
    for (const std::uint32_t i : numbers) {
      if (i >= file.tree_count()) continue;
      if ((file.tree_record(i).flags & kTreePositionsF64) != 0) import.precision = Precision::kF64;
    }
    Result<Imported> imported = import_mesh(arguments.mesh, import);
    if (!imported) return imported.error();
    mesh = std::move(*imported);
    options.mesh = arrays_of(mesh.mesh);
    options.verify_mesh = true;
  }
  std::vector<Tree> trees;
  for (const std::uint32_t i : numbers) {
    if (arguments.mesh.empty() && !with_triangles && i < file.tree_count()) {
      options.mesh = absent_arrays(file.tree_record(i));
    }
    Result<Tree> tree = Tree::bind(file, i, options);
    if (!tree) {
      return Error{tree.code(), arguments.file.string() + ": " + tree.error().detail};
    }
    trees.push_back(std::move(*tree));
  }
  return trees;
}

Json tree_json(const ExportedTree& tree) {
  Json json = {{"name", tree.name},
               {"vertices", tree.vertices},
               {"faces", tree.faces},
               {"triangles", tree.triangles}};
  json["levels"] = Json::array();
  json["leaves"] = nullptr;
  for (const BoxGroup& group : tree.boxes) {
    if (group.level) {
      json["levels"].push_back({{"level", *group.level}, {"boxes", group.count}});
    } else {
      json["leaves"] = group.count;
    }
  }
  json["translation"] = {tree.translation[0], tree.translation[1], tree.translation[2]};
  return json;
}

void report(const Arguments& arguments, const ExportReport& report) {
  if (arguments.json) {
    Json json = {{"output", arguments.output.string()}, {"bytes", report.bytes}};
    json["trees"] = Json::array();
    for (const ExportedTree& tree : report.trees) json["trees"].push_back(tree_json(tree));
    print(json);
    return;
  }
  fmt::print("{}: {} bytes\n", arguments.output.string(), report.bytes);
  for (const ExportedTree& tree : report.trees) {
    fmt::print("{}: {} triangles", tree.name, tree.triangles);
    for (const BoxGroup& group : tree.boxes) {
      fmt::print(", {}: {} {}", group.name(), group.count, group.count == 1 ? "box" : "boxes");
    }
    fmt::print("\n");
  }
}

int run(const Arguments& arguments) {
  const std::optional<ExportOptions> options = options_of(arguments);
  if (!options) {
    return usage(
        fmt::format("--levels: expected levels as in 0-3,6, found \"{}\"", arguments.levels));
  }
  if (is_same_file(arguments.output, arguments.file) ||
      is_same_file(arguments.output, arguments.mesh)) {
    return usage(arguments.output.string() + ": is what it would be made from");
  }
  const Result<OpenedFile> opened = open_file(arguments.file);
  if (!opened) return fail(opened.error());
  Imported mesh;
  const Result<std::vector<Tree>> trees =
      bind_trees(arguments, opened->file, options->triangles, mesh);
  if (!trees) return fail(trees.error());
  const Result<ExportReport> exported = export_trees(*trees, arguments.output, *options);
  if (!exported) return fail(exported.error());
  report(arguments, *exported);
  return 0;
}

}  // namespace

void add_export_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command =
      *app.add_subcommand("export", "Show triangles and boxes in a viewer: OBJ or glTF");
  command.add_option("file", arguments->file, "A .bxt file")->required();
  command.add_option("-o,--output", arguments->output, "A name in .obj or .glb")->required();
  command.add_option("--tree", arguments->tree, "Which tree, by number or name [all]");
  command.add_flag("--triangles", arguments->triangles, "Show triangles");
  command.add_flag("--boxes", arguments->boxes, "Show boxes; neither of the two: both");
  command.add_option("--levels", arguments->levels,
                     "Boxes of these levels, as in 0-3,6; the root is level 0 [0-3]");
  command.add_flag("--leaves", arguments->leaves, "Boxes of all leaves");
  command.add_flag("--json", arguments->json, "Print one JSON document");
  command.add_flag("--solid", arguments->solid, "Boxes as faces, not as lines")
      ->group(kRareOptions);
  command.add_option("--order", arguments->order, "Of faces [source, if face ids tell it]")
      ->check(CLI::IsMember({"source", "tree"}))
      ->group(kRareOptions);
  command.add_option("--mesh", arguments->mesh, "The source mesh of a tree cooked with --external")
      ->group(kRareOptions);
  command.callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace boxtree::cooker
