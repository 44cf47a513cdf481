#include <cmath>
#include <stdexcept>

#include <refused.hpp>

#include <talus/cli/draw/page.hpp>
#include <talus/cli/draw/plot.hpp>

#include "browser.hpp"
#include "example_scene.hpp"
#include "requirement.hpp"
#include "run_program.hpp"

namespace talus::cli {

namespace plot_test {

using testing::HasSubstr;

Plot example() {
  Plot plot{.title = "Pull over slip", .x = {.label = "slip [-]"}, .y = {.label = "DP/W [-]"}, .series = {}};
  Series line{.name = "model", .x = {}, .y = {}};
  Series points{.name = "measured", .x = {}, .y = {}, .mark = Series::Mark::Points};
  for (int i = 0; i <= 40; ++i) {
    line.x.push_back(i / 40.0);
    line.y.push_back(0.4 * (1.0 - std::exp(-5.0 * i / 40.0)) - 0.15);
    points.x.push_back(i / 40.0);
    points.y.push_back(line.y.back() + 0.03 * std::sin(7.0 * i));
  }
  line.y[20] = std::nan("");
  plot.series = {line, points};
  return plot;
}

// Property: the chart of 400 000 readings is bounded, because readings that cover each other are omitted.
TEST(Plot, ReadingsThatCoverEachOtherAreOmitted) {
  Series readings{.name = "", .x = {}, .y = {}, .mark = Series::Mark::Points};
  for (int i = 0; i < 400'000; ++i) {
    readings.x.push_back(std::fmod(0.618 * i, 1.0));
    readings.y.push_back(i == 7 ? std::nan("") : std::sin(i));
  }
  Report report("many");
  report.charts({{.title = "", .x = {}, .y = {}, .series = {readings}}});
  EXPECT_LT(report.html().size() - reportTemplate().size(), 700'000U);
}

TEST(Plot, ColumnsOfDifferentLengthAreRejected) {
  const Plot plot{.title = "", .x = {}, .y = {}, .series = {{.name = "a", .x = {1.0, 2.0}, .y = {1.0}}}};
  EXPECT_REFUSED(Report("a").charts({plot}), std::invalid_argument,
                 "x and y have 2 and 1 values, must be as many");
}

// Property: each chart is drawn, also one without values, and one on logarithmic axes.
TEST(Plot, ChartsAreDrawnInABrowser) {
  TALUS_REQUIRE(test::installed("chromium"), "chromium is not installed");
  Plot logarithmic = example();
  logarithmic.x.logarithmic = logarithmic.y.logarithmic = true;
  Report report("charts");
  report.charts({example(), logarithmic, {.title = "", .x = {}, .y = {}, .series = {{.x = {}, .y = {}}}}});
  const Shown shown = show(report.html());
  EXPECT_TRUE(ready(shown)) << shown.console;
  EXPECT_THAT(shown.dom, HasSubstr("id=\"chart2\" aria-label=\"Vega visualization\""));
}

using testing::Not;

TEST(Report, TextIsEscapedAndFiguresEmbedded) {
  Report report("a < b");
  report.table({{"name", "value"}, {"x & y", "1.5"}});
  report.charts({{.title = "Pull", .x = {}, .y = {}, .series = {{.x = {0.0, 1.0}, .y = {0.0, 1.0}}}}});
  EXPECT_THAT(report.html(), HasSubstr("<h1>a &lt; b</h1>"));
  EXPECT_THAT(report.html(), HasSubstr("<td>x &amp; y</td><td class=\"number\">1.5</td>"));
  EXPECT_THAT(report.html(), HasSubstr(R"("values":[[0.0,0.0],[1.0,1.0]])"));
}

// Property: text from the user is never interpreted as markup, anywhere on the page.
TEST(Report, UserTextIsNeverMarkup) {
  const std::string hostile = "<script>alert(\"1\")</script>";
  Report report(hostile);
  report.heading(hostile);
  report.paragraph(hostile);
  report.table({{hostile}, {hostile}});
  report.charts(
      {{.title = hostile, .x = {hostile}, .y = {}, .series = {{.name = hostile, .x = {}, .y = {}}}}});
  EXPECT_THAT(report.html(), Not(HasSubstr("<script>alert")));
  EXPECT_EQ(escaped("a & <b> \"c\""), "a &amp; &lt;b&gt; &quot;c&quot;");
}

}  // namespace plot_test

}  // namespace talus::cli
