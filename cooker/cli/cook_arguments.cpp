// SPDX-License-Identifier: MIT
#include "cooker/cli/cook_arguments.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "cooker/cli/standard_streams.h"
#include "cooker/import/import.h"
#include "cooker/text/nearest_name.h"
#include "cooker/text/number_of.h"
#include "format/codec.h"
#include "format/grid.h"

namespace boxtree::cooker {
namespace {

// Refused here, because assimp looks for a reader by the first bytes if it does not know an ending.
std::string ending_fault(const std::string& text) {
  if (is_mesh_ending(text)) return {};
  return fmt::format("expected the ending of a mesh file, as obj, found \"{}\"{}", text,
                     suggestion(text, mesh_endings()));
}

bool is_step_exponent(int exponent) {
  return std::abs(exponent) <= kMaxStepExponent;
}

// The exponent of a step as `cook` prints it, "2^-13", or as a decimal, "0.125"; nothing if the
// text is no power of two.
std::optional<int> step_exponent_of(std::string_view text) {
  constexpr std::string_view kBase = "2^";
  std::optional<int> exponent;
  if (text.starts_with(kBase)) {
    exponent = number_of<int>(text.substr(kBase.size()));
  } else if (const auto step = number_of<double>(text); step && *step > 0 && std::isfinite(*step)) {
    const int above = exponent_above(*step);
    if (std::ldexp(1.0, above) == *step) exponent = above;
  }
  return exponent && is_step_exponent(*exponent) ? exponent : std::nullopt;
}

// "; the nearest are 2^-4 and 2^-3" of a length between them.
std::string nearest_steps(std::string_view text) {
  const auto step = number_of<double>(text);
  if (!step || !(*step > 0) || !std::isfinite(*step)) return {};
  const int above = exponent_above(*step);
  if (!is_step_exponent(above) || !is_step_exponent(above - 1)) return {};
  return fmt::format("; the nearest are 2^{} and 2^{}", above - 1, above);
}

std::string step_fault(const std::string& text) {
  if (step_exponent_of(text)) return {};
  return fmt::format(
      "expected a power of two from 2^-{0} to 2^{0}, as cook prints it (2^-13) or in decimals, "
      "found \"{1}\"{2}",
      kMaxStepExponent, text, nearest_steps(text));
}

// The options of the cook that names on the command line stand for.
void set_options(CookArguments& arguments) {
  CookOptions& options = arguments.job.options;
  if (arguments.grid_bits_option->count() + arguments.grid_step_option->count() > 0)
    options.geometry = GeometryId::kGrid;
  if (arguments.codec == "blob-lzma") options.blob = BlobMethod::kLzma;
  if (arguments.codec == "blob-zstd") options.blob = BlobMethod::kZstd;
  if (options.blob) {
    options.codec = CodecId::kPlainF32;  // as the paper does
  } else if (arguments.codec != "auto") {
    options.codec = find_codec(arguments.codec);
  }
  if (arguments.goal == "memory") options.wishes.goal = Goal::kMemory;
  if (arguments.goal == "speed") options.wishes.goal = Goal::kSpeed;
  if (arguments.builder == "paper") options.builder = Builder::kPaper;
  if (arguments.widths == "estimated") options.widths = FieldWidths::kEstimated;
  if (arguments.external) options.geometry = GeometryId::kExternal;
  if (arguments.f64) options.import.precision = Precision::kF64;
  options.import.keep_doubles = arguments.exact;
  options.grid.step_exponent = step_exponent_of(arguments.grid_step);
  // The grid of 24 bits that is tried by default would cost the digits that --f64 requests.
  const bool is_grid_welcome = options.grid.tolerance || !arguments.f64;
  options.may_use_grid = options.geometry == GeometryId::kExact && !arguments.exact &&
                         !options.blob && is_grid_welcome;
  options.may_use_arrays = options.geometry == GeometryId::kExact;
  options.import.try_first = !arguments.trusted;
  options.import.command = "cook";
  options.face_ids = !arguments.no_face_ids;
  options.cook_record = !arguments.strip;
}

// Why "-" cannot stand where it does; empty if it can.
std::string stream_fault(const CookArguments& arguments) {
  const std::vector<std::filesystem::path>& inputs = arguments.job.inputs;
  const auto count = std::count_if(inputs.begin(), inputs.end(), is_standard_stream);
  const bool is_to_standard = is_standard_stream(arguments.job.output);
  if (count > 0 && arguments.format.empty()) {
    return "- (standard input): --format says what it is, as in --format obj";
  }
  if (count > 1) return "- (standard input) can be read once";
  if (count == 0 && !arguments.format.empty()) {
    return "--format is of the input - (standard input): a file is read by the ending of its name";
  }
  if ((count > 0 || is_to_standard) && !arguments.job.depfile.empty()) {
    return "--depfile lists files by their names: - has none";
  }
  if (!arguments.job.reordered.empty() &&
      (count > 0 || is_standard_stream(arguments.job.reordered))) {
    return "--write-reordered reads a file again and writes one: - is none";
  }
  if (is_standard_stream(arguments.job.profile)) {
    return "--profile needs the name of a file, below whose folder are those that it names: - has "
           "none";
  }
  if (is_standard_stream(arguments.job.costs)) return "--costs needs the name of a file";
  if (is_standard_stream(arguments.job.depfile)) return "--depfile needs the name of a file";
  return {};
}

Option* rare(Option* option) {
  return option->group(kRareOptions);
}

class Declaration {
 public:
  Declaration(Command& command, CookArguments& arguments)
      : command_(command), arguments_(arguments) {}

  void run() {
    declare_files();
    declare_encoding();
    declare_positions();
    declare_budget();
    declare_parts();
    declare_rare();
    // What a profile says of all this would be contradicted.
    for (Option* option : {codec_, goal_, exact_, tolerance_, arguments_.grid_bits_option,
                           arguments_.grid_step_option, budget_, slowdown_, no_face_ids_,
                           materials_, user_data_, face_ids_, active_edges_, external_}) {
      arguments_.profile->excludes(option);
    }
  }

 private:
  template <class T>
  Option* add_option(const std::string& name, T& out, const std::string& help) {
    return arguments_.all.emplace_back(command_.add_option(name, out, help));
  }
  template <class T>
  Option* add_file(const std::string& name, T& out, Values values, const std::string& help) {
    return arguments_.all.emplace_back(command_.add_file(name, out, values, help));
  }
  Option* add_flag(const std::string& name, bool& out, const std::string& help) {
    return arguments_.all.emplace_back(command_.add_flag(name, out, help));
  }

  void declare_files() {
    arguments_.inputs = command_.add_file("MESH", arguments_.job.inputs, Values::kMeshes,
                                          "Mesh files, one tree each; one file with a node graph "
                                          "that places several is a scene; - is "
                                          "standard input, whose tree is called stdin");
    arguments_.output = add_file("-o,--output", arguments_.job.output, Values::kCookedFiles,
                                 "The file to write; - is standard output");
    add_option("--format", arguments_.format, "Of the input -: the ending of its files, obj")
        ->takes(Values::kMeshEndings)
        ->type_name("ENDING")
        ->check(ending_fault);
    arguments_.profile =
        add_file("--profile", arguments_.job.profile, Values::kProfiles,
                 "A scene.toml: what the scene is queried for, and so what may be left out");
    scene_ =
        add_flag("--scene", arguments_.job.as_scene, "Make all inputs one scene of placed trees");
    add_flag("--flatten", arguments_.job.flatten, "Make each input one tree, never a scene")
        ->excludes(arguments_.profile)
        ->excludes(scene_);
  }

  void declare_encoding() {
    std::vector<std::string> codecs{"auto"};
    for (const CodecInfo& info : kCodecs) codecs.emplace_back(info.name);
    codecs.insert(codecs.end(), {"blob-lzma", "blob-zstd"});
    codec_ = add_option("--codec", arguments_.codec, "How nodes are stored")
                 ->type_name("NAME")
                 ->one_of(codecs)
                 ->shows_default();
    goal_ = add_option("--for", arguments_.goal, "What auto minimises")
                ->type_name("GOAL")
                ->one_of({"memory", "speed", "balance"})
                ->shows_default();
  }

  void declare_positions() {
    exact_ = add_flag("--exact", arguments_.exact,
                      "Keep every bit of every position: f32, or f64 with --f64 and of PLY files "
                      "with doubles [else auto may choose a grid of 24 bits]");
    add_flag("--f64", arguments_.f64,
             "Hold positions as f64, not f32, for meshes far from the origin: all digits of "
             "OBJ, OFF, PLY and text STL files, and what nodes of others place");
    tolerance_ = add_option("--tolerance", arguments_.job.options.grid.tolerance,
                            "Positions may be rounded to the coarsest grid on which "
                            "no vertex is found to move farther, in "
                            "units of the mesh");
    tolerance_->type_name("LENGTH")->above_zero("a length")->excludes(exact_);
    arguments_.grid_bits_option =
        add_option("--grid-bits", arguments_.job.options.grid.bits,
                   "Round positions to a grid of 2^N steps over the largest extent of all inputs");
    arguments_.grid_bits_option->type_name("N")
        ->between(kMinGridBits, kMaxGridBits, fmt::format("{} to {}", kMinGridBits, kMaxGridBits))
        ->excludes(exact_)
        ->excludes(tolerance_);
    arguments_.grid_step_option =
        add_option("--grid-step", arguments_.grid_step,
                   "Round positions to a grid of this step, a power of two in units of "
                   "the mesh, 2^-3 or 0.125, "
                   "which files that are cooked apart have in common");
    arguments_.grid_step_option->type_name("2^E")
        ->check(step_fault)
        ->excludes(exact_)
        ->excludes(tolerance_)
        ->excludes(arguments_.grid_bits_option);
  }

  void declare_budget() {
    budget_ =
        add_option("--max-bytes-per-triangle", arguments_.job.options.wishes.max_bytes_per_triangle,
                   "Choose nothing larger, nodes and geometry together")
            ->type_name("BYTES")
            ->above_zero("a number of bytes");
    slowdown_ =
        add_option(
            "--max-slowdown", arguments_.job.options.wishes.max_slowdown,
            "Choose nothing with a larger slowdown: time over that of wide8 with arrays, mean "
            "over the kinds of queries; below 1 is faster than that")
            ->type_name("FACTOR")
            ->above_zero("a factor");
  }

  void declare_parts() {
    no_face_ids_ =
        add_flag("--no-face-ids", arguments_.no_face_ids, "Leave the source face numbers out");
    materials_ = add_flag("--materials", arguments_.job.options.materials,
                          "Keep the materials of faces of trees: usemtl of OBJ files, materials of "
                          "glTF, FBX and others [else left out; scenes have theirs]");
    user_data_ =
        add_option("--user-data", arguments_.job.options.import.user_data,
                   "Keep a number for each face: an integer property of the faces of a PLY "
                   "file; 'groups' of an OBJ file, numbered by their first faces; "
                   "'primitives' of a glTF file, numbered in its order, or an integer in their "
                   "extras or those of their materials or meshes [else left out]")
            ->type_name("PROPERTY");
    face_ids_ = add_option("--face-ids", arguments_.job.options.import.face_ids,
                           "Take the source face numbers from an integer property of the faces of "
                           "a PLY file that is a part of a larger mesh; they must not descend "
                           "[else faces are counted]")
                    ->type_name("PROPERTY")
                    ->excludes(no_face_ids_);
    active_edges_ = add_option(
        "--active-edges", arguments_.job.options.active_edges,
        "Store which edges are active: boundaries, and those at which the surface bends away by "
        "more than so many degrees; at others a contact takes the normal of the face [else left "
        "out]");
    active_edges_->type_name("DEGREES")->number(
        "degrees from 0 to 90", [](double degrees) { return degrees >= 0 && degrees <= 90; },
        "0 to 90");
    add_flag("--skip-bad", arguments_.job.options.import.skip_bad,
             "Drop faces with NaN, infinite or missing vertices, and report their numbers");
  }

  void declare_rare() {
    rare(add_option("--builder", arguments_.builder, "Split rule"))
        ->type_name("NAME")
        ->one_of({"sah", "paper"})
        ->shows_default();
    rare(add_option("--widths", arguments_.widths, "Widths of bit-packed fields"))
        ->type_name("NAME")
        ->one_of({"exact", "estimated"})
        ->shows_default();
    rare(
        add_option("--shrink-share", arguments_.job.options.shrink_share,
                   "Codecs with one triangle per leaf cut off empty slabs from this share of a box "
                   "on; 1: never"))
        ->type_name("SHARE")
        ->number(
            "a share from 0.01 to 1", [](double share) { return share >= 0.01 && share <= 1; },
            "0.01 to 1")
        ->shows_default();
    rare(add_file("--costs", arguments_.job.costs, Values::kFiles,
                  "Choose by the constants of your own machine, as `bench --calibrate "
                  "--json` prints them: the choice may then differ from other machines'"));
    external_ = rare(add_flag("--external", arguments_.external,
                              "Leave positions and corners to the application, which binds its own "
                              "arrays"))
                    ->excludes(exact_)
                    ->excludes(tolerance_)
                    ->excludes(arguments_.grid_bits_option)
                    ->excludes(arguments_.grid_step_option);
    rare(add_flag("--strip", arguments_.strip,
                  "Leave the cook record out, and of a single mesh its name"));
    rare(add_flag("--require-files", arguments_.job.require_files,
                  "Refuse a mesh that names a file that is not there, as an OBJ file its MTL; "
                  "else that is a warning"));
    rare(add_flag("--trusted", arguments_.trusted,
                  "Read formats that assimp reads once, not first in another process that "
                  "may crash"));
    add_file("--write-reordered", arguments_.job.reordered, Values::kMeshes,
             "Write MESH, an OBJ, PLY or glTF file, with all it says, but with its faces in the "
             "order of the tree; no face ids are needed then")
        ->excludes(arguments_.profile)
        ->excludes(scene_)
        ->excludes(no_face_ids_)
        ->excludes(face_ids_);
    rare(add_file("--depfile", arguments_.job.depfile, Values::kFiles,
                  "Write the files read, in make syntax"));
    rare(add_flag("--try-all", arguments_.job.options.try_all,
                  "Try also what cannot win, for the table"));
  }

  Command& command_;
  CookArguments& arguments_;
  Option *scene_ = nullptr, *codec_ = nullptr, *goal_ = nullptr;
  Option *exact_ = nullptr, *tolerance_ = nullptr;
  Option *budget_ = nullptr, *slowdown_ = nullptr;
  Option *no_face_ids_ = nullptr, *materials_ = nullptr, *user_data_ = nullptr;
  Option *face_ids_ = nullptr, *active_edges_ = nullptr, *external_ = nullptr;
};

}  // namespace

void declare_cook_options(Command& command, CookArguments& arguments) {
  Declaration(command, arguments).run();
}

std::string finish_cook_options(CookArguments& arguments) {
  set_options(arguments);
  if (arguments.external && arguments.no_face_ids) {
    return "--external excludes --no-face-ids: face ids lead into the application's arrays; "
           "with --write-reordered FILE, whose faces are in the order of the tree, none are needed";
  }
  return stream_fault(arguments);
}

Status take_standard_mesh(CookArguments& arguments) {
  const std::vector<std::filesystem::path>& inputs = arguments.job.inputs;
  if (std::none_of(inputs.begin(), inputs.end(), is_standard_stream)) return {};
  const Result<SourceBytes> mesh = standard_mesh(arguments.format);
  if (!mesh) return mesh.error();
  arguments.job.options.import.bytes = *mesh;
  return {};
}

void require_source(const CookArguments& arguments) {
  if (arguments.inputs->count() == 0 && arguments.profile->count() == 0) {
    refuse_without("MESH, or --profile with a source");
  }
}

}  // namespace boxtree::cooker
