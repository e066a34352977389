// SPDX-License-Identifier: MIT
// Plots and bars as data, and their SVG. Colours come from the surrounding page, so one drawing
// serves light, dark and paper.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace boxtree::cooker {

enum class AxisScale : std::uint8_t { kLinear, kLogarithmic };

/// Points over two axes, which range from about the smallest to about the largest value.
struct PagePlot {
  struct Point {
    double x;
    double y;
    std::string label;      // beside the mark, if there is room
    double radius = 5;      // of the mark, in units of the drawing
    std::string hint = {};  // shown when pointed at
  };
  enum class Joined : std::uint8_t {
    kNot,
    kCurve,      // in order, except points at the place of zero
    kStaircase,  // a front: there is no point to the left of and below a line
  };
  struct Series {
    std::string name;
    std::vector<Point> points;
    Joined joined = Joined::kNot;
    std::size_t colour = kOwnColour;
    bool marks = true;
  };
  /// Use the series' index as its colour.
  static constexpr std::size_t kOwnColour = ~std::size_t{0};

  std::string x_title;
  std::string y_title;
  std::vector<Series> series;  // distinguished by colour and shape
  AxisScale x_scale = AxisScale::kLinear;
  AxisScale y_scale = AxisScale::kLinear;
  std::string title = {};
  /// Logarithmic x: label of the left edge, where values that are not above zero are drawn.
  std::string zero_name = "0";
  bool lines = false;  // all series are curves without marks, whatever they state
};

/// Number of colours that a page has for series; further series repeat them with other shapes.
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

/// Text with all markup characters escaped.
[[nodiscard]] std::string escaped(const std::string& text);

/// Empty for a plot without points. Points whose y has no logarithm are left out.
[[nodiscard]] std::string to_svg(const PagePlot& plot);
[[nodiscard]] std::string to_svg(const PageBars& bars);

/// A standalone file: dark on white. Precondition: at least one point.
[[nodiscard]] std::string to_svg_file(const PagePlot& plot);

}  // namespace boxtree::cooker
