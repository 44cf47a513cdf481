#include <cmath>

#include <gmock/gmock.h>

#include <talus/cli/study/bench_report.hpp>
#include <talus/costmap/cost/cost_grid.hpp>

namespace talus::cli {
namespace bench_report_test {

using planner::BenchmarkPlan;
using planner::BenchmarkRun;
using planner::RouteStatus;
using ::testing::HasSubstr;
using ::testing::Not;

BenchmarkPlan plan() {
  return {.cases = {{.name = "gap"}, {.name = "wall"}}, .planners = {"field", "RRTstar"}, .seeds = 1};
}

BenchmarkRun run(const std::string& planner, std::size_t case_index, double cost_J) {
  BenchmarkRun made;
  made.planner = planner;
  made.case_index = case_index;
  made.status = RouteStatus::Found;
  made.cost_J = cost_J;
  made.seconds = 1.0;
  made.progress = {{0.25, 2.0 * cost_J}, {1.0, cost_J}};
  return made;
}

// Two planners on two cases; the route check refuses the first route of RRTstar, although that route costs
// half.
std::vector<BenchmarkRun> runs() {
  std::vector<BenchmarkRun> all{run("field", 0, 100.0), run("field", 1, 120.0), run("RRTstar", 0, 50.0),
                                run("RRTstar", 1, 100.0)};
  all[2].breached = true;
  all[2].cusps = 8;
  all[2].max_curvature_1_m = 9.0;
  return all;
}

// Closed form: computed by hand from the costs above.
TEST(BenchReport, InvalidRouteHasNoCost) {
  const auto lines = compared(plan(), runs());
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_DOUBLE_EQ(lines[0].worst_gap, 0.2);  // on the first case the best valid route costs 100 J (field)
  EXPECT_NEAR(lines[0].median_gap, 0.1, 1e-12);
  EXPECT_EQ(lines[1].found, 2);
  EXPECT_EQ(lines[1].breached, 1);
  EXPECT_DOUBLE_EQ(lines[1].worst_gap, 0.0);
  EXPECT_DOUBLE_EQ(lines[1].median_gap, 0.0);
  EXPECT_DOUBLE_EQ(lines[1].mean_cusps, 0.0);
  EXPECT_DOUBLE_EQ(lines[1].max_curvature_1_m, 0.0);
}

// Property: planners with a valid route have a curve of the gap to the best valid route in percent.
TEST(BenchReport, InvalidRouteIsNotPlotted) {
  const auto plots = gapsOverTime(plan(), runs());
  ASSERT_EQ(plots.size(), 2u);
  ASSERT_EQ(plots[0].series.size(), 1u);
  EXPECT_EQ(plots[0].series[0].name, "field");
  EXPECT_NEAR(plots[0].series[0].y.front(), 100.0, 1e-9);
  EXPECT_NEAR(plots[0].series[0].y.back(), 0.0, 1e-9);
  EXPECT_EQ(plots[1].series.size(), 2u);
}

}  // namespace bench_report_test
}  // namespace talus::cli
