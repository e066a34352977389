// SPDX-License-Identifier: MIT
// `boxtree export`: triangles and boxes as a file for viewers.
#include <algorithm>
#include <array>
#include <charconv>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/cli/command.h"
#include "cooker/cli/commands.h"
#include "cooker/cli/json_output.h"
#include "cooker/cli/open_file.h"
#include "cooker/cli/output.h"
#include "cooker/cli/standard_streams.h"
#include "cooker/export/export.h"
#include "cooker/import/file_error.h"
#include "cooker/import/import.h"
#include "cooker/import/mesh_arrays.h"
#include "cooker/import/source_scene.h"
#include "cooker/text/counted.h"
#include "cooker/text/nearest_name.h"
#include "cooker/write/outputs.h"
#include "format/tree_record.h"
#include "runtime/file/open_file.h"

namespace boxtree::cooker {
namespace {

struct ExportArguments {
  std::filesystem::path file;
  std::filesystem::path output;
  std::string tree;
  std::filesystem::path mesh;
  std::string levels;
  std::string order;
  std::string format;
  bool quiet = false;
  bool triangles = false;
  bool boxes = false;
  bool leaves = false;
  bool solid = false;
  bool trees = false;
  bool json = false;
};

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

// What is requested by name is shown; without any name, triangles and the first levels.
std::optional<ExportOptions> options_of(const ExportArguments& arguments) {
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

Result<std::vector<std::uint32_t>> chosen_trees(const ExportArguments& arguments,
                                                const File& file) {
  std::vector<std::uint32_t> numbers;
  if (arguments.tree.empty()) {
    for (std::uint32_t i = 0; i < file.tree_count(); ++i) numbers.push_back(i);
    return numbers;
  }
  const Result<std::uint32_t> number = find_tree(file, {arguments.tree});
  if (!number) return in_file(input_name(arguments.file), number.error());
  numbers.push_back(*number);
  return numbers;
}

// The meshes that trees with external geometry are made of.
class SourceMeshes {
 public:
  // What `path` is as one mesh and, as trees of a scene may come from nodes of it, its meshes one
  // by one.
  static Result<SourceMeshes> read(const std::filesystem::path& path, const File& file,
                                   std::span<const std::uint32_t> trees) {
    ImportOptions options = careful_import();
    for (const std::uint32_t i : trees) {
      if (i >= file.tree_count()) continue;
      if ((record_of(file, i).flags & kTreePositionsF64) != 0) options.precision = Precision::kF64;
    }
    SourceMeshes meshes;
    Result<Imported> whole = import_mesh(path, options);
    if (!whole) return whole.error();
    if (Status status = meshes.add(std::move(whole->mesh)); !status) return status.error();
    if (!file.has_scene()) return meshes;
    Result<SourceScene> scene = import_scene(path, options);
    if (!scene) return scene.error();
    for (SceneMesh& mesh : scene->meshes) {
      if (Status status = meshes.add(std::move(mesh.mesh)); !status) return status.error();
    }
    return meshes;
  }

  // The one with the content of the tree's; else any, for binding to say what is wrong with it.
  [[nodiscard]] MeshArrays find(const TreeRecord& record) const {
    const auto place = std::find(hashes_.begin(), hashes_.end(), record.geometry_hash);
    if (place == hashes_.end()) return arrays_of(meshes_.front());
    return arrays_of(meshes_[static_cast<std::size_t>(place - hashes_.begin())]);
  }

 private:
  Status add(SourceMesh mesh) {
    const Result<std::uint64_t> hash = geometry_hash(arrays_of(mesh));
    if (!hash) return hash.error();
    hashes_.push_back(*hash);
    meshes_.push_back(std::move(mesh));
    return {};
  }

  std::vector<SourceMesh> meshes_;
  std::vector<std::uint64_t> hashes_;  // of content, one a mesh
};

// The trees requested, bound to `meshes` where their geometry is external.
Result<std::vector<Tree>> bind_trees(const ExportArguments& arguments, const File& file,
                                     bool with_triangles, std::optional<SourceMeshes>& meshes) {
  const Result<std::vector<std::uint32_t>> numbers = chosen_trees(arguments, file);
  if (!numbers) return numbers.error();
  if (!arguments.mesh.empty()) {
    Result<SourceMeshes> read = SourceMeshes::read(arguments.mesh, file, *numbers);
    if (!read) return read.error();
    meshes = std::move(*read);
  }
  std::vector<Tree> trees;
  for (const std::uint32_t i : *numbers) {
    BindOptions options;
    if (i < file.tree_count() && meshes) {
      options.mesh = meshes->find(record_of(file, i));
      options.verify_mesh = true;
    } else if (i < file.tree_count() && !with_triangles) {
      options.mesh = absent_arrays(record_of(file, i));
    }
    Result<Tree> tree = Tree::bind(file, i, options);
    if (tree.code() == Errc::kExternalMeshNeeded) {
      return Error{tree.code(),
                   fmt::format("{}: {}: name the one that it was cooked of with --mesh MESH",
                               input_name(arguments.file), tree.error().detail)};
    }
    if (!tree) return in_file(arguments.file, naming_mesh(arguments.mesh, tree.error()));
    trees.push_back(std::move(*tree));
  }
  return trees;
}

// The scene of the file, unless trees are requested.
Result<ExportReport> export_file(const ExportArguments& arguments, const OutputTarget& output,
                                 const File& file, std::span<const Tree> trees,
                                 const ExportOptions& options) {
  if (!file.has_scene() || arguments.trees || !arguments.tree.empty()) {
    return export_trees(trees, output, options);
  }
  const Result<Scene> scene = bind_without_meshes(file);
  if (!scene) return Error{scene.code(), arguments.file.string() + ": " + scene.error().detail};
  return export_scene(*scene, trees, output, options);
}

Json tree_json(const ExportedTree& tree, bool is_placed) {
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
  json["translation"] = to_json(tree.translation);
  json["instances"] = is_placed ? Json(tree.instances) : Json(nullptr);
  return json;
}

Json report_json(const ExportArguments& arguments, const ExportReport& report) {
  Json json = {{"output", arguments.output.string()}, {"bytes", report.bytes}};
  json["scene"] = nullptr;
  if (report.instances) {
    json["scene"] = {{"instances", *report.instances},
                     {"placed_triangles", report.placed_triangles}};
  }
  json["trees"] = Json::array();
  for (const ExportedTree& tree : report.trees) {
    json["trees"].push_back(tree_json(tree, report.instances.has_value()));
  }
  return json;
}

// `output`: the name of what was written.
std::string report_text(const std::string& output, const ExportReport& report,
                        bool with_triangles) {
  std::string text = fmt::format("{}: {} bytes\n", shown(output), report.bytes);
  if (report.instances) {
    text += "scene: " + counted(*report.instances, "instance");
    if (with_triangles)
      text += fmt::format(", {} placed", counted(report.placed_triangles, "triangle"));
    text += "\n";
  }
  for (const ExportedTree& tree : report.trees) {
    std::vector<std::string> parts;
    if (with_triangles) parts.push_back(counted(tree.triangles, "triangle"));
    for (const BoxGroup& group : tree.boxes) {
      parts.push_back(
          fmt::format("{}: {}", group.name(),
                      group.count == 1 ? "1 box" : fmt::format("{} boxes", group.count)));
    }
    if (report.instances) parts.push_back(counted(tree.instances, "instance"));
    text += fmt::format("{}: {}\n", shown(tree.name), joined(parts, ", "));
  }
  return text;
}

int run(const ExportArguments& arguments) {
  const std::optional<ExportOptions> options = options_of(arguments);
  if (!options) {
    return usage(fmt::format("export: --levels: expected levels as in 0-3,6, found \"{}\"",
                             arguments.levels));
  }
  if (!is_standard_stream(arguments.output) && !arguments.format.empty()) {
    return usage("export: --format goes with the output -");
  }
  if (is_standard_stream(arguments.output) && arguments.json) {
    return usage("export: --json and -o - cannot share standard output");
  }
  const Result<OutputTarget> output =
      output_target(arguments.output, arguments.format.empty() ? "glb" : arguments.format);
  if (!output) return usage("export: " + output.error().detail);
  if (const Result<bool> is_glb = is_glb_name(output->path); !is_glb) {
    return usage("export: --output: " + is_glb.error().detail);
  }
  std::vector<std::filesystem::path> inputs{arguments.file};
  if (!arguments.mesh.empty()) inputs.push_back(arguments.mesh);
  if (!output->stream) {
    const Status status = check_outputs(std::array{Output{output->path}}, inputs);
    if (!status) return usage("export: " + status.error().detail);
    const Status replaced = check_replaced(
        output->path, *is_glb_name(output->path) ? OutputKind::kShownGlb : OutputKind::kShownObj);
    if (!replaced) return usage("export: " + replaced.error().detail);
  }
  const Result<OpenedFile> opened = open_file(arguments.file);
  if (!opened) return fail(opened.error());
  std::optional<SourceMeshes> meshes;  // what trees may point into
  const Result<std::vector<Tree>> trees =
      bind_trees(arguments, opened->file, options->triangles, meshes);
  if (!trees) return fail(trees.error());
  const Result<ExportReport> exported =
      export_file(arguments, *output, opened->file, *trees, *options);
  if (exported.code() == Errc::kInvalidQuery) {  // of levels, which are those of the file
    return fail(in_file(input_name(arguments.file), exported.error()));
  }
  if (!exported) return fail(exported.error());
  if (arguments.json) {
    print(report_json(arguments, *exported));
  } else if (!arguments.quiet) {
    tell(*output, report_text(output->title(), *exported, options->triangles));
  }
  return 0;
}

}  // namespace

void add_export_command(Command& program, int& status) {
  const auto arguments = std::make_shared<ExportArguments>();
  Command& command = program.add_command("export",
                                         "Write triangles and boxes for a viewer, as OBJ or glTF\n"
                                         "Without --triangles, --boxes, --levels and --leaves: "
                                         "triangles, and boxes of levels 0 to 3.");
  command
      .add_file("FILE", arguments->file, Values::kCookedFiles,
                "The file to show; - is standard input")
      ->required();
  command
      .add_file("-o,--output", arguments->output, Values::kFiles,
                "What to write: a name in .obj or .glb, or - for standard output")
      ->required();
  command.add_option("--format", arguments->format, "Of the output - [glb]")
      ->type_name("FORMAT")
      ->one_of({"glb", "obj"});
  command.add_flag("-q,--quiet", arguments->quiet, "Print errors only");
  command
      .add_option("--tree", arguments->tree,
                  "One tree alone, in its own coordinates: name or number")
      ->type_name("TREE");
  command.add_flag("--trees", arguments->trees,
                   "Each tree once, in its own coordinates, not the scene that places them");
  command.add_flag("--triangles", arguments->triangles, "Show triangles");
  command.add_flag("--boxes", arguments->boxes, "Show boxes; neither of the two: both");
  command
      .add_option("--levels", arguments->levels,
                  "Boxes of these levels, as in 0-3,6; the root is level 0 [0-3]")
      ->type_name("LEVELS");
  command.add_flag("--leaves", arguments->leaves, "Boxes of all leaves");
  command.add_flag("--json", arguments->json, "Print one JSON document");
  command.add_flag("--solid", arguments->solid, "Boxes as faces, not as lines")
      ->group(kRareOptions);
  command.add_option("--order", arguments->order, "Of faces [source, if face ids tell it]")
      ->type_name("ORDER")
      ->one_of({"source", "tree"})
      ->group(kRareOptions);
  command
      .add_file("--mesh", arguments->mesh, Values::kMeshes,
                "The source of trees cooked with --external")
      ->group(kRareOptions);
  command.example("Triangles and the boxes of levels 0 to 3",
                  "boxtree export bunny.bxt -o bunny.glb");
  command.example("The boxes of all leaves",
                  "boxtree export bunny.bxt -o leaves.obj --boxes --leaves");
  command.callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace boxtree::cooker
