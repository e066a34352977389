// SPDX-License-Identifier: MIT
// The page: every cell is there, nothing of a mesh's name is markup, plots stay in their frame.
#include "cooker/report/page.h"

#include <regex>

#include <gtest/gtest.h>

namespace boxtree::cooker {
namespace {

Page sample_page() {
  Page page;
  page.title = "T & <title>";
  page.text = "made by \"x\"";
  page.sections = {{"S",
                    "explains",
                    {{{"mesh", "bytes"}, {{"<b>bunny</b>", "12"}, {"cow", "3.5"}}}},
                    {{"x", "y", {{"one", {{1, -2, "a"}, {9, 40, "b"}}}, {"two", {{5, 5, "c"}}}}}}}};
  return page;
}

TEST(Page, HtmlEscapesAndHoldsEverything) {
  const std::string html = to_html(sample_page());
  for (const char* part : {"T &amp; &lt;title&gt;", "&quot;x&quot;",
                           "<td class=\"word\">&lt;b&gt;bunny&lt;/b&gt;</td>", "<td>12</td>",
                           "<td>3.5</td>", "<svg", "</svg>"}) {
    EXPECT_NE(html.find(part), std::string::npos) << part;
  }
  EXPECT_EQ(html.find("<b>"), std::string::npos);
  EXPECT_EQ(html.find("http"), std::string::npos) << "no network";
}

// Found by a newcomer: recommendations stood below fifteen lines that explain them.
TEST(Page, NotesStandBehindConclusionsAndTables) {
  Page page = sample_page();
  page.sections.front().conclusions = {{"Take", "this"}};
  page.sections.front().notes = "because <of> that";
  const std::string html = to_html(page);
  const std::size_t notes = html.find("because &lt;of&gt; that");
  ASSERT_NE(notes, std::string::npos);
  EXPECT_LT(html.find("explains"), html.find("Take"));
  EXPECT_LT(html.find("Take"), html.find("</table>"));
  EXPECT_LT(html.rfind("</table>"), notes);
  EXPECT_EQ(to_text(page).find("because"), std::string::npos);
}

TEST(Page, MarksLieInsideTheFrame) {
  const std::string html = to_html(sample_page());
  const std::regex circle("<circle cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"");
  std::size_t count = 0;
  for (std::sregex_iterator it(html.begin(), html.end(), circle), end; it != end; ++it, ++count) {
    const double x = std::stod((*it)[1]);
    const double y = std::stod((*it)[2]);
    EXPECT_TRUE(x >= 0 && x <= 640 && y >= 0 && y <= 400) << x << ' ' << y;
  }
  EXPECT_EQ(count, 3u);  // two points and the legend
}

TEST(Page, TextAlignsColumns) {
  const std::string text = to_text(sample_page());
  EXPECT_NE(text.find("  mesh          bytes\n  <b>bunny</b>     12\n  cow             3.5\n"),
            std::string::npos)
      << text;
}

}  // namespace
}  // namespace boxtree::cooker
