// SPDX-License-Identifier: MIT
// Writes the same data as text and HTML. The page follows the reader's light or dark setting, can
// be printed, and scrolls wide tables in narrow windows.
#include "cooker/report/page.h"

#include <algorithm>

#include <fmt/format.h>

namespace boxtree::cooker {
namespace {

// Eight colours, each with enough contrast on its background, in light and in dark.
constexpr const char* kStyle = R"(
:root{color-scheme:light dark;--ink:#1c2024;--faint:#60646c;--line:#d9d9e0;--back:#fff;--well:#f4f5f7;
--c0:#0b68cb;--c1:#c2410c;--c2:#15803d;--c3:#7e22ce;--c4:#b4820a;--c5:#0e7490;--c6:#be185d;--c7:#57606a}
@media (prefers-color-scheme:dark){:root{--ink:#edeef0;--faint:#b0b4ba;--line:#43484e;--back:#111113;
--well:#1b1c1f;--c0:#70b8ff;--c1:#ff9592;--c2:#71d083;--c3:#d19dff;--c4:#f5d90a;--c5:#4ccce6;--c6:#ff8dcc;
--c7:#a5adb8}}
*{box-sizing:border-box}
body{font:16px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--back);max-width:72rem;
margin:0 auto;padding:1rem;overflow-wrap:break-word}
h1{font-size:1.6rem;line-height:1.25}h2{font-size:1.2rem;margin-top:2.5rem}
p{max-width:46rem}.faint{color:var(--faint)}
.conclusion{background:var(--well);border-left:4px solid var(--c0);padding:.5rem .9rem;margin:.6rem 0}
.scroll{overflow-x:auto}code{font:.9rem ui-monospace,monospace}
code span{display:inline-block;max-width:100%}
table{border-collapse:collapse;font-variant-numeric:tabular-nums;font-size:.9rem;margin:1rem 0}
th,td{padding:.25rem .6rem;border-bottom:1px solid var(--line);text-align:right;white-space:nowrap}
th{color:var(--faint);font-weight:600;vertical-align:bottom;white-space:normal}
th.word,td.word{text-align:left}
.plots{display:grid;grid-template-columns:repeat(auto-fit,minmax(min(100%,30rem),1fr));gap:1.2rem}
figure{margin:0;min-width:0}figcaption{font-weight:600}
svg{display:block;width:100%;min-width:27rem;max-width:44rem;height:auto}
svg text{fill:var(--ink);font:12px system-ui,sans-serif}
svg .band{fill:var(--well)}svg .grid{stroke:var(--line);fill:none}
svg .line{fill:none;stroke-width:1.6}svg .front{stroke-width:2.5;stroke-dasharray:6 4;opacity:.55}
@media print{body{max-width:none;font-size:11px}h1{font-size:20px}h2{font-size:15px;break-after:avoid}
p{max-width:none}.conclusion,figure,tr{break-inside:avoid}.scroll{overflow:visible}svg{min-width:0}
.plots{grid-template-columns:1fr 1fr}table{font-size:8px}th,td{padding:1px 3px}}
)";

void add_html(const PageTable& table, std::string& out) {
  out += "<div class=\"scroll\"><table><thead><tr>";
  const auto add_cells = [&](const char* tag, const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const char* const alignment = i < table.word_columns ? " class=\"word\"" : "";
      out += fmt::format("<{0}{1}>{2}</{0}>", tag, alignment, escaped(cells[i]));
    }
  };
  add_cells("th", table.columns);
  out += "</tr></thead><tbody>\n";
  for (const auto& row : table.rows) {
    out += "<tr>";
    add_cells("td", row);
    out += "</tr>\n";
  }
  out += "</tbody></table></div>\n";
}

// A drawing with its title; in narrow windows it scrolls instead of shrinking.
void add_figure(const std::string& title, const std::string& drawing, std::string& out) {
  if (drawing.empty()) return;
  out += "<figure>";
  if (!title.empty()) out += "<figcaption>" + escaped(title) + "</figcaption>\n";
  out += "<div class=\"scroll\">" + drawing + "</div></figure>\n";
}

void add_text(const PageTable& table, std::string& out) {
  std::vector<std::size_t> widths;
  for (const std::string& column : table.columns) widths.push_back(column.size());
  for (const auto& row : table.rows) {
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  const auto add_row = [&](const std::vector<std::string>& cells) {
    for (std::size_t i = 0; i < cells.size(); ++i) {
      out += i < table.word_columns ? fmt::format("  {:<{}}", cells[i], widths[i])
                                    : fmt::format("  {:>{}}", cells[i], widths[i]);
    }
    out += '\n';
  };
  add_row(table.columns);
  for (const auto& row : table.rows) add_row(row);
}

// Its words are broken into lines between them alone: browsers also break after hyphens, and
// "--grid-bits" is not found again if it is pasted in two parts.
std::string words_of(const std::string& command) {
  std::string out = "<span>";
  for (const char c : escaped(command)) {
    if (c == ' ')
      out += "</span> <span>";
    else
      out += c;
  }
  return out + "</span>";
}

}  // namespace

std::string to_text(const Page& page) {
  std::string out = page.title + "\n" + page.text + "\n";
  for (const PageSection& section : page.sections) {
    out += "\n" + section.title + "\n";
    if (section.tables.empty() && !section.text.empty()) out += "  " + section.text + "\n";
    for (const PageConclusion& conclusion : section.conclusions) {
      out += "  " + conclusion.lead + " " + conclusion.text + "\n";
      if (!conclusion.command.empty()) out += "    In the folder of the mesh: " + conclusion.command + "\n";
    }
    for (const PageTable& table : section.tables) add_text(table, out);
  }
  return out;
}

std::string to_html(const Page& page) {
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"generator\" content=\"boxtree report\">\n"  // see check_replaced()
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
      "<title>{0}</title><style>{1}</style></head><body>\n<h1>{0}</h1>\n<p "
      "class=\"faint\">{2}</p>\n",
      escaped(page.title), kStyle, escaped(page.text));
  for (const PageSection& section : page.sections) {
    out += "<h2>" + escaped(section.title) + "</h2>\n";
    if (!section.text.empty()) out += "<p>" + escaped(section.text) + "</p>\n";
    for (const PageConclusion& conclusion : section.conclusions) {
      out += "<p class=\"conclusion\"><strong>" + escaped(conclusion.lead) + "</strong> " +
             escaped(conclusion.text);
      if (!conclusion.command.empty()) {
        out += "<br/>In the folder of the mesh: <code>" + words_of(conclusion.command) + "</code>";
      }
      out += "</p>\n";
    }
    for (const PageTable& table : section.tables) add_html(table, out);
    if (!section.plots.empty() || !section.bars.empty()) {
      out += "<div class=\"plots\">\n";
      for (const PagePlot& plot : section.plots) add_figure(plot.title, to_svg(plot), out);
      for (const PageBars& bars : section.bars) add_figure(bars.title, to_svg(bars), out);
      out += "</div>\n";
    }
    if (!section.notes.empty()) {
      out += "<p class=\"faint\">" + escaped(section.notes) + "</p>\n";
    }
  }
  return out + "</body></html>\n";
}

}  // namespace boxtree::cooker
