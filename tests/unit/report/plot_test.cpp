// SPDX-License-Identifier: MIT
// Plots: lines through all their points and inside the frame, files that need no page around them.
#include "cooker/report/plot.h"

#include <algorithm>
#include <iterator>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

#include <gtest/gtest.h>

namespace boxtree::cooker {
namespace {

PagePlot sample() {
  PagePlot plot{
      "x", "<y>", {{"a & b", {{0, -3, ""}, {1, 5, ""}, {2, 4, ""}}}, {"c", {{2, 0.1, ""}}}}};
  plot.lines = true;
  return plot;
}

TEST(Plot, LinesGoThroughTheirPointsInsideTheFrame) {
  const std::string svg = to_svg(sample());
  const std::regex line("class=\"line\" d=\"M([^\"]*)\"");
  std::vector<std::size_t> counts;
  for (std::sregex_iterator it(svg.begin(), svg.end(), line), end; it != end; ++it) {
    std::string path = (*it)[1];
    std::replace(path.begin(), path.end(), 'L', ' ');
    std::istringstream points(path);
    double x = 0;
    double y = 0;
    double last = -1;
    counts.push_back(0);
    while (points >> x >> y) {
      EXPECT_TRUE(x > last && x <= 640 && y >= 0 && y <= 400) << x << ' ' << y;
      last = x;
      ++counts.back();
    }
  }
  EXPECT_EQ(counts, (std::vector<std::size_t>{3, 1}));
  EXPECT_EQ(svg.find("<circle"), std::string::npos) << "lines have no marks";
}

// Above the mark comes first, but there its own curve goes up.
TEST(Plot, LabelsKeepOffLinesWhereAnotherSideIsFree) {
  PagePlot plot{"x", "y", {{"s", {{5, 4, "here"}, {5, 9, ""}, {9, 9, ""}, {1, 1, ""}}}}};
  plot.series[0].joined = PagePlot::Joined::kCurve;
  const auto heights = [&] {
    const std::string svg = to_svg(plot);
    const std::regex circle("<circle [^>]*cy=\"([0-9.]+)\"");
    const std::sregex_iterator legend(svg.begin(), svg.end(), circle);
    std::smatch label;
    EXPECT_TRUE(std::regex_search(svg, label, std::regex("y=\"([0-9.]+)\"[^>]*>here</text>")));
    return std::pair(std::stod((*std::next(legend))[1]), std::stod(label[1]));
  };
  const auto [mark, label] = heights();
  EXPECT_GT(label, mark) << "not below";
  plot.series[0].joined = PagePlot::Joined::kNot;
  const auto [same_mark, label_above] = heights();
  EXPECT_EQ(same_mark, mark);
  EXPECT_LT(label_above, mark) << "not above, where nothing is";
}

TEST(Plot, ZeroOnAnAxisIsZero) {
  // Steps of 0.1 from below zero: added up they miss it.
  PagePlot plot{"x", "y", {{"s", {{-0.3, -0.3, ""}, {0.3, 0.3, ""}}}}};
  plot.lines = true;
  const std::string svg = to_svg(plot);
  EXPECT_NE(svg.find(">0</text>"), std::string::npos);
  EXPECT_FALSE(std::regex_search(svg, std::regex(">[-0-9.]*e-[0-9]+</text>")));
}

TEST(Plot, FilesBringTheirColours) {
  const std::string svg = to_svg_file(sample());
  EXPECT_TRUE(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" "));
  const std::regex used("var\\((--c[0-9])\\)");
  std::set<std::string> names;
  for (std::sregex_iterator it(svg.begin(), svg.end(), used), end; it != end; ++it) {
    names.insert((*it)[1]);
  }
  EXPECT_EQ(names, (std::set<std::string>{"--c0", "--c1"}));
  for (const std::string& name : names) EXPECT_NE(svg.find(name + ":#"), std::string::npos);
  EXPECT_NE(svg.find("a &amp; b"), std::string::npos);
}

TEST(Plot, NothingWithoutPoints) {
  EXPECT_EQ(to_svg({"x", "y", {{"none", {}}}}), "");
}

}  // namespace
}  // namespace boxtree::cooker
