#include <cmath>
#include <numbers>

#include <talus/planner/check/route_check.hpp>
#include <talus/planner/plan/make_planner.hpp>
#include <talus/planner/plan/named_planner.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace make_planner_test {

using ::testing::HasSubstr;
using ::testing::ThrowsMessage;

const std::vector<std::string> kOpen(30, std::string(40, '.'));

PlanRequest across() {
  PlanRequest request;
  request.start = {5.5, 15.5};
  request.goal = {34.5, 15.5};
  return request;
}

TEST(MakePlanner, CreatesThePlannerOfTheGivenName) {
  EXPECT_EQ(makePlanner()->capabilities().planner, "field");
  const auto planner = makePlanner("field");
  planner->set_map(testing::drawn(kOpen));
  EXPECT_NEAR(planner->plan(across()).summary.length_m, 29.0, 1e-9);  // Closed form: straight on the flat
  EXPECT_THROW(makePlanner("no-such"), std::invalid_argument);
}

TEST(MakePlanner, HeadingsAndTurningRadiusAreMetOrRejected) {
  PlanRequest request = across();
  request.start_heading_rad = request.goal_heading_rad = std::numbers::pi / 2;
  request.kinematics = Kinematics{.turning_radius_m = 3.0, .may_reverse = false};
  const auto field = makePlanner("field");
  field->set_map(testing::drawn(kOpen));
  EXPECT_THAT([&] { field->plan(request); },
              ThrowsMessage<std::invalid_argument>(HasSubstr("start_heading_rad is not honoured")));

  const auto hybrid = makePlanner("hybrid");
  EXPECT_TRUE(hybrid->capabilities().headings && hybrid->capabilities().reversing);
  hybrid->set_map(testing::drawn(kOpen));
  const Route route = hybrid->plan(request);
  ASSERT_EQ(route.status, RouteStatus::Found) << route.reason;
  EXPECT_NEAR(route.vertices.front().heading_rad, std::numbers::pi / 2, 0.1);
  EXPECT_NEAR(route.vertices.back().heading_rad, std::numbers::pi / 2, 0.1);
  ASSERT_TRUE(route.summary.drive);
  EXPECT_LE(route.summary.drive->max_curvature_1_m, 1.0 / 3.0 + 1e-9);
  EXPECT_EQ(route.summary.drive->cusps, 0);
}

TEST(MakePlanner, SeedThreadsAndTimeLimitComeFromSettings) {
  const auto planner = makePlanner();
  planner->set_map(testing::drawn(kOpen));
  planner->configure({.planner = "RRTstar", .seed = 3, .time_limit_s = 0.2});
  EXPECT_EQ(planner->capabilities().planner, "RRTstar");
  EXPECT_EQ(planner->plan(across()).status, RouteStatus::Found);
  EXPECT_THROW(planner->configure({.threads = 0}), std::invalid_argument);
}

TEST(MakePlanner, RouteCostEqualsThatOfTheInnerPlanner) {
  // Property: makePlanner() adds checks and annotation, and changes no cost.
  const auto map = testing::randomMap({.width = 60, .height = 50, .seed = 11, .blocked = 0.05});
  NamedPlanner inner("field");
  const auto planner = makePlanner("field");
  planner->set_map(map);
  int found = 0;
  for (int k = 0; k < 5; ++k) {
    PlanRequest request;
    request.start = map->grid().centre({2 + k, 3});
    request.goal = map->grid().centre({55, 45 - k});
    const Plan plan = inner.plan({.map = map, .start = request.start, .goal = request.goal});
    const Route route = planner->plan(request);
    ASSERT_EQ(route.status, plan.status);
    if (plan.status != RouteStatus::Found) continue;
    ++found;
    EXPECT_NEAR(route.summary.cost, plan.cost_J, 1e-9 * plan.cost_J);
    EXPECT_DOUBLE_EQ(route.summary.lower_bound, plan.lower_bound_J);
  }
  EXPECT_GT(found, 0);
}

TEST(MakePlanner, ChassisAndRiskLimitAreEnforced) {
  // A step of 0.5 m across the map with a gap in the north; the step is not in the cost map.
  const maps::Grid grid{.width = 40, .height = 30, .resolution_m = 1.0, .south_west = {}};
  maps::Raster<float> steps(grid, 0.0F);
  for (int row = 0; row < 22; ++row) steps[{20, row}] = 0.5F;
  terramech::Rover rover;
  rover.wheel = {.radius_m = 0.2, .width_m = 0.2};
  rover.wheelbase_m = rover.track_m = 0.8;
  rover.clearance_m = 0.3;
  const auto planner = makePlanner("field");
  planner->set_map(testing::drawn(kOpen));
  PlanRequest request = across();
  request.chassis = std::make_shared<const Chassis>(steps, rover, Suspension::Rigid);
  const Route round = planner->plan(request);
  ASSERT_EQ(round.status, RouteStatus::Found) << round.reason;
  EXPECT_GT(round.summary.length_m, 30.0);
  request = across();
  request.risk_limit = RiskLimit{.immobilisation = 0.5};
  EXPECT_EQ(planner->plan(request).status, RouteStatus::Found);
}

}  // namespace make_planner_test
}  // namespace talus::planner
