// SPDX-License-Identifier: MIT
// Text and HTML from the same data. The page follows the reader's light or dark setting, prints,
// and lets wide tables scroll on narrow windows.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include <boxtree/cooker/report/page.h>

namespace boxtree::cooker {
namespace {

constexpr const char* kStyle = R"(
:root{color-scheme:light dark;--ink:#1c2024;--faint:#60646c;--line:#d9d9e0;--back:#fff;
--c0:#0b68cb;--c1:#c2410c;--c2:#15803d;--c3:#7e22ce}
@media (prefers-color-scheme:dark){:root{--ink:#edeef0;--faint:#b0b4ba;--line:#43484e;--back:#111113;
--c0:#70b8ff;--c1:#ff9592;--c2:#71d083;--c3:#d19dff}}
body{font:16px/1.5 system-ui,sans-serif;color:var(--ink);background:var(--back);max-width:70rem;
margin:0 auto;padding:1rem}
h1{font-size:1.6rem}h2{font-size:1.2rem;margin-top:2.5rem}
p{max-width:46rem}.faint{color:var(--faint)}
.scroll{overflow-x:auto}
table{border-collapse:collapse;font-variant-numeric:tabular-nums;font-size:.9rem;margin:1rem 0}
th,td{padding:.25rem .6rem;border-bottom:1px solid var(--line);text-align:right;white-space:nowrap}
th{color:var(--faint);font-weight:600;vertical-align:bottom}
th.word,td.word{text-align:left}
svg{max-width:100%;height:auto}svg text{fill:var(--ink);font:12px system-ui,sans-serif}
svg .axis{stroke:var(--faint)}svg .grid{stroke:var(--line)}
@media print{body{max-width:none}h2{break-after:avoid}.scroll{overflow:visible}}
)";

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

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

// One axis of a plot: its range, widened a little, in steps a person would choose.
struct Axis {
  double low = 0;
  double high = 1;
  double step = 1;
};

Axis axis_of(double low, double high) {
  constexpr double kTicks = 6;
  if (!(high > low)) high = low + 1;
  const double raw = (high - low) / kTicks;
  const double power = std::pow(10, std::floor(std::log10(raw)));
  double step = 10 * power;
  for (const double nice : {1.0, 2.0, 5.0}) {
    if (nice * power >= raw) {
      step = nice * power;
      break;
    }
  }
  return {std::floor(low / step) * step, std::ceil(high / step) * step, step};
}

constexpr double kWidth = 640;
constexpr double kHeight = 400;
constexpr double kLeft = 70;
constexpr double kBottom = 50;
constexpr double kTop = 40;
constexpr double kRight = 110;  // room for labels of points at the edge

void add_mark(std::size_t shape, double x, double y, const std::string& fill, std::string& out) {
  switch (shape) {
    case 0:
      out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"5\" fill=\"{}\"/>", x, y, fill);
      break;
    case 1:
      out += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"9\" height=\"9\" fill=\"{}\"/>",
                         x - 4.5, y - 4.5, fill);
      break;
    default:
      out += fmt::format("<path d=\"M{:.1f} {:.1f}l6 10h-12z\" fill=\"{}\"/>", x, y - 6, fill);
  }
}

void add_html(const PagePlot& plot, std::string& out) {
  std::vector<double> xs;
  std::vector<double> ys;
  for (const auto& series : plot.series) {
    for (const auto& point : series.points) {
      xs.push_back(point.x);
      ys.push_back(point.y);
    }
  }
  if (xs.empty()) return;
  const auto [x_low, x_high] = std::minmax_element(xs.begin(), xs.end());
  const auto [y_low, y_high] = std::minmax_element(ys.begin(), ys.end());
  const Axis x_axis = axis_of(*x_low, *x_high);
  const Axis y_axis = axis_of(*y_low, *y_high);
  const auto to_x = [&](double x) {
    return kLeft + (x - x_axis.low) / (x_axis.high - x_axis.low) * (kWidth - kLeft - kRight);
  };
  const auto to_y = [&](double y) {
    return kHeight - kBottom -
           (y - y_axis.low) / (y_axis.high - y_axis.low) * (kHeight - kBottom - kTop);
  };
  out += fmt::format(
      "<svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" role=\"img\" aria-label=\"{2} over {3}\">\n",
      kWidth, kHeight, escaped(plot.y_title), escaped(plot.x_title));
  const auto ticks = [](const Axis& axis) {
    return static_cast<int>(std::lround((axis.high - axis.low) / axis.step));
  };
  for (int i = 0; i <= ticks(x_axis); ++i) {
    const double value = x_axis.low + i * x_axis.step;
    out += fmt::format(
        "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
        "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4:g}</text>\n",
        to_x(value), kTop, kHeight - kBottom, kHeight - kBottom + 18, value);
  }
  for (int i = 0; i <= ticks(y_axis); ++i) {
    const double value = y_axis.low + i * y_axis.step;
    out += fmt::format(
        "<line class=\"grid\" x1=\"{1}\" x2=\"{2}\" y1=\"{0:.1f}\" y2=\"{0:.1f}\"/>"
        "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:g}</text>\n",
        to_y(value), kLeft, kWidth - kRight, kLeft - 8, to_y(value) + 4, value);
  }
  out += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
                     (kLeft + kWidth - kRight) / 2, kHeight - 10, escaped(plot.x_title));
  out += fmt::format(
      "<text transform=\"rotate(-90)\" x=\"{}\" y=\"16\" text-anchor=\"middle\">{}</text>\n",
      -(kTop + kHeight - kBottom) / 2, escaped(plot.y_title));
  double legend = kLeft;
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    const std::string colour = fmt::format("var(--c{})", s);
    add_mark(s, legend + 6, 18, colour, out);
    out += fmt::format("<text x=\"{:.1f}\" y=\"22\">{}</text>\n", legend + 16,
                       escaped(plot.series[s].name));
    legend += 40 + 7.0 * static_cast<double>(plot.series[s].name.size());
    for (const auto& point : plot.series[s].points) {
      add_mark(s, to_x(point.x), to_y(point.y), colour, out);
      out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", to_x(point.x) + 9,
                         to_y(point.y) + 4, escaped(point.label));
    }
  }
  out += "</svg>\n";
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

}  // namespace

std::string to_text(const Page& page) {
  std::string out = page.title + "\n" + page.text + "\n";
  for (const PageSection& section : page.sections) {
    out += "\n" + section.title + "\n";
    if (section.tables.empty()) out += "  " + section.text + "\n";
    for (const PageTable& table : section.tables) add_text(table, out);
  }
  return out;
}

std::string to_html(const Page& page) {
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width,initial-scale=1\">\n"
      "<title>{0}</title><style>{1}</style></head><body>\n<h1>{0}</h1>\n<p "
      "class=\"faint\">{2}</p>\n",
      escaped(page.title), kStyle, escaped(page.text));
  for (const PageSection& section : page.sections) {
    out += "<h2>" + escaped(section.title) + "</h2>\n<p>" + escaped(section.text) + "</p>\n";
    for (const PageTable& table : section.tables) add_html(table, out);
    for (const PagePlot& plot : section.plots) add_html(plot, out);
  }
  return out + "</body></html>\n";
}

}  // namespace boxtree::cooker
