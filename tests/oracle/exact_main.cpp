// SPDX-License-Identifier: MIT
// boxtree_exact: draws meshes and queries over all exponents and holds the answers of every codec
// and store against exact arithmetic. Exits with 7 when one is wrong.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <limits>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tests/oracle/exact/families.h"
#include "tests/support/program_options.h"

namespace boxtree::oracle {
namespace {

constexpr int kDifferenceFound = 7;         // as the command line of the cooker has it
constexpr std::size_t kManyKinds = 24;      // of meshes: more are not listed
constexpr std::uint64_t kEnoughWrong = 20;  // without --keep-going

struct Options {
  std::uint64_t answers = 100000;
  std::uint64_t seed = 1;
  std::vector<std::string> families;
  std::string json;
  std::optional<std::uint64_t> only;
  bool keep_going = false;
  bool verbose = false;
};

struct Outcome {
  Tally tally;
  std::uint64_t cases = 0;
  double seconds = 0;
};

std::uint64_t number_of(const std::string& name) {
  std::uint64_t number = 0;
  for (const char c : name) number = number * 31 + static_cast<unsigned char>(c);
  return number;
}

void run_case(const Family& family, Draw& draw, Tally& tally, std::uint64_t number) {
  try {
    family.run_case(draw, tally, number);
  } catch (const CookFailed& failed) {
    tally.begin_case(number, failed.mesh.faces.size(), failed.mesh.name);
    tally.answer();
    tally.wrong("cannot be cooked",
                [&] { return failed.message + "\n    " + text(failed.mesh, {}); });
  }
}

Outcome run(const Family& family, const Options& options, std::uint64_t answers) {
  Outcome outcome;
  const auto begin = std::chrono::steady_clock::now();
  for (std::uint64_t n = options.only.value_or(0);; ++n) {
    Draw draw(seed_of(options.seed, number_of(family.name), n));
    run_case(family, draw, outcome.tally, n);
    ++outcome.cases;
    if (options.only || outcome.tally.answers() >= answers) break;
    if (!options.keep_going && outcome.tally.wrong() >= kEnoughWrong) break;
  }
  outcome.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return outcome;
}

void print(const Family& family, const Outcome& outcome, const Options& options) {
  const Tally& t = outcome.tally;
  fmt::print(
      "{:10} {:9} answers {:7} wrong {:6} refused  largest error {:.3g} ulp  {:6.1f} s  ({})\n",
      family.name, t.answers(), t.wrong(), t.refused_count(), t.worst(), outcome.seconds,
      family.what);
  for (const auto& [category, found] : t.categories()) {
    std::string kinds;
    for (const auto& [kind, count] : found.by_kind) {
      if (found.by_kind.size() <= kManyKinds) kinds += fmt::format(", {} {}", count, kind);
    }
    fmt::print("  {} {}{}; for example (--seed {} --family {} --only {}):\n    {}\n", found.wrong,
               category, kinds, options.seed, family.name, found.example_case, found.example);
  }
  std::fflush(stdout);
}

nlohmann::ordered_json json_of(const Family& family, const Outcome& outcome) {
  nlohmann::ordered_json categories = nlohmann::ordered_json::array();
  for (const auto& [category, found] : outcome.tally.categories()) {
    categories.push_back({{"category", category},
                          {"wrong", found.wrong},
                          {"by_kind", found.by_kind},
                          {"case", found.example_case},
                          {"example", found.example}});
  }
  return {{"family", family.name},
          {"cases", outcome.cases},
          {"answers", outcome.tally.answers()},
          {"wrong", outcome.tally.wrong()},
          {"refused", outcome.tally.refused_count()},
          {"largest_error_ulp", outcome.tally.worst()},
          {"seconds", outcome.seconds},
          {"categories", categories}};
}

std::vector<Family> chosen(const Options& options) {
  std::vector<Family> families;
  for (const Family& family : all_families()) {
    const auto& names = options.families;
    const bool is_named = std::find(names.begin(), names.end(), family.name) != names.end();
    if (is_named || (names.empty() && family.share > 0)) {
      families.push_back(family);
    }
  }
  return families;
}

int run(const Options& options) {
  const std::vector<Family> families = chosen(options);
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  std::uint64_t wrong = 0, shares = 0;
  const auto share_of = [](const Family& family) { return std::max(family.share, 1u); };
  for (const Family& family : families) shares += share_of(family);
  for (const Family& family : families) {
    const Outcome outcome = run(family, options, options.answers * share_of(family) / shares);
    print(family, outcome, options);
    rows.push_back(json_of(family, outcome));
    wrong += outcome.tally.wrong();
  }
  if (!options.json.empty()) {
    std::ofstream file(options.json);
    file << nlohmann::ordered_json{{"schema", 1}, {"seed", options.seed}, {"families", rows}}.dump(
                2)
         << '\n';
    if (!file) throw std::runtime_error("cannot write " + options.json);
  }
  return wrong == 0 ? 0 : kDifferenceFound;
}

int main_of(int argc, char** argv) {
  Options options;
  std::vector<std::string> names;
  for (const Family& family : all_families()) names.emplace_back(family.name);
  boxtree::test::ProgramOptions program{
      "Compares the answers of every codec and store with exact arithmetic."};
  program.add("--answers", options.answers, "Answers to compare, in all families together")
      .shows_default();
  program.add("--seed", options.seed, "Meshes and queries depend on it alone").shows_default();
  program.add("--family", options.families, "Families to run [all but hulls]").one_of(names);
  program.add("--only", options.only, "One case by its number");
  program.add("--json", options.json, "Write what was found to this file");
  program.add_flag("--keep-going", options.keep_going,
                   fmt::format("Do not end a family after {} wrong answers", kEnoughWrong));
  program.add_flag("--verbose", options.verbose, "Print whole meshes");
  if (const std::optional<int> status = program.parse(argc, argv)) return *status;
  print_whole_meshes(options.verbose);
  return run(options);
}

}  // namespace
}  // namespace boxtree::oracle

int main(int argc, char** argv) {
  try {
    return boxtree::oracle::main_of(argc, argv);
  } catch (const std::exception& error) {
    fmt::print(stderr, "boxtree_exact: {}\n", error.what());
    return 4;
  }
}
