#include <talus/cli/draw/html_report.hpp>

#include "browser.hpp"
#include "requirement.hpp"

namespace talus::cli {
namespace html_report_test {

using testing::HasSubstr;
using testing::Not;

TEST(HtmlReport, TextIsEscapedAndFiguresEmbedded) {
  HtmlReport report("a < b");
  report.table({"name", "value"}, {{"x & y", "1.5"}});
  report.charts({{.title = "Pull", .x = {}, .y = {}, .series = {{.x = {0.0, 1.0}, .y = {0.0, 1.0}}}}});
  EXPECT_THAT(report.html(), HasSubstr("<h1>a &lt; b</h1>"));
  EXPECT_THAT(report.html(), HasSubstr("<td>x &amp; y</td><td class=\"number\">1.5</td>"));
  EXPECT_THAT(report.html(), HasSubstr("data:image/svg+xml;base64,"));
  EXPECT_THAT(report.html(), Not(HasSubstr("http://")));
}

// Property: text from the user is never interpreted as markup, anywhere on the page.
TEST(HtmlReport, UserTextIsNeverMarkup) {
  const std::string hostile = "<script>alert(\"1\")</script>";
  HtmlReport report(hostile);
  report.heading(hostile);
  report.paragraph(hostile);
  report.table({hostile}, {{hostile}});
  EXPECT_THAT(report.html(), Not(HasSubstr("<script")));
  EXPECT_EQ(escaped("a & <b> \"c\""), "a &amp; &lt;b&gt; &quot;c&quot;");
}

// Property: on a phone a table of twelve columns fits the screen width, and each cell shows its column name.
TEST(HtmlReport, FitsAPhone) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  HtmlReport report("t");
  std::vector<std::string> header, row;
  for (int i = 0; i < 12; ++i) {
    header.push_back("column \"" + std::to_string(i));
    row.push_back(std::to_string(i));
  }
  report.table(header, {row, row});
  // A page of HtmlReport contains no script, so a frame around the page measures the layout.
  const std::string frame = "<!doctype html><html><body><iframe width=390 height=844 srcdoc=\"" +
                            escaped(report.html()) +
                            R"("></iframe><script>onload = () => {
        const page = document.querySelector("iframe").contentDocument, box = page.querySelector(".table");
        document.body.dataset.fits = box.scrollWidth <= box.clientWidth && page.documentElement.scrollWidth <= 390;
        document.body.dataset.name = getComputedStyle(page.querySelectorAll("td")[13], "::before").content;
      };</script></body></html>)";
  const Shown shown = show(frame);
  EXPECT_THAT(shown.dom, HasSubstr("data-fits=\"true\"")) << shown.dom.substr(0, 300) << shown.console;
  EXPECT_THAT(shown.dom, HasSubstr("data-name=\"&quot;column \\&quot;1&quot;\"")) << shown.dom.substr(0, 300);
}

// Closed form: a number may have a unit or percent sign; a name that begins with a digit is not a number.
TEST(HtmlReport, NumbersAreRightAligned) {
  const auto number = [](const std::string& cell) {
    HtmlReport report("t");
    report.table({"h"}, {{cell}});
    return report.html().find("class=\"number\"") != std::string::npos;
  };
  for (const char* cell : {"1", "-1.5e3", "12 mm", "3%"}) EXPECT_TRUE(number(cell)) << cell;
  for (const char* cell : {"", "sand", "2nd pass", "-"}) EXPECT_FALSE(number(cell)) << cell;
}

}  // namespace html_report_test
}  // namespace talus::cli
