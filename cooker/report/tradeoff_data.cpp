// SPDX-License-Identifier: MIT
// Formats figures as text; computes none.
#include "cooker/report/tradeoff_data.h"

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <thread>
#ifndef _WIN32
#include <sys/utsname.h>
#endif

#include <fmt/format.h>

#include "cooker/choose/measure.h"
#include "cooker/import/whole_file.h"
#include "cooker/report/pages_json.h"
#include "cooker/report/tradeoff_advice.h"
#include "cooker/text/json.h"
#include "cooker/version.h"

namespace boxtree::cooker {
namespace {

// The rest of the first line that begins with `key` and a colon.
std::string line_of(const char* path, const std::string& key) {
  std::ifstream in(path);
  for (std::string line; std::getline(in, line);) {
    const std::size_t colon = line.find(':');
    if (line.rfind(key, 0) != 0 || colon == std::string::npos) continue;
    const std::size_t first = line.find_first_not_of(" \t", colon + 1);
    return first == std::string::npos ? "" : line.substr(first);
  }
  return {};
}

constexpr const char* kCompiler =
#if defined(__clang__)
    "Clang " __clang_version__
#elif defined(__GNUC__)
    "GCC " __VERSION__
#else
    "unknown"
#endif
#ifdef __OPTIMIZE__
    ", optimised"
#else
    ", not optimised"
#endif
#ifndef NDEBUG
    ", with assertions"
#endif
    ;

std::string text_of(const Json& value) {
  if (value.is_null()) return {};
  if (value.is_string()) return value.get<std::string>();
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number()) return fmt::format("{:g}", value.get<double>());
  return value.dump();
}

std::string text_at(const Json& row, const char* name) {
  return row.contains(name) ? text_of(row[name]) : std::string();
}

Json to_json(const ByteParts& bytes) {
  return {{"nodes", bytes.nodes},       {"vertices", bytes.vertices}, {"corners", bytes.corners},
          {"face_ids", bytes.face_ids}, {"rest", bytes.rest},         {"total", bytes.total()}};
}

Json to_json(const KindTimes& times) {
  return {{"median_ns", times.median_ns}, {"p99_ns", times.p99_ns}, {"mean_ns", times.mean_ns}};
}

Json to_json(const MeshTradeoff& mesh, const std::vector<ApproximateStep>& steps) {
  Json json = Json::array();
  for (const ApproximateStep& step : steps) {
    const bool has_budget = step.node_budget != kUnlimitedNodes;
    json.push_back({{"relative_error", step.relative_error},
                    {"node_budget", has_budget ? Json(step.node_budget) : Json(nullptr)},
                    {"times", mesh.timed ? to_json(step.times) : Json(nullptr)},
                    {"nodes_mean", step.nodes_mean},
                    {"nodes_median", step.nodes_median},
                    {"error_max", step.error_max},
                    {"error_median", step.error_median},
                    {"gap_max", step.gap_max},
                    {"gap_median", step.gap_median},
                    {"queries", step.queries},
                    {"found", step.found},
                    {"converged", step.converged},
                    {"false_bounds", step.false_bounds},
                    {"slower", step.slower}});
  }
  return json;
}

Json to_json(const MeshTradeoff& mesh, const ApproximateFigures& figures) {
  if (figures[0].by_error.empty()) return nullptr;
  Json json;
  for (std::size_t kind = 0; kind < kApproximateKinds; ++kind) {
    json[kApproximateNames[kind]] = {{"by_error", to_json(mesh, figures[kind].by_error)},
                                     {"by_budget", to_json(mesh, figures[kind].by_budget)}};
  }
  return json;
}

Json to_json(const MeshTradeoff& mesh, const TradePoint& point) {
  Json work;
  for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
    work[kQueryNames[kind]] = {{"nodes", point.work[kind].nodes},
                               {"leaves", point.work[kind].leaves},
                               {"extra_nodes", point.extra_nodes[kind]},
                               {"false_leaf_tests", point.false_leaf_tests[kind]},
                               {"modelled_ns", point.modelled[kind]}};
  }
  Json times = nullptr;
  if (mesh.timed) {
    for (std::size_t kind = 0; kind < kTimedKinds; ++kind) {
      times[kTimedNames[kind]] = to_json(point.times[kind]);
    }
  }
  return {
      {"name", point.name()},
      {"codec", codec_name(point.codec)},
      {"geometry", geometry_name(point.geometry)},
      {"grid_bits", point.grid_bits == 0 ? Json(nullptr) : Json(point.grid_bits)},
      {"tolerance", point.tolerance ? Json(*point.tolerance) : Json(nullptr)},
      {"bytes", to_json(point.bytes)},
      {"bytes_per_triangle", mesh.per_triangle(point.bytes.total())},
      {"gates",
       {{"pass", point.gates.pass()},
        {"missed", point.gates.missed},
        {"escapes", point.gates.escapes},
        {"certificate", point.gates.certificate}}},
      {"work_reference", codec_name(point.reference)},
      {"work", work},
      {"surface",
       {{"max", point.surface_max}, {"rms", point.surface_rms}, {"bound", point.surface_bound}}},
      {"answers",
       {{"distance_max", point.answers.distance_max},
        {"distance_median", point.answers.distance_median},
        {"ray_median", point.answers.ray_median},
        {"flips_per_million", point.answers.flips_per_million}}},
      {"pages", to_json(point.pages)},
      {"times", times},
      {"approximate", to_json(mesh, point.approximate)}};
}

Json to_json(const MeshTradeoff& mesh) {
  Json json = {
      {"mesh", mesh.name},
      {"triangles", mesh.triangles},
      {"vertices", mesh.vertices},
      {"skipped", mesh.skipped},
      {"diagonal", mesh.diagonal},
      {"positions", precision_name(mesh.is_f64 ? Precision::kF64 : Precision::kF32)},
      {"moved_by_f32", mesh.moved_by_f32},
      {"source_bytes", to_json(mesh.source)},
      {"processor_share", mesh.timed ? Json(mesh.timed_work.processor_share()) : Json(nullptr)},
      {"speed_ratio", mesh.timed ? Json(mesh.timed_work.speed_ratio()) : Json(nullptr)}};
  json["advice"] = nullptr;
  if (const auto advice = advise(mesh)) {
    json["advice"] = {{"balanced", mesh.points[advice->balanced].name()},
                      {"smallest", mesh.points[advice->smallest].name()},
                      {"fastest_exact", mesh.points[advice->fastest_exact].name()},
                      {"smallest_exact", mesh.points[advice->smallest_exact].name()}};
  }
  json["points"] = Json::array();
  const std::vector<double> slower = slowdowns_of(mesh);
  for (std::size_t i = 0; i < slower.size(); ++i) {
    Json point = to_json(mesh, mesh.points[i]);
    point["slowdown"] = slower[i];
    json["points"].push_back(std::move(point));
  }
  return json;
}

// Quoted if it contains a comma, a quote or a line end.
std::string cell(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

}  // namespace

Surroundings surroundings(const std::string& command) {
  Surroundings around;
  around.processor = line_of("/proc/cpuinfo", "model name");
  if (around.processor.empty()) around.processor = "unknown";
  around.instruction_set = instruction_set();
  around.threads = std::to_string(std::thread::hardware_concurrency());
#ifndef _WIN32
  utsname system{};
  if (::uname(&system) == 0) {
    around.system = fmt::format("{} {} {}", system.sysname, system.release, system.machine);
  }
  double load = 0;
  if (::getloadavg(&load, 1) == 1) around.load = fmt::format("{:.2f}", load);
#endif
  around.compiler = kCompiler;
  around.version = kVersion;
  around.command = command;
  return around;
}

Result<IncludedResults> read_results(const std::filesystem::path& path) {
  const Result<std::string> text = read_whole_file(path, kMaxResultsBytes);
  if (!text) return text.error();
  const ParsedJson parsed = parse_json(*text);
  const Json& document = parsed.value;
  const bool has_rows = document.is_object() && document.contains("rows");
  const Json& rows = has_rows ? document["rows"] : document;
  const auto is_row = [](const Json& row) { return row.is_object(); };
  const char* const found = parsed.fault != ParsedJson::Fault::kNone ? "no JSON"
                            : !rows.is_array() || rows.empty()       ? "no rows"
                            : std::all_of(rows.begin(), rows.end(), is_row)
                                ? nullptr
                                : "rows of another kind";
  if (found != nullptr) {
    return Error{Errc::kDocumentInvalid,
                 fmt::format("{}: expected rows of results, as boxtree_stiff and "
                             "boxtree_robustness write with --json, found {}",
                             path.string(), found)};
  }
  IncludedResults results;
  results.title = has_rows ? text_at(document, "title") : "";
  if (results.title.empty()) results.title = path.stem().string();
  results.text = has_rows ? text_at(document, "text") : "";
  for (const Json& row : rows) {
    results.rows.push_back({text_at(row, "id"), text_at(row, "what"), text_at(row, "figure"),
                            text_at(row, "limit"), text_at(row, "pass")});
  }
  return results;
}

std::string to_json(const TradeoffReport& report) {
  const Surroundings& around = report.surroundings;
  Json json = {{"command", around.command},     {"version", around.version},
               {"processor", around.processor}, {"instruction_set", around.instruction_set},
               {"threads", around.threads},     {"system", around.system},
               {"compiler", around.compiler},   {"load", around.load},
               {"quick", report.quick}};
  json["meshes"] = Json::array();
  for (const MeshTradeoff& mesh : report.meshes) json["meshes"].push_back(to_json(mesh));
  json["peers"] = Json::array();
  for (const PeerRow& row : report.peers) {
    json["peers"].push_back({{"mesh", row.mesh},
                             {"library", row.library},
                             {"variant", row.variant},
                             {"metric", row.metric},
                             {"value", row.value},
                             {"unit", row.unit}});
  }
  json["included"] = Json::array();
  for (const IncludedResults& results : report.included) {
    Json rows = Json::array();
    for (const IncludedRow& row : results.rows) {
      rows.push_back({{"id", row.id},
                      {"what", row.what},
                      {"figure", row.figure},
                      {"limit", row.limit},
                      {"pass", row.pass}});
    }
    json["included"].push_back({{"title", results.title}, {"text", results.text}, {"rows", rows}});
  }
  return json.dump(1) + "\n";
}

std::string to_csv(const TradeoffReport& report) {
  std::string out =
      "mesh,triangles,codec,geometry,grid_bits,bytes_nodes,bytes_vertices,bytes_corners,"
      "bytes_face_ids,bytes_rest,bytes_total,bytes_per_triangle,pass,missed,escapes,surface_max,"
      "surface_rms,surface_bound,distance_max,distance_median,ray_median,flips_per_million";
  for (const char* kind : kQueryNames) {
    out += fmt::format(",{0}_nodes,{0}_leaves,{0}_extra_nodes,{0}_false_leaf_tests,{0}_modelled_ns",
                       kind);
  }
  for (const char* kind : kTimedNames)
    out += fmt::format(",{0}_median_ns,{0}_p99_ns,{0}_mean_ns", kind);
  out += ",pages_file,pages_open";
  for (const char* kind : {"ray", "box", "point"})
    out += fmt::format(",pages_{0},pages_{0}_worst", kind);
  out += ",tolerance\n";
  for (const MeshTradeoff& mesh : report.meshes) {
    for (const TradePoint& point : mesh.points) {
      const ByteParts& b = point.bytes;
      out += fmt::format(
          "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}", cell(mesh.name),
          mesh.triangles, codec_name(point.codec), geometry_name(point.geometry),
          point.grid_bits == 0 ? "" : std::to_string(point.grid_bits), b.nodes, b.vertices,
          b.corners, b.face_ids, b.rest, b.total(), mesh.per_triangle(b.total()),
          point.gates.pass() ? 1 : 0, point.gates.missed, point.gates.escapes, point.surface_max,
          point.surface_rms, point.surface_bound, point.answers.distance_max,
          point.answers.distance_median, point.answers.ray_median, point.answers.flips_per_million);
      for (std::size_t kind = 0; kind < kQueryKinds; ++kind) {
        out += fmt::format(",{},{},{},{},{}", point.work[kind].nodes, point.work[kind].leaves,
                           point.extra_nodes[kind], point.false_leaf_tests[kind],
                           point.modelled[kind]);
      }
      for (const KindTimes& times : point.times) {
        out += mesh.timed ? fmt::format(",{},{},{}", times.median_ns, times.p99_ns, times.mean_ns)
                          : ",,,";
      }
      out += fmt::format(",{},{}", point.pages.file_pages, point.pages.open);
      for (const PageCount& count : {point.pages.ray, point.pages.box, point.pages.point}) {
        out += fmt::format(",{},{}", count.median, count.worst);
      }
      out += fmt::format(",{}\n", point.tolerance ? fmt::format("{}", *point.tolerance) : "");
    }
  }
  return out;
}

std::string approximate_to_csv(const TradeoffReport& report) {
  std::string out =
      "mesh,triangles,codec,kind,relative_error,node_budget,median_ns,p99_ns,nodes_mean,"
      "nodes_median,error_max,error_median,gap_max,gap_median,queries,found,converged,"
      "false_bounds,slower\n";
  const auto add = [&](const MeshTradeoff& mesh, const TradePoint& point, const char* kind,
                       const ApproximateStep& step) {
    const bool has_budget = step.node_budget != kUnlimitedNodes;
    out += fmt::format(
        "{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{},{}\n", cell(mesh.name), mesh.triangles,
        codec_name(point.codec), kind, step.relative_error,
        has_budget ? std::to_string(step.node_budget) : "",
        mesh.timed ? fmt::format("{},{}", step.times.median_ns, step.times.p99_ns) : ",",
        step.nodes_mean, step.nodes_median, step.error_max, step.error_median, step.gap_max,
        step.gap_median, step.queries, step.found, step.converged, step.false_bounds, step.slower);
  };
  for (const MeshTradeoff& mesh : report.meshes) {
    for (const TradePoint& point : mesh.points) {
      for (std::size_t kind = 0; kind < kApproximateKinds; ++kind) {
        const ApproximateCurves& curves = point.approximate[kind];
        for (const auto* steps : {&curves.by_error, &curves.by_budget}) {
          for (const ApproximateStep& step : *steps) {
            add(mesh, point, kApproximateNames[kind], step);
          }
        }
      }
    }
  }
  return out;
}

}  // namespace boxtree::cooker
