#include <cmath>
#include <stdexcept>

#include <talus/cli/draw/html_report.hpp>
#include <talus/cli/draw/image.hpp>
#include <talus/cli/draw/plot.hpp>
#include <talus/cli/draw/ticks.hpp>

#include "example_scene.hpp"
#include "run_program.hpp"

namespace talus::cli {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

Plot example() {
  Plot plot{.title = "Pull over slip", .x = {.label = "slip [-]"}, .y = {.label = "DP/W [-]"}, .series = {}};
  Series line{.name = "model", .x = {}, .y = {}};
  Series points{.name = "measured", .x = {}, .y = {}, .mark = Series::Mark::Points};
  for (int i = 0; i <= 40; ++i) {
    line.x.push_back(i / 40.0);
    line.y.push_back(0.4 * (1.0 - std::exp(-5.0 * i / 40.0)) - 0.15);
    line.y_std.push_back(0.03);
    points.x.push_back(i / 40.0);
    points.y.push_back(line.y.back() + 0.03 * std::sin(7.0 * i));
  }
  line.y[20] = std::nan("");
  plot.series = {line, points};
  return plot;
}

TEST(Ticks, AreRoundAndInside) {
  EXPECT_THAT(ticks({0.0, 1.0}, 5),
              ElementsAre(0.0, 0.2, testing::DoubleEq(0.4), testing::DoubleNear(0.6, 1e-12), 0.8, 1.0));
  EXPECT_THAT(ticks({-3.0, 7.0}, 5), ElementsAre(-2.0, 0.0, 2.0, 4.0, 6.0));
  EXPECT_THAT(ticks({2.0, 2.0}, 5), ElementsAre(2.0));
  EXPECT_EQ(tickLabel(0.30000000000000004, 0.1), "0.3");
  EXPECT_EQ(tickLabel(-1e-18, 0.1), "0.0");
}

TEST(Ticks, RoundBelowIsTheLargestRoundNumber) {
  EXPECT_DOUBLE_EQ(roundBelow(1.0), 1.0);
  EXPECT_DOUBLE_EQ(roundBelow(0.049), 0.02);
  EXPECT_DOUBLE_EQ(roundBelow(999.0), 500.0);
  EXPECT_DOUBLE_EQ(roundBelow(1000.0), 1000.0);
}

TEST(Plot, IsAPngOrAnSvg) {
  const std::string bytes = draw({example(), example(), example()}, Canvas::Kind::Png);
  EXPECT_THAT(bytes, StartsWith("\x89PNG"));
  EXPECT_THAT(draw({example()}, Canvas::Kind::Svg), HasSubstr("<svg"));
  keep("plot.png", bytes);
}

TEST(Plot, StandsEmptySeriesAndNothingFinite) {
  Plot plot{.title = "", .x = {}, .y = {}, .series = {{.x = {}, .y = {}}, {.x = {1.0}, .y = {std::nan("")}}}};
  EXPECT_THAT(draw({plot}, Canvas::Kind::Png), StartsWith("\x89PNG"));
  EXPECT_THAT(draw({}, Canvas::Kind::Png), StartsWith("\x89PNG"));
}

TEST(Plot, RefusesColumnsOfDifferentLength) {
  const Plot plot{.title = "", .x = {}, .y = {}, .series = {{.name = "a", .x = {1.0, 2.0}, .y = {1.0}}}};
  EXPECT_THROW(draw({plot}, Canvas::Kind::Png), std::invalid_argument);
}

TEST(Plot, IsWrittenByItsExtension) {
  const Folder folder;
  save(folder / "a.svg", {example()});
  save(folder / "a.png", {example()});
  EXPECT_THAT(fileContent(folder / "a.svg"), HasSubstr("<svg"));
  EXPECT_THAT(fileContent(folder / "a.png"), StartsWith("\x89PNG"));
}

TEST(HtmlReport, EscapesAndEmbeds) {
  HtmlReport report("a < b");
  report.table({"name", "value"}, {{"x & y", "1.5"}});
  report.charts({example()});
  EXPECT_THAT(report.html(), HasSubstr("<h1>a &lt; b</h1>"));
  EXPECT_THAT(report.html(), HasSubstr("<td>x &amp; y</td><td class=\"number\">1.5</td>"));
  EXPECT_THAT(report.html(), HasSubstr("data:image/svg+xml;base64,"));
  EXPECT_THAT(report.html(), Not(HasSubstr("http://")));
}

TEST(Image, Base64) {
  // Printed in: RFC 4648, section 10.
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

}  // namespace
}  // namespace talus::cli
