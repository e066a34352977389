// SPDX-License-Identifier: MIT
// Plots and bars as data, and the SVG drawn from them: colours come from the page around it, so
// that one drawing serves light, dark and paper.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace boxtree::cooker {

enum class AxisScale : std::uint8_t { kLinear, kLogarithmic };

/// Points over two axes, from about their smallest to about their largest value.
struct PagePlot {
  struct Point {
    double x;
    double y;
    std::string label;      // beside the mark, where there is room
    double radius = 5;      // of the mark, in units of the drawing
    std::string hint = {};  // shown when pointed at
  };
  enum class Joined : std::uint8_t {
    kNot,
    kCurve,      // in their order, but for points at the place of zero
    kStaircase,  // a front: to the left of and below each line nothing was found
  };
  struct Series {
    std::string name;
    std::vector<Point> points;
    Joined joined = Joined::kNot;
    std::size_t colour = kOwnColour;
    bool marks = true;
  };
  /// Instead of a number: the series' place among all.
  static constexpr std::size_t kOwnColour = ~std::size_t{0};

  std::string x_title;
  std::string y_title;
  std::vector<Series> series;  // told apart by colour and shape
  AxisScale x_scale = AxisScale::kLinear;
  AxisScale y_scale = AxisScale::kLinear;
  std::string title = {};
  /// Logarithmic x: what stands at the left edge, where values that are not above zero are drawn.
  std::string zero_name = "0";
  bool lines = false;  // all series are curves without marks, whatever they say
};

/// Colours that a page has for series; more than that start again with another shape.
inline constexpr std::size_t kPlotColours = 8;

/// Bars of parts that add up.
struct PageBars {
  struct Bar {
    std::string label;
    std::vector<double> values;  // as many as parts
  };
  std::string title;  // with the unit
  std::vector<std::string> parts;
  std::vector<Bar> bars;
};

/// Text in which nothing is markup.
[[nodiscard]] std::string escaped(const std::string& text);

/// Nothing for a plot without points; points whose y a logarithm does not have are left out.
[[nodiscard]] std::string to_svg(const PagePlot& plot);
[[nodiscard]] std::string to_svg(const PageBars& bars);

/// A file of its own: dark on white. Precondition: a point.
[[nodiscard]] std::string to_svg_file(const PagePlot& plot);

}  // namespace boxtree::cooker
