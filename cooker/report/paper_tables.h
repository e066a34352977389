// SPDX-License-Identifier: MIT
// The tables of the paper with measured figures; each row has the paper's own range.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cooker/report/page.h"
#include "cooker/report/paper_figures.h"

namespace boxtree::cooker {

/// One measurement of a program that runs the original and other libraries.
struct PeerRow {
  std::string mesh;
  std::string library;
  std::string variant;
  std::string metric;
  double value = 0;
  std::string unit;
};

/// All data of a paper report.
struct PaperReport {
  std::vector<PaperFigures> meshes;
  std::vector<StairFigures> stairs;
  std::vector<PeerRow> peers;  // empty: tables of times state that they are omitted
  std::string command;         // that made it
};

[[nodiscard]] Page paper_page(const PaperReport& report);

}  // namespace boxtree::cooker
