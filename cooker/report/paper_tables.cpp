// SPDX-License-Identifier: MIT
// One function per table of the paper, in the paper's order.
#include "cooker/report/paper_tables.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace boxtree::cooker {
namespace {

using Row = std::vector<std::string>;

std::string number(double value, int digits = 2) {
  return fmt::format("{:.{}f}", value, digits);
}
std::string count(double value) {
  return value < 1e15 ? fmt::format("{:.0f}", value) : fmt::format("{:.2e}", value);
}
std::string percent(double share) {
  return fmt::format("{:.1f} %", 100 * share);
}
std::string bytes_each(double bytes, const PaperFigures& mesh) {
  return number(bytes / static_cast<double>(mesh.triangles));
}

PageSection implicit_indexing(const PaperReport& report) {
  PageTable table{{"mesh", "depth", "slots", "used slots", "bytes now", "bytes without indices"},
                  {}};
  for (const PaperFigures& mesh : report.meshes) {
    table.rows.push_back({mesh.mesh, std::to_string(mesh.depth), count(mesh.counted.implicit_slots),
                          std::to_string(mesh.merged_nodes),
                          count(mesh.codec(CodecId::kPlainF16).exact),
                          count(mesh.counted.implicit)});
  }
  table.rows.push_back({"the paper", "31 to 54", "2.15e9 to 1.80e16", "7419 to 772783",
                        "116 KB to 12 MB", "17 GB to 144 PB"});
  return {
      "Table 2.2: children at computed places",
      "A tree without indices needs a slot for every node that a perfect tree of its depth would "
      "have. The bytes now are those of plain-f16.",
      {table},
      {}};
}

PageSection merged_nodes(const PaperReport& report) {
  PageTable table{{"mesh", "original nodes", "merged nodes", "merged / original", "shrink nodes",
                   "two leaves", "left leaf", "right leaf", "no leaves"},
                  {}};
  for (const PaperFigures& mesh : report.meshes) {
    Row row = {
        mesh.mesh, std::to_string(mesh.original_nodes), std::to_string(mesh.merged_nodes),
        number(static_cast<double>(mesh.merged_nodes) / static_cast<double>(mesh.original_nodes)),
        percent(static_cast<double>(mesh.shrink_nodes) / static_cast<double>(mesh.merged_nodes))};
    for (const std::uint32_t kind : mesh.kinds) row.push_back(std::to_string(kind));
    table.rows.push_back(row);
  }
  table.rows.push_back({"the paper", "2510 to 1172783", "1628 to 772783", "0.64 to 0.66",
                        "42 to 48 % (implied)", "", "", "", ""});
  return {"Table A.2: nodes before and after leaves move into their parents",
          "Original nodes count leaves as nodes of their own.",
          {table},
          {}};
}

PageSection unique_floats(const PaperReport& report) {
  PageTable table{{"mesh", "cuts", "unique", "share", "dedup saves over packed-f32"}, {}};
  PagePlot plot{"unique cuts, % of all", "bytes that dedup saves over packed-f32, %", {}};
  PagePlot::Series ours{"these meshes", {}};
  for (const PaperFigures& mesh : report.meshes) {
    const double saving =
        1 - mesh.codec(CodecId::kDedup).exact / mesh.codec(CodecId::kPackedF32).exact;
    table.rows.push_back({mesh.mesh, std::to_string(mesh.cuts), std::to_string(mesh.unique_cuts),
                          percent(mesh.unique_share()), percent(saving)});
    ours.points.push_back({100 * mesh.unique_share(), 100 * saving, mesh.mesh});
  }
  table.rows.push_back(
      {"the paper", "3256 to 5351530", "1673 to 650426", "8.2 to 69.9 %", "-11.5 to 22.8 %"});
  // Tables A.1 and A.4 of the paper: 1 - optimal dedup size / optimal f32 size.
  plot.series = {ours,
                 {"the paper",
                  {{69.94, 100 * (1 - 97.0 / 87), "ATST-4252"},
                   {27.90, 100 * (1 - 3189.0 / 3560), "ATST-152944"},
                   {34.13, 100 * (1 - 262.0 / 308), "Castle-14871"},
                   {8.20, 100 * (1 - 8041.0 / 10413), "Raptor-400000"}}}};
  return {
      "Table A.1: unique cuts, and what a table of them saves",
      "Only exact widths are compared. Where a table would cost more than it saves, dedup keeps "
      "cuts in the nodes and saves nothing; the paper's first model has the table all the same.",
      {table},
      {plot}};
}

PageSection sizes(const PaperReport& report) {
  const std::array<std::pair<CodecId, const char*>, kCodecs.size()> columns = {
      {{CodecId::kPlainF32, ""},
       {CodecId::kPlainF16, "26.9 to 30.9"},
       {CodecId::kPackedF16, "14.7 to 18.9"},
       {CodecId::kPackedF32, "21.5 to 26.7"},
       {CodecId::kDedup, "19.3 to 23.8"},
       {CodecId::kPackedF64, ""},
       {CodecId::kWide8, ""},
       {CodecId::kWide4, ""}}};
  PageTable table{{"bytes a triangle"}, {}};
  Row paper = {"the paper (estimated)"};
  for (const auto& [codec, range] : columns) {
    table.columns.emplace_back(codec_name(codec));
    paper.emplace_back(range);
  }
  PageTable cost{{"estimated over exact", "packed-f16", "packed-f32", "packed-f64", "dedup",
                  "packed-f16 below plain-f16"},
                 {}};
  for (const PaperFigures& mesh : report.meshes) {
    Row exact = {mesh.mesh + ", exact"};
    Row estimated = {mesh.mesh + ", estimated"};
    for (const auto& [codec, range] : columns) {
      exact.push_back(bytes_each(mesh.codec(codec).exact, mesh));
      estimated.push_back(bytes_each(mesh.codec(codec).estimated, mesh));
    }
    table.rows.push_back(exact);
    table.rows.push_back(estimated);
    const auto over = [&](CodecId codec) {
      return percent(mesh.codec(codec).estimated / mesh.codec(codec).exact - 1);
    };
    cost.rows.push_back({mesh.mesh, over(CodecId::kPackedF16), over(CodecId::kPackedF32),
                         over(CodecId::kPackedF64), over(CodecId::kDedup),
                         percent(1 - mesh.codec(CodecId::kPackedF16).exact /
                                         mesh.codec(CodecId::kPlainF16).exact)});
  }
  table.rows.push_back(paper);
  cost.rows.push_back(
      {"the paper", "0 to 6.9 %", "0 to 4.6 %", "", "1.0 to 15.8 %", "38.8 to 50 %"});
  return {
      "Tables A.3 and A.4: sizes of all encodings",
      "Nodes alone. Widths of fields from the finished tree (exact), or from the number of faces "
      "before there is a tree (estimated). wide8 and wide4 are ours, on splits of their own.",
      {table, cost},
      {}};
}

PageSection whole_compression(const PaperReport& report) {
  PageTable table{{"mesh", "encoding", "file, B/tri", "nodes alone, B/tri", "resident, B/tri",
                   "to the first answer, us"},
                  {},
                  2};
  for (const PaperFigures& mesh : report.meshes) {
    table.rows.push_back({mesh.mesh, "plain-f32, mapped", bytes_each(mesh.mapped_file_bytes, mesh),
                          bytes_each(mesh.codec(CodecId::kPlainF32).exact, mesh), "pages touched",
                          number(mesh.mapped_open_us, 1)});
    for (const BlobSizes& blob : mesh.blobs) {
      table.rows.push_back({mesh.mesh, blob.name, bytes_each(blob.file_bytes, mesh),
                            bytes_each(blob.tree_bytes, mesh),
                            bytes_each(blob.resident_bytes, mesh), number(blob.open_us, 1)});
    }
  }
  return {"Table 3.1: traditional compression, in numbers",
          "The paper lists pros and cons of compressing the whole tree; here they are measured, "
          "geometry included in file and resident size.",
          {table},
          {}};
}

PageSection counted_sizes(const PaperReport& report) {
  PageTable table{{"bytes a triangle", "packed-f16", "3.2: 1, 2, 4-byte fields", "the same, f32",
                   "3.2.1: own size each", "5.3: branching 4", "branching 8",
                   "one-cut shrink nodes", "against two-cut"},
                  {}};
  for (const PaperFigures& mesh : report.meshes) {
    const CountedSizes& sizes = mesh.counted;
    table.rows.push_back(
        {mesh.mesh, bytes_each(mesh.codec(CodecId::kPackedF16).exact, mesh),
         bytes_each(sizes.whole_bytes_f16, mesh), bytes_each(sizes.whole_bytes_f32, mesh),
         bytes_each(sizes.own_sizes, mesh), bytes_each(sizes.branching4, mesh),
         bytes_each(sizes.branching8, mesh), bytes_each(sizes.one_cut_shrink, mesh),
         percent(sizes.one_cut_shrink / sizes.two_cut_shrink - 1)});
  }
  return {
      "Layouts that the paper considers and rejects, by counting",
      "Sizes of nodes as they would be: fields of whole bytes (3.2), each node as small as its own "
      "numbers allow (3.2.1, not addressable by number), two or three levels in one node (5.3), "
      "and shrink nodes with their one useful cut and number.",
      {table},
      {}};
}

PageSection rounding(const PaperReport& report) {
  PageTable table{{"aligned contact", "queries", "pairs, f32", "missed, f16 to nearest",
                   "missed, f16 outward", "boxes escaped, nearest", "outward"},
                  {}};
  for (const PaperFigures& mesh : report.meshes) {
    const RoundingFigures& figures = mesh.rounding;
    const auto missed = [&](std::uint64_t found) {
      const auto all = static_cast<double>(figures.pairs_f32);
      const double share = all > 0 ? (all - static_cast<double>(found)) / all : 0;
      return fmt::format("{} ({})", figures.pairs_f32 - found, percent(share));
    };
    table.rows.push_back({mesh.mesh, std::to_string(figures.queries),
                          std::to_string(figures.pairs_f32), missed(figures.pairs_nearest),
                          missed(figures.pairs_outward),
                          std::to_string(figures.gates_nearest.escapes),
                          std::to_string(figures.gates_outward.escapes)});
  }
  PageTable stairs{
      {"box resting on a stair, depth", "steps", "missed, f32", "f16 to nearest", "f16 outward"},
      {}};
  for (const StairFigures& row : report.stairs) {
    stairs.rows.push_back({fmt::format("{:g}", row.depth), std::to_string(row.steps),
                           std::to_string(row.missed_f32), std::to_string(row.missed_nearest),
                           std::to_string(row.missed_outward)});
  }
  return {
      "f16 rounding: to nearest against outward",
      "The same tree, its cuts rounded two ways. A cut rounded to nearest can take away a part of "
      "the box that holds something; contacts there are missed. Such a tree fails its gates and "
      "is never offered.",
      {table, stairs},
      {}};
}

const PeerRow* find(const PaperReport& report, const std::string& mesh, const std::string& library,
                    const std::string& variant, const std::string& metric) {
  for (const PeerRow& row : report.peers) {
    if (row.mesh == mesh && row.library == library && row.variant == variant &&
        row.metric == metric) {
      return &row;
    }
  }
  return nullptr;
}

// The variants in the paper's tables; boxtree's are named by codec.
constexpr std::array<std::pair<const char*, const char*>, 10> kVariants = {
    {{"original", "pointers"},
     {"boxtree", "plain-f32"},
     {"boxtree", "plain-f16"},
     {"boxtree", "packed-f16"},
     {"boxtree", "packed-f32"},
     {"boxtree", "packed-f64"},
     {"boxtree", "dedup"},
     {"boxtree", "wide8"},
     {"boxtree", "wide4"},
     {"fcl", "kdop18"}}};

std::string cell(const PeerRow* row, int digits = 1) {
  return row == nullptr ? "-" : number(row->value, digits);
}

PageSection times(const PaperReport& report) {
  PageSection section{
      "Table A.6: time against the original",
      "Protocol: the mesh tumbling beside its copy at 20 distances, all in one run. Times mean "
      "nothing without what was found and done: node pairs and leaf tests are counted on the walk.",
      {},
      {}};
  for (const char* kind : {"first", "all"}) {
    PageTable table{
        {std::string(kind) + (kind[0] == 'f' ? " contact" : " pairs"), "encoding", "poses", "us",
         "of original", "found", "node pairs", "leaf tests", "the paper"},
        {},
        2};
    const std::string prefix = std::string("tumble_") + kind + "_";
    for (const PaperFigures& mesh : report.meshes) {
      const PeerRow* original = find(report, mesh.mesh, "original", "pointers", prefix + "us");
      for (const auto& [library, variant] : kVariants) {
        const PeerRow* time = find(report, mesh.mesh, library, variant, prefix + "us");
        if (time == nullptr) continue;
        const auto get = [&, library = library, variant = variant](const char* what) {
          return find(report, mesh.mesh, library, variant, prefix + what);
        };
        const std::string codec = variant;
        table.rows.push_back({mesh.mesh,
                              library == std::string("boxtree") ? codec : library + (" " + codec),
                              cell(get("queries"), 0), cell(time),
                              original == nullptr ? "-" : number(time->value / original->value),
                              cell(get(kind[0] == 'f' ? "hits" : "pairs"), 0),
                              cell(get("node_pairs")), cell(get("leaf_tests")),
                              codec == "plain-f16"    ? "1.06 to 1.13"
                              : codec == "packed-f16" ? "1.57 to 1.68"
                              : codec == "dedup"      ? "1.53 to 1.58"
                                                      : ""});
      }
    }
    section.tables.push_back(table);
  }
  return section;
}

PageSection cache_misses(const PaperReport& report) {
  PageSection section{"Table A.7: cache misses", "", {}, {}};
  const bool counted_by_processor =
      std::any_of(report.peers.begin(), report.peers.end(),
                  [](const PeerRow& row) { return row.metric == "tumble_all_cache_misses"; });
  section.text =
      counted_by_processor
          ? "Misses a query, all pairs: counted by the processor, and simulated for the first two "
            "levels of the paper's machine (i5-8250U: 32 and 256 KiB), fed with the nodes and the "
            "geometry that are read."
          : "Misses a query, all pairs. This kernel gives no counters, so all are simulated: the "
            "first "
            "two levels of the paper's machine (i5-8250U: 32 and 256 KiB), fed with the nodes and "
            "the geometry that are read.";
  PageTable table{{"mesh", "encoding", "processor", "level 1, simulated", "level 2, simulated",
                   "level 2, of original", "the paper, of original"},
                  {},
                  2};
  for (const PaperFigures& mesh : report.meshes) {
    const PeerRow* original =
        find(report, mesh.mesh, "original", "pointers", "tumble_all_level2_misses");
    for (const auto& [library, variant] : kVariants) {
      const auto get = [&, library = library, variant = variant](const char* metric) {
        return find(report, mesh.mesh, library, variant, metric);
      };
      const PeerRow* level2 = get("tumble_all_level2_misses");
      if (level2 == nullptr) continue;
      const std::string codec = variant;
      table.rows.push_back(
          {mesh.mesh, library == std::string("boxtree") ? codec : std::string(library),
           cell(get("tumble_all_cache_misses")), cell(get("tumble_all_level1_misses")),
           cell(level2),
           original == nullptr || original->value == 0 ? "-"
                                                       : number(level2->value / original->value),
           codec == "packed-f16" ? "0.44 to 0.86"
           : codec == "dedup"    ? "0.46 to 0.99"
                                 : ""});
    }
  }
  section.tables.push_back(table);
  return section;
}

}  // namespace

Page paper_page(const PaperReport& report) {
  Page page;
  page.title = "Compression of the BoxTree data structure: its tables, redrawn";
  page.text = "By the paper's builder. Made by: " + report.command;
  page.sections = {
      implicit_indexing(report), merged_nodes(report),  unique_floats(report), sizes(report),
      whole_compression(report), counted_sizes(report), rounding(report)};
  if (report.peers.empty()) {
    page.sections.push_back(
        {"Tables A.6 and A.7: time and cache misses against the original",
         "Left out: the program that measures them, boxtree_peers, was not found or not wanted.",
         {},
         {}});
  } else {
    page.sections.push_back(times(report));
    page.sections.push_back(cache_misses(report));
  }
  return page;
}

}  // namespace boxtree::cooker
