// SPDX-License-Identifier: MIT
// `boxtree cook`: meshes in, one .bxt file out.
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <sys/resource.h>

#include <fmt/format.h>
#include <oneapi/tbb/task_arena.h>

#include <boxtree/cooker/cli/output.h>
#include <boxtree/cooker/cli/step_printer.h>
#include <boxtree/cooker/cook.h>
#include <boxtree/format/grid.h>

namespace boxtree::cooker {
namespace {

using Clock = std::chrono::steady_clock;

struct Arguments {
  std::vector<std::filesystem::path> inputs;
  std::filesystem::path output;
  std::string codec = "auto";
  std::string goal = "balance";
  std::string builder = "sah";
  std::string widths = "exact";
  std::filesystem::path depfile;
  CookOptions options;
  bool exact = false;
  bool external = false;
  bool no_face_ids = false;
  bool strip = false;
  bool f64 = false;
  bool json = false;
  bool quiet = false;
  int jobs = tbb::task_arena::automatic;
};

// Make syntax: spaces, '#' and '$' in names are escaped, as gcc -MD does.
std::string make_name(const std::filesystem::path& path) {
  std::string out;
  for (const char c : path.string()) {
    if (c == ' ' || c == '#' || c == '\\') out += '\\';
    if (c == '$') out += '$';
    out += c;
  }
  return out;
}

Status write_depfile(const Arguments& arguments, const CookReport& report) {
  std::string text = make_name(arguments.output) + ":";
  for (const ImportReport& import : report.imports) {
    for (const std::filesystem::path& file : import.files_read) text += " \\\n  " + make_name(file);
  }
  text += "\n";
  Result<AtomicFile> file = AtomicFile::create(arguments.depfile);
  if (!file) return file.error();
  if (Status status = file->write(std::as_bytes(std::span(text))); !status) return status;
  return file->commit();
}

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
               {"degenerate_faces", report.degenerate_faces}};
  json["skipped"] = Json::array();
  for (const SkippedFace& face : report.skipped) {
    json["skipped"].push_back({{"face", face.face_id}, {"reason", face.reason}});
  }
  return json;
}

Json report_json(const Arguments& arguments, const CookReport& report, double seconds) {
  Json json;
  json["output"] = arguments.output.string();
  json["trees"] = Json::array();
  for (std::size_t i = 0; i < report.trees.size(); ++i) {
    const CookedTree& cooked = report.trees[i];
    Json tree = {{"name", cooked.tree.name},
                 {"triangles", cooked.tree.triangle_count},
                 {"chosen", codec_name(cooked.tree.nodes.codec)},
                 {"chosen_geometry", geometry_name(cooked.tree.geometry.geometry)}};
    tree["candidates"] = Json::array();
    const std::vector<double> slower = slowdowns(cooked.contest.candidates);
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
    tree["left_out"] = Json::array();
    for (const LeftOut& part : cooked.left_out) {
      tree["left_out"].push_back({{"what", part.what}, {"bytes", part.bytes}, {"why", part.why}});
    }
    tree["import"] = import_json(report.imports[i]);
    json["trees"].push_back(tree);
  }
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  json["seconds"] = seconds;
  json["peak_bytes"] = usage.ru_maxrss * 1024;  // Linux counts kilobytes
  return json;
}

// What was tried and what was not, with the reasons.
void print_contest(const CookedTree& cooked) {
  const std::vector<Candidate>& candidates = cooked.contest.candidates;
  const std::vector<double> slower = slowdowns(candidates);
  fmt::print("    {:<10} {:<8} {:>10} {:>10}  {:>5} {:>7} {:>7} {:>7} {:>8}  {:>9}\n", "codec",
             "geometry", "tree B/tri", "with geom.", "times", "ray ns", "box ns", "point ns",
             "pairs us", "error");
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    fmt::print(
        "  {} {:<10} {:<8} {:>10.2f} {:>10.2f}  {:>5.2f} {:>7.0f} {:>7.0f} {:>7.0f} {:>8.1f}"
        "  {:>9.2g}{}{}\n",
        candidate.rejected.empty() ? '*' : ' ', codec_name(candidate.codec),
        geometry_name(candidate.geometry), per_triangle(candidate.tree_bytes, cooked.tree),
        per_triangle(candidate.bytes(), cooked.tree), slower[i], candidate.cost[0],
        candidate.cost[1], candidate.cost[2], candidate.cost[3] / 1000, candidate.max_vertex_error,
        candidate.rejected.empty() ? "" : "  ", candidate.rejected);
  }
  // Codecs that share a reason stand together.
  const std::vector<NotTried>& others = cooked.contest.not_tried;
  for (std::size_t i = 0; i < others.size();) {
    std::string names;
    const NotTried& first = others[i];
    for (; i < others.size() && others[i].why == first.why; ++i) {
      if (others[i].geometry != first.geometry) break;
      names += fmt::format("{}{}", names.empty() ? "" : ", ", codec_name(others[i].codec));
    }
    fmt::print("    not tried, geometry {}: {}: {}\n", geometry_name(first.geometry), names,
               first.why);
  }
}

void print_report(const Arguments& arguments, const CookReport& report, double seconds) {
  for (std::size_t i = 0; i < report.trees.size(); ++i) {
    const CookedTree& cooked = report.trees[i];
    const ImportReport& import = report.imports[i];
    fmt::print("{}: {} triangles\n", cooked.tree.name, cooked.tree.triangle_count);
    print_contest(cooked);
    if (import.points_skipped + import.lines_skipped > 0) {
      fmt::print("  skipped {} points and {} lines: they have no surface\n", import.points_skipped,
                 import.lines_skipped);
    }
    if (cooked.tree.geometry.geometry == GeometryId::kGrid) {
      fmt::print(
          "  grid: step 2^{}, no vertex moved by more than {:.3g}; {} triangles lost their "
          "area and are kept\n",
          cooked.tree.geometry.grid_exponent, cooked.tree.geometry.max_vertex_error,
          cooked.collapsed);
    }
    if (import.degenerate_faces > 0) {
      fmt::print("  kept {} faces without area\n", import.degenerate_faces);
    }
    for (const SkippedFace& face : import.skipped) {
      fmt::print("  skipped face {}: {}\n", face.face_id, face.reason);
    }
  }
  fmt::print("wrote {} in {:.2f} s; every triangle proven inside every box above it\n",
             arguments.output.string(), seconds);
}

// What is wrong with a length or a budget, for CLI11, whose own PositiveNumber lets NaN pass.
std::string positive_fault(const std::string& text) {
  const double number = std::strtod(text.c_str(), nullptr);
  return number > 0 && std::isfinite(number) ? "" : text + " is not above zero";
}

int run(Arguments& arguments) {
  CookOptions& options = arguments.options;
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
  // The grid of 24 bits that is tried by default would cost f64 positions digits that were asked
  // for.
  const bool is_grid_welcome = options.grid.tolerance || !arguments.f64;
  options.may_use_grid = options.geometry == GeometryId::kExact && !arguments.exact &&
                         !options.blob && is_grid_welcome;
  options.face_ids = !arguments.no_face_ids;
  options.cook_record = !arguments.strip;

  const Clock::time_point start = Clock::now();
  Result<CookReport> report = Errc::kInternal;
  {
    StepPrinter steps(!arguments.quiet);
    tbb::task_arena arena(arguments.jobs);
    arena.execute([&] {
      report = cook(arguments.inputs, arguments.output, options,
                    [&steps](const std::string& step) { steps(step); });
    });
  }
  if (!report) return fail(report.error());
  if (!arguments.depfile.empty()) {
    if (Status status = write_depfile(arguments, *report); !status) return fail(status.error());
  }
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  if (arguments.json) {
    print(report_json(arguments, *report, seconds));
  } else if (!arguments.quiet) {
    print_report(arguments, *report, seconds);
  }
  return 0;
}

}  // namespace

void add_cook_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<Arguments>();
  CLI::App& command = *app.add_subcommand("cook", "Cook meshes into one .bxt file");
  std::vector<std::string> codecs{"auto"};
  for (const CodecInfo& codec : kCodecs) codecs.emplace_back(codec.name);

  codecs.insert(codecs.end(), {"blob-lzma", "blob-zstd"});
  command.add_option("inputs", arguments->inputs, "Mesh files, one tree each")->required();
  command.add_option("-o,--output", arguments->output, "The file to write")->required();
  command.add_option("--codec", arguments->codec, "How nodes are stored")
      ->check(CLI::IsMember(codecs))
      ->capture_default_str();
  command.add_option("--for", arguments->goal, "What auto minimises")
      ->check(CLI::IsMember({"memory", "speed", "balance"}))
      ->capture_default_str();
  CLI::Option* exact =
      command.add_flag("--exact", arguments->exact,
                       "Keep every bit of every position [else auto may choose a grid of 24 bits]");
  CLI::Option* tolerance = command.add_option(
      "--tolerance", arguments->options.grid.tolerance,
      "Positions may be rounded to a grid, but no vertex moves farther, in units of the mesh");
  tolerance->check(positive_fault, "POSITIVE")->excludes(exact);
  CLI::Option* grid_bits = command.add_option(
      "--grid-bits", arguments->options.grid.bits,
      "Round positions to a grid of 2^N steps over the largest extent of all inputs");
  grid_bits->check(CLI::Range(kMinGridBits, kMaxGridBits))->excludes(exact)->excludes(tolerance);
  command
      .add_option("--max-bytes-per-triangle", arguments->options.wishes.max_bytes_per_triangle,
                  "Choose nothing larger, nodes and geometry together")
      ->check(positive_fault, "POSITIVE");
  command
      .add_option("--max-slowdown", arguments->options.wishes.max_slowdown,
                  "Choose nothing slower, in times of the fastest candidate")
      ->check(positive_fault, "POSITIVE");
  command.add_flag("--no-face-ids", arguments->no_face_ids, "Leave the source face numbers out");
  command.add_flag("--skip-bad", arguments->options.import.skip_bad,
                   "Drop faces with NaN, infinite or missing vertices, and report their numbers");
  command.add_option("--jobs", arguments->jobs, "Threads; the bytes do not depend on it")
      ->check(CLI::Range(1, 1024));
  const auto rare = [](CLI::Option* option) { return option->group(kRareOptions); };
  rare(command.add_option("--builder", arguments->builder, "Split rule"))
      ->check(CLI::IsMember({"sah", "paper"}))
      ->capture_default_str();
  rare(command.add_option("--widths", arguments->widths, "Widths of bit-packed fields"))
      ->check(CLI::IsMember({"exact", "estimated"}))
      ->capture_default_str();
  rare(command.add_flag("--external", arguments->external,
                        "Leave positions and corners to the application, which binds its own "
                        "arrays"))
      ->excludes(exact)
      ->excludes(tolerance)
      ->excludes(grid_bits);
  rare(command.add_flag("--f64", arguments->f64,
                        "Hold positions as f64: all digits of OBJ, OFF and PLY files"));
  rare(command.add_flag("--strip", arguments->strip, "Leave the cook record out"));
  rare(command.add_option("--depfile", arguments->depfile, "Write the files read, in make syntax"));
  command.add_flag("--json", arguments->json, "Print one JSON document");
  command.add_flag("-q,--quiet", arguments->quiet, "Print errors only");
  rare(command.add_flag("--try-all", arguments->options.try_all,
                        "Try also what cannot win, for the table"));
  command.callback([arguments, grid_bits, &status] {
    if (grid_bits->count() > 0) arguments->options.geometry = GeometryId::kGrid;
    status = run(*arguments);
  });
}

}  // namespace boxtree::cooker
