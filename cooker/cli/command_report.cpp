// SPDX-License-Identifier: MIT
// `boxtree report`: which encoding to use for a mesh; with --paper the tables of the paper.
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "cooker/cli/command.h"
#include "cooker/cli/commands.h"
#include "cooker/cli/cook_report.h"
#include "cooker/cli/json_output.h"
#include "cooker/cli/open_file.h"
#include "cooker/cli/output.h"
#include "cooker/cli/peers.h"
#include "cooker/cli/standard_streams.h"
#include "cooker/cli/step_printer.h"
#include "cooker/cli/worker_threads.h"
#include "cooker/import/f32_digits.h"
#include "cooker/import/import.h"
#include "cooker/import/text_tokens.h"
#include "cooker/report/paper_tables.h"
#include "cooker/report/shell_word.h"
#include "cooker/report/tradeoff_advice.h"
#include "cooker/report/tradeoff_page.h"
#include "cooker/system/input_failure.h"
#include "cooker/system/path.h"
#include "cooker/text/counted.h"
#include "cooker/write/atomic_file.h"
#include "cooker/write/outputs.h"

namespace boxtree::cooker {
namespace {

struct ReportArguments {
  std::vector<std::filesystem::path> meshes;
  std::filesystem::path output;
  std::filesystem::path json_out;
  std::filesystem::path csv;
  std::filesystem::path approximate_csv;
  std::filesystem::path peers;
  std::vector<std::filesystem::path> included;
  bool json = false;
  bool paper = false;
  bool quick = false;
  bool no_times = false;
  bool f64 = false;
  bool skip_bad = false;
  std::optional<double> tolerance;
  bool quiet = false;
  int jobs = kAllThreads;
};

// Those that were not given are empty.
std::array<Output, 4> outputs_of(const ReportArguments& arguments) {
  return {{{arguments.output},
           {arguments.json_out, "--json-out"},
           {arguments.csv, "--csv"},
           {arguments.approximate_csv, "--csv-approximate"}}};
}

bool has_output(const ReportArguments& arguments) {
  const auto outputs = outputs_of(arguments);
  return std::any_of(outputs.begin(), outputs.end(),
                     [](const Output& output) { return !output.path.empty(); });
}

// How many of the outputs are standard output, which the summary must leave alone.
std::ptrdiff_t count_standard_outputs(const ReportArguments& arguments) {
  const auto outputs = outputs_of(arguments);
  return std::count_if(outputs.begin(), outputs.end(),
                       [](const Output& output) { return is_standard_stream(output.path); });
}

bool prints_summary(const ReportArguments& arguments) {
  return !arguments.json && !arguments.quiet && count_standard_outputs(arguments) == 0;
}

std::vector<std::string> names_of(const std::vector<std::filesystem::path>& meshes) {
  std::vector<std::string> names;
  names.reserve(meshes.size());
  for (const std::filesystem::path& mesh : meshes) names.push_back(mesh.string());
  return names;
}

Result<std::vector<PeerRow>> measure_paper_peers(const ReportArguments& arguments) {
  std::vector<std::string> options = names_of(arguments.meshes);
  const char* const turns = arguments.quick ? "2" : "12";
  const char* const runs = arguments.quick ? "1" : "5";
  options.insert(options.end(),
                 {"--builder", "paper", "--queries", "tumble", "--tumble", turns, "--runs", runs,
                  "--only", "original", "--only", "boxtree", "--only", "fcl:kdop18"});
  return run_peers(arguments.peers, options, false);
}

// Everything but our own codecs, which are measured here; quickly: those that take seconds.
Result<std::vector<PeerRow>> measure_tradeoff_peers(const ReportArguments& arguments) {
  std::vector<std::string> options = names_of(arguments.meshes);
  options.insert(options.end(), {"--queries", "single", "--queries", "pairs", "--only", "original",
                                 "--only", "embree"});
  if (arguments.quick) {
    options.insert(options.end(), {"--quick", "--runs", "1"});
  } else {
    options.insert(options.end(),
                   {"--only", "bullet", "--only", "fcl", "--only", "ode", "--only", "cgal"});
  }
  return run_peers(arguments.peers, options, true);
}

Json mesh_json(const PaperFigures& mesh) {
  Json codecs = Json::array();
  for (const CodecSizes& codec : mesh.codecs) {
    const auto triangles = static_cast<double>(mesh.triangles);
    codecs.push_back({{"codec", codec_name(codec.codec)},
                      {"exact", codec.exact},
                      {"estimated", codec.estimated},
                      {"exact_bytes_per_triangle", codec.exact / triangles},
                      {"estimated_bytes_per_triangle", codec.estimated / triangles}});
  }
  Json blobs = Json::array();
  for (const BlobSizes& blob : mesh.blobs) {
    blobs.push_back({{"encoding", blob.name},
                     {"tree_bytes", blob.tree_bytes},
                     {"file_bytes", blob.file_bytes},
                     {"resident_bytes", blob.resident_bytes},
                     {"open_us", blob.open_us}});
  }
  const CountedSizes& counted = mesh.counted;
  const RoundingFigures& rounding = mesh.rounding;
  return {{"mesh", mesh.mesh},
          {"triangles", mesh.triangles},
          {"faces", mesh.faces},
          {"original_nodes", mesh.original_nodes},
          {"merged_nodes", mesh.merged_nodes},
          {"merged_ratio",
           static_cast<double>(mesh.merged_nodes) / static_cast<double>(mesh.original_nodes)},
          {"shrink_nodes", mesh.shrink_nodes},
          {"depth", mesh.depth},
          {"kinds", Json::array_of(mesh.kinds)},
          {"cuts", mesh.cuts},
          {"unique_cuts", mesh.unique_cuts},
          {"codecs", codecs},
          {"blobs", blobs},
          {"mapped", {{"file_bytes", mesh.mapped_file_bytes}, {"open_us", mesh.mapped_open_us}}},
          {"counted",
           {{"implicit_slots", counted.implicit_slots},
            {"implicit", counted.implicit},
            {"whole_bytes_f16", counted.whole_bytes_f16},
            {"whole_bytes_f32", counted.whole_bytes_f32},
            {"own_sizes", counted.own_sizes},
            {"branching4", counted.branching4},
            {"branching8", counted.branching8},
            {"two_cut_shrink", counted.two_cut_shrink},
            {"one_cut_shrink", counted.one_cut_shrink}}},
          {"rounding",
           {{"queries", rounding.queries},
            {"pairs_f32", rounding.pairs_f32},
            {"pairs_nearest", rounding.pairs_nearest},
            {"pairs_outward", rounding.pairs_outward},
            {"escapes_nearest", rounding.gates_nearest.escapes},
            {"escapes_outward", rounding.gates_outward.escapes}}}};
}

Json paper_json(const PaperReport& report) {
  Json meshes = Json::array();
  for (const PaperFigures& mesh : report.meshes) meshes.push_back(mesh_json(mesh));
  Json stairs = Json::array();
  for (const StairFigures& row : report.stairs) {
    stairs.push_back({{"depth", row.depth},
                      {"steps", row.steps},
                      {"missed_f32", row.missed_f32},
                      {"missed_nearest", row.missed_nearest},
                      {"missed_outward", row.missed_outward}});
  }
  Json rows = Json::array();
  for (const PeerRow& row : report.peers) {
    rows.push_back({{"mesh", row.mesh},
                    {"library", row.library},
                    {"variant", row.variant},
                    {"metric", row.metric},
                    {"value", row.value},
                    {"unit", row.unit}});
  }
  return {{"command", report.command}, {"meshes", meshes}, {"stairs", stairs}, {"rows", rows}};
}

// A file that was written.
struct Written {
  std::filesystem::path path;
  std::size_t bytes = 0;
};

// A path that was not given is empty: then nothing is written. "-" is standard output. What is a
// file is added to `written`.
Status write_text(const std::filesystem::path& path, const std::string& text,
                  std::vector<Written>& written) {
  if (path.empty()) return {};
  if (is_standard_stream(path)) {
    fmt::print("{}", text);
    return {};
  }
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  if (Status status = file->write(std::as_bytes(std::span(text))); !status) return status;
  if (Status status = file->commit(); !status) return status;
  written.push_back({path, text.size()});
  return {};
}

// Page and figures, where they are wanted; and what the terminal is shown, with --json the figures,
// else a summary and what was written, with what is in `written` by then.
int write_report(const ReportArguments& arguments, const Page& page, const Json& figures,
                 const Page& summary, std::vector<Written> written = {}) {
  if (Status status = write_text(arguments.output, to_html(page), written); !status) {
    return fail(status.error());
  }
  if (Status status = write_text(arguments.json_out, document_text(figures), written); !status) {
    return fail(status.error());
  }
  if (arguments.json) {
    print(figures);
  } else if (prints_summary(arguments)) {
    fmt::print("{}", to_text(summary));
    for (const Written& file : written) {
      fmt::print("wrote {}, {} bytes\n", shown(file.path.string()), file.bytes);
    }
    if (written.empty()) fmt::print("no page was written; -o FILE.html writes one\n");
  }
  return 0;
}

std::string command_of(const ReportArguments& arguments) {
  std::string command = "boxtree report";
  if (arguments.paper) command += " --paper";
  if (arguments.quick) command += " --quick";
  if (arguments.no_times && !arguments.paper) command += " --no-times";
  if (arguments.f64) command += " --f64";
  if (arguments.skip_bad) command += " --skip-bad";
  if (arguments.tolerance) command += fmt::format(" --tolerance {}", *arguments.tolerance);
  for (const auto& mesh : arguments.meshes) command += " " + shell_word(mesh.filename().string());
  return command;
}

Result<Imported> read_mesh(const std::filesystem::path& path, const ReportArguments& arguments) {
  ImportOptions options = careful_import();
  options.skip_bad = arguments.skip_bad;
  options.command = "report";
  if (arguments.f64) options.precision = Precision::kF64;
  options.keep_doubles = true;  // as --exact does, in the commands that are recommended
  options.count_moves = arguments.tolerance.has_value();
  Result<Imported> imported = import_mesh(path, options);
  if (!imported) return imported.error();
  if (arguments.tolerance) {
    const Status status = check_moved_by_f32(imported->mesh, source_of(imported->report).string(),
                                             *arguments.tolerance);
    if (!status) return status.error();
  }
  for (const std::string& warning : warnings_of(imported->report)) warn(warning);
  if (const std::size_t skipped = imported->report.skipped.size(); skipped > 0) {
    warn(fmt::format("{}: {} left out by --skip-bad", path.string(), counted(skipped, "bad face")));
  }
  imported->mesh.name = path.stem().string();
  return imported;
}

Result<PaperReport> measure_paper(const ReportArguments& arguments) {
  PaperReport report;
  report.command = command_of(arguments);
  const bool has_peers = !arguments.no_times && !arguments.peers.empty();
  const std::size_t parts = arguments.meshes.size() + (has_peers ? 2u : 1u);
  StepPrinter steps(!arguments.quiet, StepPrinter::Elsewhere::kLines);
  const auto step = [&](const std::string& what, std::size_t part) {
    steps(what, static_cast<double>(part) / static_cast<double>(parts));
  };
  for (std::size_t i = 0; i < arguments.meshes.size(); ++i) {
    const std::string name = arguments.meshes[i].filename().string();
    step("import " + name, i);
    const Result<Imported> imported = read_mesh(arguments.meshes[i], arguments);
    if (!imported) return imported.error();
    step("encode and query " + name, i);
    Result<PaperFigures> figures = paper_figures(imported->mesh);
    if (!figures) return figures.error();
    report.meshes.push_back(std::move(*figures));
  }
  step("query stairs", arguments.meshes.size());
  Result<std::vector<StairFigures>> stairs = stair_contact();
  if (!stairs) return stairs.error();
  report.stairs = std::move(*stairs);
  if (has_peers) {
    step("query other libraries", arguments.meshes.size() + 1);
    Result<std::vector<PeerRow>> rows = measure_paper_peers(arguments);
    if (!rows) return rows.error();
    report.peers = std::move(*rows);
  }
  return report;
}

int run_paper(const ReportArguments& arguments) {
  const Result<PaperReport> report = measure_paper(arguments);
  if (!report) return fail(report.error());
  const Page page = paper_page(*report);
  return write_report(arguments, page, paper_json(*report), page);
}

// Why other libraries are not in the report; empty when they are.
std::string why_no_peers(const ReportArguments& arguments) {
  if (arguments.no_times) return "--no-times";
  if (arguments.peers.empty()) return "no --peers PROGRAM";
  return {};
}

Result<TradeoffReport> measure_all(const ReportArguments& arguments) {
  TradeoffReport report;
  report.quick = arguments.quick;
  report.surroundings = surroundings(command_of(arguments));
  report.no_peers = why_no_peers(arguments);
  // What can be refused at once is read before what takes minutes.
  for (const std::filesystem::path& path : arguments.included) {
    Result<IncludedResults> results = read_results(path);
    if (!results) return results.error();
    report.included.push_back(std::move(*results));
  }
  const std::size_t parts = arguments.meshes.size() + (report.no_peers.empty() ? 1u : 0u);
  const auto part = [&](double done) { return done / static_cast<double>(parts); };
  StepPrinter steps(!arguments.quiet, StepPrinter::Elsewhere::kLines);
  for (std::size_t i = 0; i < arguments.meshes.size(); ++i) {
    const auto before = static_cast<double>(i);
    steps("import " + arguments.meshes[i].filename().string(), part(before));
    const Result<Imported> imported = read_mesh(arguments.meshes[i], arguments);
    if (!imported) return imported.error();
    Result<MeshTradeoff> figures = measure_tradeoff(
        imported->mesh, {arguments.quick, !arguments.no_times, arguments.tolerance},
        [&](const std::string& step, double share) { steps(step, part(before + share)); });
    if (!figures) return figures.error();
    figures->file_name = arguments.meshes[i].filename().string();
    figures->skipped = imported->report.skipped.size();
    report.meshes.push_back(std::move(*figures));
  }
  if (report.no_peers.empty()) {
    steps("query other libraries", part(static_cast<double>(arguments.meshes.size())));
    Result<std::vector<PeerRow>> rows = measure_tradeoff_peers(arguments);
    if (!rows) return rows.error();
    report.peers = std::move(*rows);
  }
  return report;
}

int run_tradeoff(const ReportArguments& arguments) {
  const Result<TradeoffReport> report = measure_all(arguments);
  if (!report) return fail(report.error());
  for (const MeshTradeoff& mesh : report->meshes) {
    const std::string disturbance = disturbance_in_words(mesh);
    // The summary says it, too.
    if (!disturbance.empty() && !prints_summary(arguments)) warn(mesh.name + ": " + disturbance);
  }
  std::vector<Written> written;
  if (Status status = write_text(arguments.csv, to_csv(*report), written); !status)
    return fail(status.error());
  if (Status status = write_text(arguments.approximate_csv, approximate_to_csv(*report), written);
      !status) {
    return fail(status.error());
  }
  return write_report(arguments, tradeoff_page(*report), parse_json(to_json(*report)).value,
                      tradeoff_summary(*report), std::move(written));
}

// A mesh by whose ending an output was meant; empty if there is none.
std::string misplaced_output(const ReportArguments& arguments) {
  constexpr std::array<std::pair<const char*, const char*>, 4> kOptions = {
      {{".html", "-o"}, {".htm", "-o"}, {".csv", "--csv"}, {".json", "--json-out"}}};
  for (const std::filesystem::path& mesh : arguments.meshes) {
    const std::string ending = in_lower_case(mesh.extension().string());
    for (const auto& [of, option] : kOptions) {
      if (ending != of) continue;
      return fmt::format("{0} is no mesh; did you mean {1} {0}?", shown(mesh.string()), option);
    }
  }
  return {};
}

int run(const ReportArguments& arguments) {
  const auto& meshes = arguments.meshes;
  if (std::any_of(meshes.begin(), meshes.end(), is_standard_stream)) {
    return usage("report: - (standard input) is no file; expected names of meshes");
  }
  if (const std::string fault = misplaced_output(arguments); !fault.empty())
    return usage("report: " + fault);
  std::vector<std::filesystem::path> inputs = arguments.meshes;
  inputs.insert(inputs.end(), arguments.included.begin(), arguments.included.end());
  if (Status status = check_outputs(outputs_of(arguments), inputs); !status) {
    return usage("report: " + status.error().detail);
  }
  // Before the first is measured, which may take a minute.
  for (const std::filesystem::path& input : inputs) {
    std::error_code ignored;
    if (!std::filesystem::exists(status_of(input, ignored))) {
      return fail(input_failure(input_name(input), ENOENT));
    }
  }
  struct Kind {
    const std::filesystem::path& output;
    const char* ending;
    OutputKind kind;
  };
  for (const auto& [output, ending, kind] :
       {Kind{arguments.output, ".html", OutputKind::kReportPage},
        Kind{arguments.json_out, ".json", OutputKind::kReportJson},
        Kind{arguments.csv, ".csv", OutputKind::kReportCsv},
        Kind{arguments.approximate_csv, ".csv", OutputKind::kReportCsv}}) {
    if (const std::string fault = mesh_name_fault(output, ending); !fault.empty())
      return usage("report: " + fault);
    if (is_standard_stream(output)) continue;
    if (Status status = check_replaced(output, kind); !status)
      return usage("report: " + status.error().detail);
    if (output.empty()) continue;
    if (const Result<AtomicFile> writable = AtomicFile::create(output); !writable)
      return fail(writable.error());
  }
  const std::string page = in_lower_case(arguments.output.extension().string());
  if (!page.empty() && page != ".html" && page != ".htm") {
    warn(arguments.output.string() + ": the page is HTML, whatever its ending: expected .html");
  }
  if (count_standard_outputs(arguments) + (arguments.json ? 1 : 0) > 1) {
    return usage("report: standard output takes one of the page, --json, --json-out and CSV");
  }
  if (arguments.quiet && !arguments.json && !has_output(arguments)) {
    return usage("report: with --quiet and no output nothing is told; expected -o FILE.html");
  }
  int status = 0;
  run_on_threads(arguments.jobs, [&] {
    status = arguments.paper ? run_paper(arguments) : run_tradeoff(arguments);
  });
  return status;
}

}  // namespace

void add_report_command(Command& program, int& status) {
  const auto arguments = std::make_shared<ReportArguments>();
  Command& command = program.add_command(
      "report",
      "Show which encoding to use for meshes: bytes, times and errors\n"
      "Of meshes alone: what a profile leaves out, cook --profile FILE --why tells. The page has "
      "grids of so many bits, and with --tolerance that of a tolerance of your own.\n"
      "Every encoding is measured: that takes half a minute for 500 triangles, a minute for 5000 "
      "and in proportion above, with --quick some seconds. Standard error tells the steps, but "
      "with --quiet.");
  command.add_file("MESH", arguments->meshes, Values::kMeshes, "Mesh files")->required();
  Option* paper = command.add_flag("--paper", arguments->paper, "The tables of the paper instead");
  command.add_file("-o,--output", arguments->output, Values::kFiles,
                   "Write an HTML page; - is standard output [none: a summary]");
  command.add_option("-j,--jobs", arguments->jobs, "Threads that cook; times are of one [all]")
      ->type_name("N")
      ->between(1, 1024);
  command.add_flag("-q,--quiet", arguments->quiet, "Print errors and warnings only");
  command.add_flag("--json", arguments->json, "Print all figures as one JSON document");
  command.add_file("--json-out", arguments->json_out, Values::kFiles, "Write the same to a file");
  command.add_file("--csv", arguments->csv, Values::kFiles, "Write a row for each encoding as CSV")
      ->excludes(paper);
  command
      .add_file("--csv-approximate", arguments->approximate_csv, Values::kFiles,
                "Write a row for each allowed error and budget of approximate queries as CSV")
      ->excludes(paper);
  command
      .add_flag(
          "--f64", arguments->f64,
          "Hold positions as f64, not f32, for meshes far from the origin: all digits of OBJ, "
          "OFF, PLY and text STL files, and what nodes of others place [for PLY files whose "
          "doubles f32 does not hold]")
      ->excludes(paper);
  command
      .add_option(
          "--tolerance", arguments->tolerance,
          "Recommend what moves no vertex farther, in units of the mesh, and show its grid [a "
          "ten-thousandth of the diagonal for the smallest, a millionth for the balanced]")
      ->type_name("LENGTH")
      ->above_zero("a length")
      ->excludes(paper);
  Option* skip_bad = command.add_flag("--skip-bad", arguments->skip_bad,
                                      "Leave out faces with NaN, infinite or missing vertices");
  command.add_flag("--quick", arguments->quick, "Few encodings, queries and runs: for a look");
  command.add_flag("--no-times", arguments->no_times,
                   "Count only: the same figures on every machine");
  command
      .add_file("--include", arguments->included, Values::kFiles,
                "JSON results of boxtree_stiff or boxtree_robustness (BUILD/tests, with --json), "
                "shown as tables of their own")
      ->excludes(paper);
  command
      .add_option("--peers", arguments->peers,
                  "The program boxtree_peers, to measure other libraries, too "
                  "(BUILD/tests/bench/boxtree_peers) [none]")
      ->type_name("PROGRAM")
      ->group(kRareOptions)
      ->excludes(skip_bad);
  command.example("A page, for a look", "boxtree report bunny.obj -o bunny.html --quick");
  command.example("What a vertex may be off by 0.001 saves",
                  "boxtree report bunny.obj -o bunny.html --quick --tolerance 0.001");
  command.example("Counted figures alone, the same on every machine",
                  "boxtree report bunny.obj --quick --no-times --csv bunny.csv");
  command.callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace boxtree::cooker
