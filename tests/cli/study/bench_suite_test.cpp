#include <cmath>
#include <set>

#include <gmock/gmock.h>

#include <talus/cli/app/context.hpp>
#include <talus/cli/study/bench_suite.hpp>
#include <talus/common/common.hpp>
#include <talus/costmap/cost/cost_model.hpp>
#include <talus/planner/grid/field_planner.hpp>

#include "bad_input.hpp"

namespace talus::cli {

namespace bench_suite_test {

using testing::HasSubstr;
using testing::ThrowsMessage;

double rolling(int column, int row) {
  return 0.5 * std::sin(column / 9.0) * std::cos(row / 7.0);
}

Context quiet() {
  Context context;
  context.quiet = true;
  return context;
}

// Property: start and goal are at least half a map diagonal apart and connected; equal seeds give equal
// pairs; maps of one name in two folders are separate cases.
TEST(BenchSuite, PairsAreDistantConnectedAndReproducible) {
  const Folder one, other;
  SuiteOptions options;
  options.names = {one.write("dem.asc", asciiGrid(60, 50, rolling)),
                   other.write("dem.asc", asciiGrid(60, 50, rolling))};
  options.pairs = 2;
  options.turning_radius_m = 2.5;
  options.ground.elevation.read.resolution_m = 1.0;
  options.ground.soil = "sandy_loam";
  options.ground.rover = "fido";
  const auto cases = suiteCases(options, quiet()), again = suiteCases(options, quiet());
  ASSERT_EQ(cases.size(), 4U);
  std::set<std::string> names;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const auto& made = cases[i];
    names.insert(made.name);
    EXPECT_GE(std::hypot(made.goal.x_m - made.start.x_m, made.goal.y_m - made.start.y_m),
              0.5 * std::hypot(60, 50));
    EXPECT_EQ(planner::FieldPlanner().plan({.map = made.map, .start = made.start, .goal = made.goal}).status,
              planner::RouteStatus::Found);
    EXPECT_EQ(made.kinematics.turning_radius_m, 2.5);
    EXPECT_EQ(again[i].start, made.start);
  }
  EXPECT_EQ(names.size(), 4U);
}

// Property: each slip world is planned with two beliefs (mean and tail of slip) over the same true slip.
TEST(BenchSuite, SlipWorldsArePlannedWithMeanAndTail) {
  SuiteOptions options;
  options.names = {"slip"};
  options.pairs = 2;
  const auto cases = suiteCases(options, quiet());
  ASSERT_EQ(cases.size(), 4U);
  for (std::size_t i = 0; i < 4; i += 2) {
    EXPECT_EQ(cases[i].group, "slip mean");
    EXPECT_EQ(cases[i + 1].group, "slip tail");
    EXPECT_EQ(cases[i].start, cases[i + 1].start);
  }
}

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

}  // namespace bench_suite_test

}  // namespace talus::cli
