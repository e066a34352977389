// SPDX-License-Identifier: MIT
// A report as data: headings, tables and plots. Written as text for a terminal or as one HTML page
// that needs no network.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "cooker/report/plot.h"

namespace boxtree::cooker {

/// Cells are text. The first columns hold words and are left-aligned, the others hold numbers.
struct PageTable {
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
  std::size_t word_columns = 1;
};

/// A paragraph that explains figures, with its main point first.
struct PageConclusion {
  std::string lead;
  std::string text;
  std::string command = {};  // that makes what it speaks of; empty if none does
};

struct PageSection {
  std::string title;
  std::string text;  // what it shows and how to read it
  std::vector<PageTable> tables;
  std::vector<PagePlot> plots;
  std::vector<PageBars> bars = {};
  std::vector<PageConclusion> conclusions = {};  // before the tables
  std::string notes = {};                        // behind all, on the HTML page alone
};

struct Page {
  std::string title;
  std::string text;
  std::vector<PageSection> sections;
};

[[nodiscard]] std::string to_text(const Page& page);
[[nodiscard]] std::string to_html(const Page& page);

}  // namespace boxtree::cooker
