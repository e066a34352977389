// SPDX-License-Identifier: MIT
// One plot: axes in steps a person would choose, a legend above, marks or lines.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <boxtree/cooker/report/markup.h>
#include <boxtree/cooker/report/plot.h>

namespace boxtree::cooker {
namespace {

// One axis of a plot: its range, widened a little, in steps a person would choose.
struct Axis {
  double low = 0;
  double high = 1;
  double step = 1;

  [[nodiscard]] int ticks() const { return static_cast<int>(std::lround((high - low) / step)); }
  // A multiple of the step, so that zero is zero.
  [[nodiscard]] double tick(int i) const { return step * (std::round(low / step) + i); }
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

constexpr const char* kDashes[] = {"none", "7 4", "2 3", "9 3 2 3"};

// Where values lie on the drawing.
struct PlotFrame {
  Axis x;
  Axis y;

  [[nodiscard]] double to_x(double value) const {
    return kLeft + (value - x.low) / (x.high - x.low) * (kWidth - kLeft - kRight);
  }
  [[nodiscard]] double to_y(double value) const {
    return kHeight - kBottom - (value - y.low) / (y.high - y.low) * (kHeight - kBottom - kTop);
  }
};

void add_axes(const PagePlot& plot, const PlotFrame& frame, std::string& out) {
  for (int i = 0; i <= frame.x.ticks(); ++i) {
    const double value = frame.x.tick(i);
    out += fmt::format(
        "<line class=\"grid\" x1=\"{0:.1f}\" x2=\"{0:.1f}\" y1=\"{1}\" y2=\"{2}\"/>"
        "<text x=\"{0:.1f}\" y=\"{3}\" text-anchor=\"middle\">{4:g}</text>\n",
        frame.to_x(value), kTop, kHeight - kBottom, kHeight - kBottom + 18, value);
  }
  for (int i = 0; i <= frame.y.ticks(); ++i) {
    const double value = frame.y.tick(i);
    out += fmt::format(
        "<line class=\"grid\" x1=\"{1}\" x2=\"{2}\" y1=\"{0:.1f}\" y2=\"{0:.1f}\"/>"
        "<text x=\"{3}\" y=\"{4:.1f}\" text-anchor=\"end\">{5:g}</text>\n",
        frame.to_y(value), kLeft, kWidth - kRight, kLeft - 8, frame.to_y(value) + 4, value);
  }
  out += fmt::format("<text x=\"{}\" y=\"{}\" text-anchor=\"middle\">{}</text>\n",
                     (kLeft + kWidth - kRight) / 2, kHeight - 10, escaped(plot.x_title));
  out += fmt::format(
      "<text transform=\"rotate(-90)\" x=\"{}\" y=\"16\" text-anchor=\"middle\">{}</text>\n",
      -(kTop + kHeight - kBottom) / 2, escaped(plot.y_title));
}

void add_line(const PagePlot::Series& series, std::size_t number, const PlotFrame& frame,
              std::string& out) {
  out += fmt::format(
      "<polyline fill=\"none\" stroke=\"var(--c{})\" stroke-width=\"2\" stroke-dasharray=\"{}\" "
      "points=\"",
      number, kDashes[number]);
  for (const auto& point : series.points) {
    out += fmt::format("{:.1f},{:.1f} ", frame.to_x(point.x), frame.to_y(point.y));
  }
  out += "\"/>\n";
}

void add_marks(const PagePlot::Series& series, std::size_t number, const PlotFrame& frame,
               std::string& out) {
  for (const auto& point : series.points) {
    add_mark(number, frame.to_x(point.x), frame.to_y(point.y), fmt::format("var(--c{})", number),
             out);
    out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\">{}</text>\n", frame.to_x(point.x) + 9,
                       frame.to_y(point.y) + 4, escaped(point.label));
  }
}

// What the element needs of a page's style sheet.
constexpr const char* kFileStyle =
    "<style>:root{--c0:#0b68cb;--c1:#c2410c;--c2:#15803d;--c3:#7e22ce}"
    "text{fill:#1c2024;font:12px system-ui,sans-serif}.grid{stroke:#d9d9e0}</style>"
    "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";

}  // namespace

std::string to_svg_element(const PagePlot& plot) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Axis x{kInfinity, -kInfinity};
  Axis y = x;
  for (const auto& series : plot.series) {
    for (const auto& point : series.points) {
      x = {std::min(x.low, point.x), std::max(x.high, point.x)};
      y = {std::min(y.low, point.y), std::max(y.high, point.y)};
    }
  }
  if (x.low > x.high) return {};
  const PlotFrame frame{axis_of(x.low, x.high), axis_of(y.low, y.high)};
  std::string out = fmt::format(
      "<svg viewBox=\"0 0 {0} {1}\" width=\"{0}\" role=\"img\" aria-label=\"{2} over {3}\">\n",
      kWidth, kHeight, escaped(plot.y_title), escaped(plot.x_title));
  add_axes(plot, frame, out);
  double legend = kLeft;
  for (std::size_t s = 0; s < plot.series.size(); ++s) {
    const auto& series = plot.series[s];
    double after_key = legend + 16;
    if (plot.lines) {
      constexpr double kKey = 28;
      out += fmt::format(
          "<path d=\"M{:.1f} 18h{}\" stroke=\"var(--c{})\" stroke-width=\"2\" "
          "stroke-dasharray=\"{}\"/>",
          legend, kKey, s, kDashes[s]);
      after_key = legend + kKey + 6;
    } else {
      add_mark(s, legend + 6, 18, fmt::format("var(--c{})", s), out);
    }
    out += fmt::format("<text x=\"{:.1f}\" y=\"22\">{}</text>\n", after_key, escaped(series.name));
    legend = after_key + 24 + 7.0 * static_cast<double>(series.name.size());
    plot.lines ? add_line(series, s, frame, out) : add_marks(series, s, frame, out);
  }
  return out + "</svg>\n";
}

std::string to_svg_file(const PagePlot& plot) {
  std::string svg = to_svg_element(plot);
  svg.insert(svg.find('>') + 2, kFileStyle);
  svg.insert(svg.find("<svg") + 4, " xmlns=\"http://www.w3.org/2000/svg\"");
  return svg;
}

}  // namespace boxtree::cooker
