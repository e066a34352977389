// SPDX-License-Identifier: MIT
// Draws axes with round steps, marks, curves, and labels where there is room.
#include "cooker/report/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

namespace boxtree::cooker {
namespace {

// Size of the drawing in its own units: narrow enough for a telephone.
constexpr double kWidth = 560;
constexpr double kFrameHeight = 300;
constexpr double kLeft = 68;
constexpr double kRight = 24;
constexpr double kBelow = 48;
constexpr double kBand = 90;  // left of a logarithmic axis, for values at zero
constexpr double kLegendLine = 20;
// Visible without scrolling in a window of 390 pixels, where the page draws 432 units.
constexpr double kLegendWidth = 460;
constexpr double kLetter = 6.8;  // mean width of a letter at 12 units, from common sans-serif faces
constexpr double kLineHeight = 12;

struct Tick {
  double value;
  std::string text;
};

// One axis: maps values to 0 to 1, and has the ticks.
class Axis {
 public:
  Axis(const std::vector<double>& values, AxisScale scale) : scale_(scale) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    if (scale == AxisScale::kLinear) {
      choose_linear(*low, *high);
    } else {
      choose_logarithmic(*low, *high);
    }
  }

  [[nodiscard]] double place(double value) const { return (scaled(value) - low_) / (high_ - low_); }
  [[nodiscard]] const std::vector<Tick>& ticks() const { return ticks_; }

 private:
  [[nodiscard]] double scaled(double value) const {
    return scale_ == AxisScale::kLinear ? value : std::log10(value);
  }

  void choose_linear(double low, double high) {
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
    low_ = std::floor(low / step) * step;
    high_ = std::ceil(high / step) * step;
    const auto count = std::lround((high_ - low_) / step);
    for (long i = 0; i <= count; ++i) {
      const double value = low_ + static_cast<double>(i) * step;
      ticks_.push_back({value, fmt::format("{:g}", value)});
    }
  }

  // From one multiple of 1, 2 or 5 to another. Ticks are at all of them, at powers of ten, or at
  // every second power and so on, as there is room.
  void choose_logarithmic(double low, double high) {
    constexpr double kDecadesOfThree = 2.2;  // with three ticks each
    constexpr int kMostTicks = 8;
    constexpr std::array kNice = {1.0, 2.0, 5.0, 10.0};
    const auto decade = [](double value) {
      return static_cast<int>(std::floor(std::log10(value)));
    };
    const auto nice_power = [](double nice, int power) { return nice * std::pow(10, power); };
    double first = nice_power(1, decade(low));
    double last = nice_power(10, decade(high));
    for (const double nice : kNice) {
      if (nice_power(nice, decade(low)) <= low) first = nice_power(nice, decade(low));
    }
    for (auto nice = kNice.rbegin(); nice != kNice.rend(); ++nice) {
      if (nice_power(*nice, decade(high)) >= high) last = nice_power(*nice, decade(high));
    }
    if (!(last > first)) last = 10 * first;
    low_ = std::log10(first);
    high_ = std::log10(last);
    const bool three = high_ - low_ <= kDecadesOfThree;
    const int every = std::max(1, static_cast<int>(std::ceil((high_ - low_) / kMostTicks)));
    for (int power = decade(first); power <= decade(last) + 1; ++power) {
      for (const double nice : {1.0, 2.0, 5.0}) {
        const double value = nice_power(nice, power);
        // Both ends come from the same expression, so this tolerance suffices.
        if (value < first * 0.9999 || value > last * 1.0001) continue;
        if (!three && (nice != 1.0 || power % every != 0)) continue;
        ticks_.push_back({value, text_of(nice, power)});
      }
    }
  }

  static std::string text_of(double nice, int power) {
    if (power >= -2 && power <= 5) return fmt::format("{:g}", nice * std::pow(10, power));
    static constexpr std::array<const char*, 10> kRaised = {"⁰", "¹", "²", "³", "⁴",
                                                            "⁵", "⁶", "⁷", "⁸", "⁹"};
    std::string raised = power < 0 ? "⁻" : "";
    for (const char digit : std::to_string(std::abs(power))) {
      raised += kRaised[static_cast<std::size_t>(digit - '0')];
    }
    return nice == 1.0 ? "10" + raised : fmt::format("{:g}·10{}", nice, raised);
  }

  AxisScale scale_;
  double low_ = 0;
  double high_ = 1;
  std::vector<Tick> ticks_;
};

void add_mark(std::size_t shape, double x, double y, double r, const std::string& colour,
              const std::string& hint, std::string& out) {
  const std::string style = fmt::format("fill=\"{0}\" fill-opacity=\".65\" stroke=\"{0}\"", colour);
  const std::string title = hint.empty() ? "" : "<title>" + escaped(hint) + "</title>";
  switch (shape % 4) {
    case 0:
      out += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{:.1f}\" {}>{}</circle>\n", x, y,
                         r, style, title);
      break;
    case 1:
      out += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" height=\"{:.1f}\" {}>{}</rect>\n",
          x - 0.9 * r, y - 0.9 * r, 1.8 * r, 1.8 * r, style, title);
      break;
    case 2:
      out += fmt::format("<path d=\"M{:.1f} {:.1f}l{:.1f} {:.1f}h{:.1f}z\" {}>{}</path>\n", x,
                         y - 1.2 * r, 1.2 * r, 2 * r, -2.4 * r, style, title);
      break;
    default:
      out += fmt::format(
          "<path d=\"M{0:.1f} {1:.1f}l{2:.1f} {2:.1f}l-{2:.1f} {2:.1f}l-{2:.1f} -{2:.1f}z\" "
          "{3}>{4}</path>\n",
          x, y - 1.2 * r, 1.2 * r, style, title);
  }
}

void add_text(double x, double y, const char* anchor, const std::string& text, std::string& out) {
  out += fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\">{}</text>\n", x, y, anchor,
                     escaped(text));
}

// Counts letters, not bytes: the page is in UTF-8.
double width_of(const std::string& text) {
  const auto letters = std::count_if(text.begin(), text.end(), [](char c) {
    return (static_cast<unsigned char>(c) & 0xc0u) != 0x80u;
  });
  return kLetter * static_cast<double>(letters);
}

// Draws names beside signs on as many lines as needed and returns the number of lines. `draw` gets
// the index of the name and the place of its sign.
template <class Draw>
std::size_t add_legend(const std::vector<std::string>& names, double left, double top, Draw draw,
                       std::string& out) {
  double x = left;
  std::size_t lines = names.empty() ? 0 : 1;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double width = 34 + width_of(names[i]);
    if (x > left && x + width > kLegendWidth) {
      x = left;
      ++lines;
    }
    const double y = top + kLegendLine * static_cast<double>(lines - 1);
    draw(i, x + 6, y + 8);
    add_text(x + 18, y + 12, "start", names[i], out);
    x += width;
  }
  return lines;
}

// Places that labels must not cover.
class Taken {
 public:
  void add(double left, double top, double right, double bottom) {
    boxes_.push_back({left, top, right, bottom});
  }
  [[nodiscard]] bool overlaps(double left, double top, double right, double bottom) const {
    return std::any_of(boxes_.begin(), boxes_.end(), [&](const std::array<double, 4>& b) {
      return left < b[2] && right > b[0] && top < b[3] && bottom > b[1];
    });
  }

 private:
  std::vector<std::array<double, 4>> boxes_;
};

struct Placed {
  const PagePlot::Point* point;
  std::size_t series;
  double x;
  double y;
  bool is_zero;  // at the place of zero of a logarithmic axis
};

// The style that a page would give a plot, in its light colours.
constexpr const char* kFileStyle =
    "<style>:root{--ink:#1c2024;--faint:#60646c;--line:#d9d9e0;--back:#fff;--well:#f4f5f7;"
    "--c0:#0b68cb;--c1:#c2410c;--c2:#15803d;--c3:#7e22ce;--c4:#b4820a;--c5:#0e7490;--c6:#be185d;"
    "--c7:#57606a}text{fill:#1c2024;font:12px system-ui,sans-serif}.grid{stroke:#d9d9e0;fill:none}"
    ".line{fill:none;stroke-width:1.6}.band{fill:#f4f5f7}</style>"
    "<rect width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";

class Drawing {
 public:
  explicit Drawing(const PagePlot& plot) : plot_(plot) {}

  std::string draw() {
    const bool log_x = plot_.x_scale == AxisScale::kLogarithmic;
    const bool log_y = plot_.y_scale == AxisScale::kLogarithmic;
    std::vector<double> xs;
    std::vector<double> ys;
    for (const PagePlot::Series& series : plot_.series) {
      for (const PagePlot::Point& point : series.points) {
        if (log_y && !(point.y > 0)) continue;
        if (log_x && !(point.x > 0)) has_zero_ = true;
        if (!log_x || point.x > 0) xs.push_back(point.x);
        ys.push_back(point.y);
      }
    }
    if (ys.empty()) return {};
    if (xs.empty()) xs = {1};
    const Axis x_axis(xs, plot_.x_scale);
    const Axis y_axis(ys, plot_.y_scale);
    std::string legend;
    add_series_legend(legend);
    place_points(x_axis, y_axis, log_x, log_y);
    std::string body;
    add_axes(x_axis, y_axis, body);
    for (std::size_t s = 0; s < plot_.series.size(); ++s) add_line(s, body);
    for (const Placed& placed : placed_) {
      if (!plot_.series[placed.series].marks) continue;
      add_mark(placed.series, placed.x, placed.y, placed.point->radius, colour(placed.series),
               placed.point->hint, body);
    }
    add_labels(body);
    return fmt::format(
               "<svg viewBox=\"0 0 {0} {1:.0f}\" width=\"{0}\" role=\"img\" aria-label=\"{2}\">\n",
               kWidth, bottom_ + kBelow,
               escaped((plot_.title.empty() ? "" : plot_.title + ": ") + plot_.y_title + " over " +
                       plot_.x_title)) +
           legend + body + "</svg>\n";
  }

 private:
  [[nodiscard]] std::string colour(std::size_t series) const {
    const std::size_t wanted = plot_.series[series].colour;
    if (wanted == PagePlot::kOwnColour) return fmt::format("var(--c{})", series % kPlotColours);
    return wanted < kPlotColours ? fmt::format("var(--c{})", wanted) : "var(--ink)";
  }

  void add_series_legend(std::string& out) {
    std::vector<std::string> names;
    for (const PagePlot::Series& series : plot_.series) names.push_back(series.name);
    const std::size_t lines = add_legend(
        names, 8, 4,
        [&](std::size_t s, double x, double y) {
          if (plot_.series[s].marks) {
            add_mark(s, x, y, 5, colour(s), "", out);
          } else {
            const bool stairs = plot_.series[s].joined == PagePlot::Joined::kStaircase;
            out += fmt::format("<path class=\"line{}\" d=\"M{:.1f} {:.1f}h14\" stroke=\"{}\"/>\n",
                               stairs ? " front" : " key", x - 6, y, colour(s));
          }
        },
        out);
    top_ = 16 + kLegendLine * static_cast<double>(lines);
    bottom_ = top_ + kFrameHeight;
  }

  // With values at zero, the axis begins further to the right.
  [[nodiscard]] double axis_left() const { return has_zero_ ? kLeft + kBand + 20 : kLeft + 8; }
  // Series side by side, so that they do not cover each other; fronts begin at the edge.
  [[nodiscard]] double zero_x(std::size_t series) const {
    if (!plot_.series[series].marks) return kLeft;
    constexpr double kMargin = 10;
    const auto last = static_cast<double>(std::max<std::size_t>(plot_.series.size(), 2) - 1);
    return kLeft + kMargin + static_cast<double>(series) / last * (kBand - 2 * kMargin);
  }
  [[nodiscard]] double to_x(double place) const {
    return axis_left() + place * (kWidth - kRight - axis_left());
  }
  [[nodiscard]] double to_y(double place) const { return bottom_ - place * (bottom_ - top_); }

  void place_points(const Axis& x_axis, const Axis& y_axis, bool log_x, bool log_y) {
    for (std::size_t s = 0; s < plot_.series.size(); ++s) {
      for (const PagePlot::Point& point : plot_.series[s].points) {
        if (log_y && !(point.y > 0)) continue;
        const bool is_zero = log_x && !(point.x > 0);
        placed_.push_back({&point, s, is_zero ? zero_x(s) : to_x(x_axis.place(point.x)),
                           to_y(y_axis.place(point.y)), is_zero});
      }
    }
  }

  void add_axes(const Axis& x_axis, const Axis& y_axis, std::string& out) const {
    if (has_zero_) {
      out += fmt::format(
          "<rect class=\"band\" x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.1f}\" "
          "height=\"{:.1f}\"/>\n",
          kLeft, top_, kBand, bottom_ - top_);
      add_text(kLeft + kBand / 2, bottom_ + 17, "middle", plot_.zero_name, out);
    }
    for (const Tick& tick : x_axis.ticks()) {
      const double x = to_x(x_axis.place(tick.value));
      out += fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}V{:.1f}\"/>\n", x, top_, bottom_);
      add_text(x, bottom_ + 17, "middle", tick.text, out);
    }
    for (const Tick& tick : y_axis.ticks()) {
      const double y = to_y(y_axis.place(tick.value));
      out += fmt::format("<path class=\"grid\" d=\"M{:.1f} {:.1f}H{:.1f}\"/>\n", kLeft, y,
                         kWidth - kRight);
      add_text(kLeft - 7, y + 4, "end", tick.text, out);
    }
    add_text((kLeft + kWidth - kRight) / 2, bottom_ + 38, "middle", plot_.x_title, out);
    out += fmt::format(
        "<text transform=\"rotate(-90)\" x=\"{:.1f}\" y=\"14\" text-anchor=\"middle\">{}</text>\n",
        -(top_ + bottom_) / 2, escaped(plot_.y_title));
  }

  void add_line(std::size_t series, std::string& out) const {
    const PagePlot::Joined joined = plot_.series[series].joined;
    if (joined == PagePlot::Joined::kNot) return;
    const bool stairs = joined == PagePlot::Joined::kStaircase;
    std::string path;
    double last_y = 0;
    for (const Placed& placed : placed_) {
      if (placed.series != series || (placed.is_zero && !stairs)) continue;
      if (path.empty()) {
        path = fmt::format("M{:.1f} {:.1f}", placed.x, placed.y);
      } else if (stairs) {
        path += fmt::format("H{:.1f}V{:.1f}", placed.x, placed.y);
      } else {
        path += fmt::format("L{:.1f} {:.1f}", placed.x, placed.y);
      }
      last_y = placed.y;
    }
    if (path.empty()) return;
    if (stairs) path += fmt::format("V{:.1f}H{:.1f}", last_y, kWidth - kRight);
    out += fmt::format("<path class=\"line{}\" d=\"{}\" stroke=\"{}\"/>\n", stairs ? " front" : "",
                       path, colour(series));
  }

  // The places along curves and fronts: labels avoid them if possible.
  [[nodiscard]] Taken along_lines() const {
    Taken lines;
    const auto add = [&](double x0, double y0, double x1, double y1) {
      constexpr double kEach = 3;
      const double steps = std::ceil(std::hypot(x1 - x0, y1 - y0) / kEach);
      for (double i = 0; i < steps; ++i) {
        const double x = x0 + (x1 - x0) * i / steps;
        const double y = y0 + (y1 - y0) * i / steps;
        lines.add(x - 1, y - 1, x + 1, y + 1);
      }
    };
    for (std::size_t i = 1; i < placed_.size(); ++i) {
      const Placed& from = placed_[i - 1];
      const Placed& to = placed_[i];
      const PagePlot::Joined joined = plot_.series[to.series].joined;
      if (from.series != to.series || joined == PagePlot::Joined::kNot) continue;
      if (joined == PagePlot::Joined::kStaircase) {
        add(from.x, from.y, to.x, from.y);
        add(to.x, from.y, to.x, to.y);
      } else if (!from.is_zero && !to.is_zero) {
        add(from.x, from.y, to.x, to.y);
      }
    }
    return lines;
  }

  void add_labels(std::string& out) const {
    const Taken lines = along_lines();
    Taken taken;
    for (const Placed& placed : placed_) {
      if (!plot_.series[placed.series].marks) continue;
      const double r = placed.point->radius;
      taken.add(placed.x - r, placed.y - r, placed.x + r, placed.y + r);
    }
    for (const Placed& placed : placed_) {
      if (placed.point->label.empty()) continue;
      const double width = width_of(placed.point->label);
      const double r = placed.point->radius + 3;
      // Above, below, to the right, to the left: the first place that is inside and covers nothing,
      // else the first that covers only lines.
      const std::array<std::pair<double, double>, 4> corners = {
          {{placed.x - width / 2, placed.y - r - kLineHeight},
           {placed.x - width / 2, placed.y + r},
           {placed.x + r, placed.y - kLineHeight / 2},
           {placed.x - r - width, placed.y - kLineHeight / 2}}};
      const std::pair<double, double>* best = nullptr;
      for (const auto& corner : corners) {
        const auto [left, top] = corner;
        const bool inside = left >= kLeft && left + width <= kWidth && top >= top_ - kLineHeight &&
                            top + kLineHeight <= bottom_;
        if (!inside || taken.overlaps(left, top, left + width, top + kLineHeight)) continue;
        const bool is_free = !lines.overlaps(left, top, left + width, top + kLineHeight);
        if (best == nullptr || is_free) best = &corner;
        if (is_free) break;
      }
      if (best == nullptr) continue;
      const auto [left, top] = *best;
      taken.add(left, top, left + width, top + kLineHeight);
      add_text(left, top + kLineHeight - 2, "start", placed.point->label, out);
    }
  }

  const PagePlot& plot_;
  bool has_zero_ = false;
  double top_ = 0;
  double bottom_ = 0;
  std::vector<Placed> placed_;
};

}  // namespace

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

std::string to_svg(const PagePlot& plot) {
  if (!plot.lines) return Drawing(plot).draw();
  PagePlot curves = plot;
  for (PagePlot::Series& series : curves.series) {
    series.joined = PagePlot::Joined::kCurve;
    series.marks = false;
  }
  return Drawing(curves).draw();
}

std::string to_svg_file(const PagePlot& plot) {
  std::string svg = to_svg(plot);
  svg.insert(svg.find('>') + 2, kFileStyle);
  svg.insert(svg.find("<svg") + 4, " xmlns=\"http://www.w3.org/2000/svg\"");
  return svg;
}

std::string to_svg(const PageBars& bars) {
  if (bars.bars.empty()) return {};
  constexpr double kRow = 20;
  constexpr double kNumbers = 60;  // room for the sum at the end of a bar
  double names = 0;
  double largest = 0;
  for (const PageBars::Bar& bar : bars.bars) {
    names = std::max(names, width_of(bar.label));
    double sum = 0;
    for (const double value : bar.values) sum += value;
    largest = std::max(largest, sum);
  }
  const double left = names + 14;
  const double unit = largest > 0 ? (kWidth - left - kNumbers) / largest : 0;
  std::string body;
  const auto colour = [](std::size_t part) {
    return fmt::format("var(--c{})", part % kPlotColours);
  };
  const std::size_t lines = add_legend(
      bars.parts, 8, 4,
      [&](std::size_t part, double x, double y) {
        body += fmt::format(
            "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"11\" height=\"11\" fill=\"{}\"/>\n", x - 5,
            y - 6, colour(part));
      },
      body);
  double y = 12 + kLegendLine * static_cast<double>(lines);
  for (const PageBars::Bar& bar : bars.bars) {
    add_text(left - 8, y + 13, "end", bar.label, body);
    double x = left;
    double sum = 0;
    for (std::size_t part = 0; part < bar.values.size(); ++part) {
      const double value = bar.values[part];
      sum += value;
      if (!(value > 0)) continue;
      const std::string name = part < bars.parts.size() ? bars.parts[part] : "";
      body += fmt::format(
          "<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"{:.2f}\" height=\"{:.1f}\" "
          "fill=\"{}\"><title>{}: {:.2f}</title></rect>\n",
          x, y + 2, value * unit, kRow - 4, colour(part), escaped(name), value);
      x += value * unit;
    }
    add_text(x + 6, y + 13, "start", fmt::format("{:.2f}", sum), body);
    y += kRow;
  }
  return fmt::format(
             "<svg viewBox=\"0 0 {0} {1:.0f}\" width=\"{0}\" role=\"img\" aria-label=\"{2}\">\n",
             kWidth, y + 8, escaped(bars.title)) +
         body + "</svg>\n";
}

}  // namespace boxtree::cooker
