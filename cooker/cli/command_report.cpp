// SPDX-License-Identifier: MIT
// `boxtree report --paper`: the tables of the paper for any mesh.
#include <array>
#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <filesystem>
#include <memory>
#include <spawn.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>
#include <vector>

#include <fmt/format.h>

#include <boxtree/cooker/cli/output.h>
#include <boxtree/cooker/import/import.h>
#include <boxtree/cooker/report/paper_tables.h>
#include <boxtree/cooker/write/atomic_file.h>

namespace boxtree::cooker {
namespace {

struct Arguments {
  std::vector<std::filesystem::path> meshes;
  std::filesystem::path output;
  std::filesystem::path json;
  std::filesystem::path peers;
  bool paper = false;
  bool quick = false;
  bool no_times = false;
};

// The measuring program of a build folder: it is not part of an installation.
std::filesystem::path default_peers() {
  std::error_code error;
  const std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) return {};
  const std::filesystem::path path = self.parent_path() / "tests/bench/boxtree_peers";
  return std::filesystem::exists(path, error) ? path : std::filesystem::path();
}

// What a program prints on standard output; its messages go where ours do.
Result<std::string> output_of(const std::vector<std::string>& command) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) {
    return Error{Errc::kInternal, "pipe: " + std::generic_category().message(errno)};
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  std::vector<char*> arguments;
  for (const std::string& argument : command)
    arguments.push_back(const_cast<char*>(argument.c_str()));
  arguments.push_back(nullptr);
  pid_t child = 0;
  const int failed =
      ::posix_spawn(&child, arguments[0], &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  ::close(ends[1]);
  if (failed != 0) {
    ::close(ends[0]);
    return Error{Errc::kFileUnreadable,
                 command[0] + ": " + std::generic_category().message(failed)};
  }
  std::string text;
  std::array<char, 65536> block;
  ssize_t got = 0;
  while ((got = ::read(ends[0], block.data(), block.size())) > 0 || (got < 0 && errno == EINTR)) {
    if (got > 0) text.append(block.data(), static_cast<std::size_t>(got));
  }
  ::close(ends[0]);
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) {
  }
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
    return Error{Errc::kInternal, command[0] + ": ended with status " + std::to_string(status)};
  }
  return text;
}

Result<std::vector<PeerRow>> measure_peers(const Arguments& arguments) {
  std::vector<std::string> command = {arguments.peers.string()};
  for (const std::filesystem::path& mesh : arguments.meshes) command.push_back(mesh.string());
  const char* const turns = arguments.quick ? "2" : "12";
  const char* const runs = arguments.quick ? "1" : "5";
  command.insert(command.end(), {"--json", "--builder", "paper", "--questions", "tumble",
                                 "--tumble", turns, "--runs", runs, "--only", "original", "--only",
                                 "boxtree", "--only", "fcl:kdop18"});
  const Result<std::string> text = output_of(command);
  if (!text) return text.error();
  std::vector<PeerRow> rows;
  try {
    const Json document = Json::parse(*text);
    for (const auto& row : document.at("rows")) {
      rows.push_back({row.at("mesh"), row.at("library"), row.at("variant"), row.at("metric"),
                      row.at("value"), row.at("unit")});
    }
  } catch (const Json::exception& error) {
    return Error{Errc::kInternal, arguments.peers.string() + ": " + error.what()};
  }
  return rows;
}

Json to_json(const PaperFigures& mesh) {
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
          {"kinds", mesh.kinds},
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
           {{"questions", rounding.questions},
            {"pairs_f32", rounding.pairs_f32},
            {"pairs_nearest", rounding.pairs_nearest},
            {"pairs_outward", rounding.pairs_outward},
            {"escapes_nearest", rounding.gates_nearest.escapes},
            {"escapes_outward", rounding.gates_outward.escapes}}}};
}

Json to_json(const PaperReport& report) {
  Json meshes = Json::array();
  for (const PaperFigures& mesh : report.meshes) meshes.push_back(to_json(mesh));
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

Status write_text(const std::filesystem::path& path, const std::string& text) {
  Result<AtomicFile> file = AtomicFile::create(path);
  if (!file) return file.error();
  if (Status status = file->write(std::as_bytes(std::span(text))); !status) return status;
  return file->commit();
}

std::string command_of(const Arguments& arguments) {
  std::string command = "boxtree report --paper";
  if (arguments.quick) command += " --quick";
  for (const auto& mesh : arguments.meshes) command += " " + mesh.filename().string();
  return command;
}

int run(const Arguments& arguments) {
  PaperReport report;
  report.command = command_of(arguments);
  for (const std::filesystem::path& path : arguments.meshes) {
    Result<Imported> imported = import_mesh(path);
    if (!imported) return fail(imported.error());
    imported->mesh.name = path.stem().string();
    Result<PaperFigures> figures = paper_figures(imported->mesh);
    if (!figures) return fail(figures.error());
    report.meshes.push_back(std::move(*figures));
  }
  Result<std::vector<StairFigures>> stairs = stair_contact();
  if (!stairs) return fail(stairs.error());
  report.stairs = std::move(*stairs);
  if (!arguments.no_times && !arguments.peers.empty()) {
    Result<std::vector<PeerRow>> rows = measure_peers(arguments);
    if (!rows) return fail(rows.error());
    report.peers = std::move(*rows);
  }
  const Page page = paper_page(report);
  fmt::print("{}", to_text(page));
  if (!arguments.output.empty()) {
    if (Status status = write_text(arguments.output, to_html(page)); !status) {
      return fail(status.error());
    }
  }
  if (!arguments.json.empty()) {
    if (Status status = write_text(arguments.json, to_json(report).dump(1) + "\n"); !status) {
      return fail(status.error());
    }
  }
  return 0;
}

}  // namespace

void add_report_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<Arguments>();
  arguments->peers = default_peers();
  CLI::App& command = *app.add_subcommand("report", "Redraw the paper's tables for meshes");
  command.add_option("meshes", arguments->meshes, "Mesh files")->required();
  command.add_flag("--paper", arguments->paper, "The tables of the paper (the only report so far)")
      ->required();
  command.add_option("-o,--output", arguments->output, "Write an HTML page");
  command.add_option("--json", arguments->json, "Write all figures as JSON");
  command.add_flag("--quick", arguments->quick, "Few poses and one run: for a look");
  command.add_flag("--no-times", arguments->no_times, "Leave out what needs boxtree_peers");
  command
      .add_option("--peers", arguments->peers,
                  "The program boxtree_peers [tests/bench/ beside this one, if built]")
      ->group(kRareOptions);
  command.callback([arguments, &status] { status = run(*arguments); });
}

}  // namespace boxtree::cooker
