// SPDX-License-Identifier: MIT
// Everything a tradeoff report shows, and the same as JSON and CSV.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cooker/report/paper_tables.h"
#include "cooker/report/tradeoff.h"

namespace boxtree::cooker {

/// Where and how figures came about.
struct Surroundings {
  std::string processor;
  std::string threads;  // of the machine; the figures are of one
  std::string system;
  std::string compiler;
  std::string version;  // of boxtree
  std::string load;     // other work on the machine when measuring began; empty if unknown
  std::string command;
};

/// Of this machine and this program.
[[nodiscard]] Surroundings surroundings(const std::string& command);

/// One result of another program's checks.
struct IncludedRow {
  std::string id;
  std::string what;
  std::string figure;
  std::string limit;
  std::string pass;
};

/// Results of another program: a section of their own.
struct IncludedResults {
  std::string title;
  std::string text;
  std::vector<IncludedRow> rows;
};

struct TradeoffReport {
  std::vector<MeshTradeoff> meshes;
  std::vector<PeerRow> peers;  // of the same meshes; may be empty
  std::vector<IncludedResults> included;
  Surroundings surroundings;
  bool quick = false;
  std::string no_peers;  // why there are none
};

/// Reads {"title": ..., "text": ..., "rows": [{"id", "what", "figure", "limit", "pass"}, ...]} or
/// the array of rows alone; numbers and truth values become text, what is missing stays empty.
/// Errors: kFileNotFound; kFileUnreadable, also when it is no such document.
Result<IncludedResults> read_results(const std::filesystem::path& path);

[[nodiscard]] std::string to_json(const TradeoffReport& report);

/// One row a point, all figures in one table; lengths as shares of the diagonal.
[[nodiscard]] std::string to_csv(const TradeoffReport& report);

/// One row a setting of approximate queries: encoding, kind, what was allowed, costs and errors.
[[nodiscard]] std::string approximate_to_csv(const TradeoffReport& report);

}  // namespace boxtree::cooker
