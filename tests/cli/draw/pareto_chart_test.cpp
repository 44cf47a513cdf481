#include <nlohmann/json.hpp>

#include <talus/cli/draw/pareto_chart.hpp>
#include <talus/common/input_error.hpp>

#include "run_program.hpp"

namespace talus::cli {
namespace pareto_chart_test {

using testing::HasSubstr;

std::vector<planner::ParetoRoute> front() {
  planner::ParetoRoute cheap, safe;
  cheap.demand = {.energy_J = 10'000.0, .time_s = 3'600.0, .risk = 0.02};
  safe.demand = {.energy_J = 12'500.0, .time_s = 5'400.0, .risk = 0.001};
  safe.weights = {.time_W = 2.0, .risk_J = 1e6};
  return {cheap, safe};
}

// Closed form: energy in kJ, duration in h and risk in percent of each route.
TEST(ParetoChart, PageHasARowForEachRoute) {
  const Folder folder;
  saveParetoChart(folder / "front.html", front());
  const std::string page = fileContent(folder / "front.html");
  EXPECT_THAT(page, HasSubstr(">10.0</td><td class=\"number\">1.00</td><td class=\"number\">2.0000</td>"));
  EXPECT_THAT(page, HasSubstr(">12.5</td><td class=\"number\">1.50</td><td class=\"number\">0.1000</td>"));
  EXPECT_THAT(page, HasSubstr("data:image/svg+xml"));
}

TEST(ParetoChart, FigureFormatFollowsTheExtensionAndUnwritablePathIsRejected) {
  const Folder folder;
  saveParetoChart(folder / "front.svg", front());
  EXPECT_THAT(fileContent(folder / "front.svg"), HasSubstr("<svg"));
  EXPECT_THROW(saveParetoChart(folder / "no/front.png", front()), InputError);
}

TEST(ParetoChart, JsonHasDemandsAndWeights) {
  const auto json = paretoJson(front());
  ASSERT_EQ(json.size(), 2U);
  EXPECT_EQ(json[0]["energy_J"], 10'000.0);
  EXPECT_EQ(json[1]["risk"], 0.001);
  EXPECT_EQ(json[1]["time_weight_W"], 2.0);
  EXPECT_EQ(json[1]["risk_weight_J"], 1e6);
}

}  // namespace pareto_chart_test
}  // namespace talus::cli
