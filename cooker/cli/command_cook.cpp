// SPDX-License-Identifier: MIT
// `boxtree cook`: meshes in, one .bxt file out.
#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <sys/resource.h>

#include <fmt/format.h>

#include "cooker/cli/command.h"
#include "cooker/cli/commands.h"
#include "cooker/cli/cook_report.h"
#include "cooker/cli/json_output.h"
#include "cooker/cli/output.h"
#include "cooker/cli/standard_streams.h"
#include "cooker/cli/step_printer.h"
#include "cooker/cli/worker_threads.h"
#include "cooker/import/file_error.h"
#include "cooker/import/text_tokens.h"
#include "cooker/shell/cook_job.h"
#include "cooker/text/nearest_name.h"
#include "cooker/write/outputs.h"
#include "format/grid.h"

namespace boxtree::cooker {
namespace {

using Clock = std::chrono::steady_clock;

struct Arguments {
  CookJob job;
  std::string codec = "auto";
  std::string goal = "balance";
  std::string builder = "sah";
  std::string widths = "exact";
  std::string grid_step;
  bool why = false;
  bool candidates = false;
  bool exact = false;
  bool external = false;
  bool no_face_ids = false;
  bool strip = false;
  bool trusted = false;
  bool f64 = false;
  bool json = false;
  bool quiet = false;
  std::string format;
  int jobs = kAllThreads;
};

Json report_json(const Arguments& arguments, const Summary& summary, double seconds) {
  Json json = {{"output", arguments.job.output.string()}};
  if (!arguments.job.reordered.empty()) json["reordered"] = arguments.job.reordered.string();
  json.update(summary_json(summary));
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  json["seconds"] = seconds;
  json["peak_bytes"] = usage.ru_maxrss * 1024;  // Linux counts kilobytes
  return json;
}

// `output`: the name of what was written.
std::string report_text(const Arguments& arguments, const std::string& output,
                        const Summary& summary, double seconds) {
  std::string text = summary.scene ? scene_text(summary, arguments.candidates)
                                   : trees_text(summary, arguments.candidates);
  if (arguments.why) text += why_text(summary);
  if (!arguments.job.reordered.empty()) {
    text += fmt::format("wrote {}: face i of the tree is face i of it\n",
                        shown(arguments.job.reordered.string()));
  }
  return text + fmt::format(
                    "wrote {}, {} bytes, in {:.2f} s; every triangle proven inside every "
                    "box above it\n",
                    shown(output), summary.file_bytes, seconds);
}

// Refused here, because assimp looks for a reader by the first bytes if it does not know an ending.
std::string ending_fault(const std::string& text) {
  if (is_mesh_ending(text)) return {};
  return fmt::format("expected the ending of a mesh file, as obj, found \"{}\"{}", text,
                     suggestion(text, mesh_endings()));
}

// All of `text` as a number; nothing if it is none.
template <class T>
std::optional<T> number_of(std::string_view text) {
  T number{};
  const char* const end = text.data() + text.size();
  const auto [parsed, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && parsed == end ? std::optional(number) : std::nullopt;
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
void set_options(Arguments& arguments) {
  CookOptions& options = arguments.job.options;
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
  options.face_ids = !arguments.no_face_ids;
  options.cook_record = !arguments.strip;
}

// Why "-" cannot stand where it does; empty if it can.
std::string stream_fault(const Arguments& arguments) {
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
  if (is_to_standard && arguments.json) return "--json and -o - cannot share standard output";
  return {};
}

// What the command line adds to an error of a cook: a remedy, and the file that cannot be made,
// where no line of the profile stands for a budget.
Error explained(const Error& error, const Arguments& arguments, const std::string& output) {
  if (error.code == Errc::kInvalidPose) {
    return {error.code,
            error.detail + "; --flatten makes one tree of a file, whatever its transforms"};
  }
  const std::string& profile = arguments.job.profile;
  const bool is_of_profile = !profile.empty() && error.detail.starts_with(profile + ":");
  if (error.code == Errc::kBudgetUnreachable && !is_of_profile) return in_file(output, error);
  return error;
}

int run(Arguments& arguments) {
  set_options(arguments);
  if (arguments.external && arguments.no_face_ids) {
    return usage(
        "cook: --external excludes --no-face-ids: face ids lead into the application's arrays; "
        "with --write-reordered FILE, whose faces are in the order of the tree, none are needed");
  }
  if (const std::string fault = stream_fault(arguments); !fault.empty())
    return usage("cook: " + fault);
  for (const auto& [output, ending] :
       {std::pair(&arguments.job.output, ".bxt"), std::pair(&arguments.job.depfile, ".d")}) {
    if (const std::string fault = mesh_name_fault(*output, ending); !fault.empty())
      return usage("cook: " + fault);
  }
  const std::vector<std::filesystem::path>& inputs = arguments.job.inputs;
  const auto input = std::find_if(inputs.begin(), inputs.end(), is_standard_stream);
  if (input != inputs.end()) {
    const Result<SourceBytes> mesh = standard_mesh(arguments.format);
    if (!mesh) return fail(mesh.error());
    arguments.job.options.import.bytes = *mesh;
  }
  const Result<OutputTarget> output = output_target(arguments.job.output, "bxt");
  if (!output) return usage("cook: " + output.error().detail);
  arguments.job.output = output->path;
  arguments.job.output_stream = output->stream;

  if (Status status = check_job(arguments.job); !status)
    return usage("cook: " + status.error().detail);
  if (!output->stream) {
    if (Status status = check_replaced(output->path, OutputKind::kCooked); !status)
      return usage("cook: " + status.error().detail);
  }
  if (Status status = check_replaced(arguments.job.depfile, OutputKind::kDepfile); !status)
    return usage("cook: " + status.error().detail);
  const Clock::time_point start = Clock::now();
  Result<Summary> cooked = Errc::kInternal;
  {
    StepPrinter steps(!arguments.quiet);
    run_on_threads(arguments.jobs, [&] {
      cooked = cook_job(arguments.job, [&steps](const std::string& step) { steps(step); });
    });
  }
  if (!cooked) return fail(explained(cooked.error(), arguments, output->title()));
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  for (const std::string& warning : warnings_of(*cooked)) warn(warning);
  if (arguments.json) {
    print(report_json(arguments, *cooked, seconds));
  } else if (!arguments.quiet) {
    tell(*output, report_text(arguments, output->title(), *cooked, seconds));
  }
  return 0;
}

}  // namespace

void add_cook_command(Command& program, int& status) {
  const auto arguments = std::make_shared<Arguments>();
  Command& command = program.add_command(
      "cook",
      "Cook meshes into one .bxt file\n"
      "Positions may be rounded: beside every bit of them auto tries a grid of 24 bits over the "
      "largest extent, and says how far a vertex moved; --exact forbids it.");
  std::vector<std::string> codecs{"auto"};
  for (const CodecInfo& codec : kCodecs) codecs.emplace_back(codec.name);

  codecs.insert(codecs.end(), {"blob-lzma", "blob-zstd"});
  Option* inputs = command.add_file(
      "MESH", arguments->job.inputs, Values::kMeshes,
      "Mesh files, one tree each; one file with a node graph that places several is a scene; - is "
      "standard input, whose tree is called stdin");
  command
      .add_file("-o,--output", arguments->job.output, Values::kCookedFiles,
                "The file to write; - is standard output")
      ->required();
  command.add_option("--format", arguments->format, "Of the input -: the ending of its files, obj")
      ->takes(Values::kMeshEndings)
      ->type_name("ENDING")
      ->check(ending_fault);
  Option* profile =
      command.add_file("--profile", arguments->job.profile, Values::kProfiles,
                       "A scene.toml: what the scene is queried for, and so what may be left out");
  Option* scene = command.add_flag("--scene", arguments->job.as_scene,
                                   "Make all inputs one scene of placed trees");
  command.add_flag("--flatten", arguments->job.flatten, "Make each input one tree, never a scene")
      ->excludes(profile)
      ->excludes(scene);
  command.add_flag(
      "--why", arguments->why,
      "Print each part of the file, its bytes, and what decided that it is there, or not");
  command.add_flag("--candidates", arguments->candidates,
                   "Print all that was tried for each tree, not only what was chosen");
  Option* codec = command.add_option("--codec", arguments->codec, "How nodes are stored")
                      ->type_name("NAME")
                      ->one_of(codecs)
                      ->shows_default();
  Option* goal = command.add_option("--for", arguments->goal, "What auto minimises")
                     ->type_name("GOAL")
                     ->one_of({"memory", "speed", "balance"})
                     ->shows_default();
  Option* exact =
      command.add_flag("--exact", arguments->exact,
                       "Keep every bit of every position: f32, or f64 with --f64 and of PLY files "
                       "with doubles [else auto may choose a grid of 24 bits]");
  command.add_flag("--f64", arguments->f64,
                   "Hold positions as f64, not f32, for meshes far from the origin: all digits of "
                   "OBJ, OFF, PLY and text STL files, and what nodes of others place");
  Option* tolerance = command.add_option("--tolerance", arguments->job.options.grid.tolerance,
                                         "Positions may be rounded to the coarsest grid on which "
                                         "no vertex is found to move farther, in "
                                         "units of the mesh");
  tolerance->type_name("LENGTH")->above_zero("a length")->excludes(exact);
  Option* grid_bits = command.add_option(
      "--grid-bits", arguments->job.options.grid.bits,
      "Round positions to a grid of 2^N steps over the largest extent of all inputs");
  grid_bits->type_name("N")
      ->between(kMinGridBits, kMaxGridBits, fmt::format("{} to {}", kMinGridBits, kMaxGridBits))
      ->excludes(exact)
      ->excludes(tolerance);
  Option* grid_step = command.add_option(
      "--grid-step", arguments->grid_step,
      "Round positions to a grid of this step, a power of two in units of the mesh, 2^-3 or 0.125, "
      "which files that are cooked apart have in common");
  grid_step->type_name("2^E")
      ->check(step_fault)
      ->excludes(exact)
      ->excludes(tolerance)
      ->excludes(grid_bits);
  Option* budget = command
                       .add_option("--max-bytes-per-triangle",
                                   arguments->job.options.wishes.max_bytes_per_triangle,
                                   "Choose nothing larger, nodes and geometry together")
                       ->type_name("BYTES")
                       ->above_zero("a number of bytes");
  Option* slowdown =
      command
          .add_option(
              "--max-slowdown", arguments->job.options.wishes.max_slowdown,
              "Choose nothing with a larger slowdown: time over that of wide8 with arrays, mean "
              "over the kinds of queries; below 1 is faster than that")
          ->type_name("FACTOR")
          ->above_zero("a factor");
  Option* no_face_ids = command.add_flag("--no-face-ids", arguments->no_face_ids,
                                         "Leave the source face numbers out");
  Option* materials =
      command.add_flag("--materials", arguments->job.options.materials,
                       "Keep the materials of faces of trees: usemtl of OBJ files, materials of "
                       "glTF, FBX and others [else left out; scenes have theirs]");
  Option* user_data =
      command
          .add_option("--user-data", arguments->job.options.import.user_data,
                      "Keep a number for each face: an integer property of the faces of a PLY "
                      "file; 'groups' of an OBJ file, numbered by their first faces; "
                      "'primitives' of a glTF file, numbered in its order, or an integer in their "
                      "extras or those of their materials or meshes [else left out]")
          ->type_name("PROPERTY");
  Option* active_edges = command.add_option(
      "--active-edges", arguments->job.options.active_edges,
      "Store which edges are active: boundaries, and those at which the surface bends away by more "
      "than so many degrees; at others a contact takes the normal of the face [else left out]");
  active_edges->type_name("DEGREES")->number(
      "degrees from 0 to 90", [](double degrees) { return degrees >= 0 && degrees <= 90; },
      "0 to 90");
  command.add_flag("--skip-bad", arguments->job.options.import.skip_bad,
                   "Drop faces with NaN, infinite or missing vertices, and report their numbers");
  command.add_option("-j,--jobs", arguments->jobs, "Threads; the bytes do not depend on it [all]")
      ->type_name("N")
      ->between(1, 1024);
  const auto rare = [](Option* option) { return option->group(kRareOptions); };
  rare(command.add_option("--builder", arguments->builder, "Split rule"))
      ->type_name("NAME")
      ->one_of({"sah", "paper"})
      ->shows_default();
  rare(command.add_option("--widths", arguments->widths, "Widths of bit-packed fields"))
      ->type_name("NAME")
      ->one_of({"exact", "estimated"})
      ->shows_default();
  rare(command.add_option(
           "--shrink-share", arguments->job.options.shrink_share,
           "Codecs with one triangle per leaf cut off empty slabs from this share of a box "
           "on; 1: never"))
      ->type_name("SHARE")
      ->number(
          "a share from 0.01 to 1", [](double share) { return share >= 0.01 && share <= 1; },
          "0.01 to 1")
      ->shows_default();
  rare(command.add_file("--costs", arguments->job.costs, Values::kFiles,
                        "Choose by the constants of your own machine, as `bench --calibrate "
                        "--json` prints them: the choice may then differ from other machines'"));
  Option* external =
      rare(command.add_flag("--external", arguments->external,
                            "Leave positions and corners to the application, which binds its own "
                            "arrays"))
          ->excludes(exact)
          ->excludes(tolerance)
          ->excludes(grid_bits)
          ->excludes(grid_step);
  rare(command.add_flag("--strip", arguments->strip, "Leave the cook record out"));
  rare(command.add_flag("--trusted", arguments->trusted,
                        "Read formats that assimp reads once, not first in another process that "
                        "may crash"));
  command
      .add_file("--write-reordered", arguments->job.reordered, Values::kMeshes,
                "Write MESH, an OBJ, PLY or glTF file, with all it says, but with its faces in the "
                "order of the tree; no face ids are needed then")
      ->excludes(profile)
      ->excludes(scene)
      ->excludes(no_face_ids);
  rare(command.add_file("--depfile", arguments->job.depfile, Values::kFiles,
                        "Write the files read, in make syntax"));
  command.add_flag("--json", arguments->json, "Print one JSON document");
  command.add_flag("-q,--quiet", arguments->quiet, "Print errors and warnings only");
  rare(command.add_flag("--try-all", arguments->job.options.try_all,
                        "Try also what cannot win, for the table"));
  // What a profile says of all this would be contradicted.
  for (Option* option : {codec, goal, exact, tolerance, grid_bits, grid_step, budget, slowdown,
                         no_face_ids, materials, user_data, active_edges, external}) {
    profile->excludes(option);
  }
  command.example("One mesh", "boxtree cook bunny.obj -o bunny.bxt");
  command.example("Vertices may move by 0.001, for the fewest bytes",
                  "boxtree cook bunny.obj -o small.bxt --tolerance 0.001 --for memory");
  command.example("The mesh in the order of the tree, instead of face ids",
                  "boxtree cook bunny.obj -o bunny.bxt --write-reordered ordered.obj");
  command.example("A scene, with what each part takes",
                  "boxtree cook level.gltf -o level.bxt --why");
  command.example("A scene by its profile", "boxtree cook --profile scene.toml -o profiled.bxt");
  command.example("Through a pipe", "boxtree cook - --format obj -o - < bunny.obj > piped.bxt");
  command.callback([arguments, inputs, profile, grid_bits, grid_step, &status] {
    if (inputs->count() == 0 && profile->count() == 0) {
      refuse_without("MESH, or --profile with a source");
    }
    if (grid_bits->count() + grid_step->count() > 0)
      arguments->job.options.geometry = GeometryId::kGrid;
    status = run(*arguments);
  });
}

}  // namespace boxtree::cooker
