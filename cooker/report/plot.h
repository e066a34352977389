// SPDX-License-Identifier: MIT
// Plots as SVG, for pages of reports and as files.
#pragma once

#include <string>
#include <vector>

namespace boxtree::cooker {

/// Points over two axes, both linear and from their smallest to their largest value.
struct PagePlot {
  struct Point {
    double x;
    double y;
    std::string label;
  };
  struct Series {
    std::string name;
    std::vector<Point> points;
  };
  std::string x_title;
  std::string y_title;
  std::vector<Series> series;  // at most four, told apart by colour and shape
  bool lines = false;          // join the points of a series; without marks, told apart by dashes
};

/// An <svg> element that takes its colours and fonts from the page around it; empty without points.
[[nodiscard]] std::string to_svg_element(const PagePlot& plot);

/// A file of its own: dark on white. Precondition: a point.
[[nodiscard]] std::string to_svg_file(const PagePlot& plot);

}  // namespace boxtree::cooker
