// SPDX-License-Identifier: MIT
// boxtree_robustness: prints one line per case; exits with 7 if one exceeds its limit.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/robustness/run.h"
#include "tests/support/program_options.h"

namespace boxtree::robustness {
namespace {

// The same exit codes as the cooker's command line.
constexpr int kUsage = 1;
constexpr int kWriteFailed = 2;
constexpr int kDifferenceFound = 7;

struct Arguments {
  bool full = false;
  std::vector<std::string> only;
  std::string json;
};

bool is_wanted(const Case& tested, const std::vector<std::string>& only) {
  return only.empty() || std::find(only.begin(), only.end(), tested.id) != only.end();
}

// An unknown case must not pass.
bool all_known(const std::vector<std::string>& only) {
  const std::vector<Case> cases = all_cases();
  return std::all_of(only.begin(), only.end(), [&](const std::string& id) {
    return std::any_of(cases.begin(), cases.end(), [&](const Case& c) { return c.id == id; });
  });
}

int run(const Arguments& arguments) {
  if (!all_known(arguments.only)) {
    fmt::print(stderr, "no such case\n");
    return kUsage;
  }
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  bool all_pass = true;
  fmt::print("{:4} {:62} {:>10} {:>8}  {:28} {}\n", "id", "what", "figure", "limit", "of", "pass");
  for (const Case& tested : all_cases()) {
    if (!is_wanted(tested, arguments.only)) continue;
    const Run found = run_case(tested, arguments.full);
    const bool pass = found.passes(tested.limit);
    all_pass &= pass;
    fmt::print("{:4} {:62} {:>10.4g} {:>8.4g}  {:28} {}\n", tested.id, tested.what, found.figure(),
               tested.limit, fmt::format("{} ({} checks)", tested.unit, found.checks()),
               pass ? "pass" : "FAIL");
    for (const std::string& complaint : found.complaints()) fmt::print("       {}\n", complaint);
    std::fflush(stdout);
    rows.push_back({{"id", tested.id},
                    {"name", tested.name},
                    {"what", tested.what},
                    {"figure", found.figure()},
                    {"limit", tested.limit},
                    {"unit", tested.unit},
                    {"checks", found.checks()},
                    {"pass", pass},
                    {"complaints", found.complaints()}});
  }
  if (!arguments.json.empty()) {
    std::ofstream out(arguments.json);
    out << nlohmann::ordered_json{{"full", arguments.full}, {"rows", rows}}.dump(2) << '\n';
    out.close();
    if (!out) {
      fmt::print(stderr, "cannot write {}\n", arguments.json);
      return kWriteFailed;
    }
  }
  return all_pass ? 0 : kDifferenceFound;
}

}  // namespace
}  // namespace boxtree::robustness

int main(int argc, char** argv) {
  boxtree::robustness::Arguments arguments;
  boxtree::test::ProgramOptions program("The robustness suite: id, what, figure, limit, pass.");
  program.add("CASE", arguments.only, "ids of the cases to run [all]");
  program.add_flag("--full", arguments.full, "counts of a documented run: minutes, gigabytes");
  program.add("--json", arguments.json, "also write the table there");
  if (const std::optional<int> status = program.parse(argc, argv)) return *status;
  return boxtree::robustness::run(arguments);
}
