// SPDX-License-Identifier: MIT
// boxtree_stiff: runs the cases of stiff contact and prints a line for each figure and its limit.
#include <cstdio>
#include <exception>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/stiff/cases.h"
#include "tests/support/program_options.h"

namespace boxtree::stiff {
namespace {

struct Arguments {
  std::vector<std::string> cases;
  std::filesystem::path json;
  std::filesystem::path plots;
  bool quick = false;
};

void write_text(const std::filesystem::path& path, const std::string& text) {
  std::FILE* file = std::fopen(path.c_str(), "wb");
  bool written = file != nullptr;
  if (written) {
    written = std::fwrite(text.data(), 1, text.size(), file) == text.size();
    written &= std::fclose(file) == 0;
  }
  if (!written) throw std::runtime_error("cannot write " + path.string());
}

std::string limit_text(const Row& row) {
  switch (row.relation) {
    case Row::Limit::kAtMost:
      return fmt::format("<= {:.3g}", row.limit);
    case Row::Limit::kAtLeast:
      return fmt::format(">= {:.3g}", row.limit);
    case Row::Limit::kNone:
      break;
  }
  return "-";
}

const char* result_text(const Row& row) {
  if (row.relation == Row::Limit::kNone) return "-";
  return row.pass() ? "pass" : "FAIL";
}

void print_row(const Row& row) {
  const std::string line =
      fmt::format("{}  {:<44}  {:<48}  {:>10.3g}  {:>9}  {}\n", row.id, row.setting, row.what,
                  row.figure, limit_text(row), result_text(row));
  static_cast<void>(std::fwrite(line.data(), 1, line.size(), stdout));
  static_cast<void>(std::fflush(stdout));
}

nlohmann::ordered_json json_of(const Row& row) {
  nlohmann::ordered_json json = {{"id", row.id},
                                 {"setting", row.setting},
                                 {"what", row.what},
                                 {"figure", row.figure},
                                 {"limit", limit_text(row)}};
  if (row.relation != Row::Limit::kNone) json["pass"] = row.pass();
  return json;
}

// Whether every figure keeps to its limit.
bool run(const Arguments& arguments) {
  bool pass = true;
  nlohmann::ordered_json document;
  document["quick"] = arguments.quick;
  document["rows"] = nlohmann::ordered_json::array();
  if (!arguments.plots.empty()) std::filesystem::create_directories(arguments.plots);
  for (const CaseInfo& info : kCases) {
    const bool wanted =
        arguments.cases.empty() ||
        std::find(arguments.cases.begin(), arguments.cases.end(), info.id) != arguments.cases.end();
    if (!wanted) continue;
    const CaseResult result = info.run({arguments.quick});
    for (const Row& row : result.rows) {
      print_row(row);
      document["rows"].push_back(json_of(row));
      pass &= row.pass();
    }
    for (const NamedPlot& plot : result.plots) {
      if (arguments.plots.empty()) break;
      write_text(arguments.plots / (plot.name + ".svg"), cooker::to_svg_file(plot.plot));
    }
  }
  document["pass"] = pass;
  if (!arguments.json.empty()) write_text(arguments.json, document.dump(1) + "\n");
  return pass;
}

}  // namespace
}  // namespace boxtree::stiff

int main(int argc, char** argv) {
  boxtree::stiff::Arguments arguments;
  std::vector<std::string> names;
  for (const auto& info : boxtree::stiff::kCases) names.emplace_back(info.id);
  boxtree::test::ProgramOptions program(
      "Stiff contact: a penalty-contact simulation over every codec. Exit status 1 when a "
      "figure misses its limit.");
  program.add("--case", arguments.cases, "S1 to S6; all by default").one_of(names);
  program.add_flag("--quick", arguments.quick, "Fewer steps and settings");
  program.add("--json", arguments.json, "Write all figures");
  program.add("--plots", arguments.plots, "Folder for plots of energy, chatter and depth");
  if (const std::optional<int> status = program.parse(argc, argv)) return *status;
  try {
    return boxtree::stiff::run(arguments) ? 0 : 1;
  } catch (const std::exception& error) {
    static_cast<void>(std::fprintf(stderr, "boxtree_stiff: %s\n", error.what()));
    return 2;
  }
}
