// SPDX-License-Identifier: MIT
// All data of a tradeoff report, and its JSON and CSV.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cooker/report/paper_tables.h"
#include "cooker/report/tradeoff.h"

namespace boxtree::cooker {

/// The machine and program that made the figures.
struct Surroundings {
  std::string processor;
  std::string instruction_set;  // by which the wide codecs are walked
  std::string threads;          // of the machine; the figures are for one
  std::string system;
  std::string compiler;
  std::string version;  // of boxtree
  std::string load;     // other work on the machine when measuring began; empty if unknown
  std::string command;
};

/// Those of this machine and this program.
[[nodiscard]] Surroundings surroundings(const std::string& command);

/// One result of another program.
struct IncludedRow {
  std::string id;
  std::string what;
  std::string figure;
  std::string limit;
  std::string pass;
};

/// Results of another program, shown in a separate section.
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
/// only the array of rows. Numbers and booleans become text; missing values are empty. Errors:
/// kFileNotFound; kFileUnreadable; kDocumentInvalid for another document, or one without rows.
Result<IncludedResults> read_results(const std::filesystem::path& path);

[[nodiscard]] std::string to_json(const TradeoffReport& report);

/// One row per point, all figures in one table; lengths as shares of the diagonal.
[[nodiscard]] std::string to_csv(const TradeoffReport& report);

/// One row per setting of approximate queries: encoding, kind, limits, costs and errors.
[[nodiscard]] std::string approximate_to_csv(const TradeoffReport& report);

}  // namespace boxtree::cooker
