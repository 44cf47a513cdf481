#include <cmath>
#include <set>

#include <talus/cli/app/context.hpp>
#include <talus/cli/study/bench_suite.hpp>
#include <talus/common/input_error.hpp>
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

}  // namespace bench_suite_test
}  // namespace talus::cli
