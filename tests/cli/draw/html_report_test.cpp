#include <talus/cli/draw/html_report.hpp>

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
