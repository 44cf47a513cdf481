#include <cmath>
#include <stdexcept>

#include <refused.hpp>

#include <talus/cli/draw/plot.hpp>

#include "example_scene.hpp"
#include "requirement.hpp"
#include "run_program.hpp"

namespace talus::cli {

namespace plot_test {

using testing::HasSubstr;
using testing::StartsWith;

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

TEST(Plot, PlotIsDrawnAsPngOrSvg) {
  const std::string bytes = draw({example(), example(), example()}, Canvas::Kind::Png);
  EXPECT_THAT(bytes, StartsWith("\x89PNG"));
  EXPECT_THAT(draw({example()}, Canvas::Kind::Svg), HasSubstr("<svg"));
  keep("plot.png", bytes);
}

// Property: a point adds at most 40 bytes to an SVG, so that a page of many charts stays below 3 MB.
TEST(Plot, SvgSizePerPointIsBounded) {
  Plot many = example();
  Series cloud{.name = "", .x = {}, .y = {}, .mark = Series::Mark::Points};
  for (int i = 0; i < 2000; ++i) {
    cloud.x.push_back(std::fmod(0.618 * i, 1.0));
    cloud.y.push_back(std::sin(i));
  }
  const std::size_t few = draw({many}, Canvas::Kind::Svg).size();
  many.series.push_back(cloud);
  EXPECT_LT(draw({many}, Canvas::Kind::Svg).size() - few, 2000U * 40U);
}

// Property: the file size of 400 000 readings is bounded, because readings that
// cover each other are omitted.
TEST(Plot, OfReadingsThatCoverEachOtherIsSmall) {
  const auto cloud = [](int count) {
    Series readings{.name = "", .x = {}, .y = {}, .mark = Series::Mark::Points};
    for (int i = 0; i < count; ++i) {
      readings.x.push_back(std::fmod(0.618 * i, 1.0));
      readings.y.push_back(std::sin(i));
    }
    return draw({{.title = "", .x = {}, .y = {}, .series = {readings}}}, Canvas::Kind::Svg);
  };
  EXPECT_LT(cloud(400'000).size(), 1'000'000U);
}

TEST(Plot, EmptyAndNanSeriesAreDrawn) {
  Plot plot{.title = "", .x = {}, .y = {}, .series = {{.x = {}, .y = {}}, {.x = {1.0}, .y = {std::nan("")}}}};
  EXPECT_THAT(draw({plot}, Canvas::Kind::Png), StartsWith("\x89PNG"));
  EXPECT_THAT(draw({}, Canvas::Kind::Png), StartsWith("\x89PNG"));
}

TEST(Plot, ColumnsOfDifferentLengthAreRejected) {
  const Plot plot{.title = "", .x = {}, .y = {}, .series = {{.name = "a", .x = {1.0, 2.0}, .y = {1.0}}}};
  EXPECT_REFUSED(draw({plot}, Canvas::Kind::Png), std::invalid_argument,
                 "x and y have 2 and 1 values, must be as many");
}

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

}  // namespace plot_test

}  // namespace talus::cli
