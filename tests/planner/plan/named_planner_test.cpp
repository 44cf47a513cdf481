#include <cmath>
#include <stop_token>

#include <talus/planner/plan/named_planner.hpp>
#include <talus/planner/route/planner_names.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace named_planner_test {

using testing::drawn;
using testing::randomMap;

Problem across(unsigned seed) {
  return {.map = randomMap({.width = 40, .height = 40, .seed = seed, .blocked = 0.03, .roughness = 0.1}),
          .start = {3.5, 3.5},
          .goal = {36.5, 35.5},
          .prove = false,
          .kinematics = {.turning_radius_m = 1.5}};
}

TEST(NamedPlanner, DefaultIsTheFieldPlanner) {
  EXPECT_EQ(NamedPlanner().name(), plannerNames().front());
  EXPECT_EQ(NamedPlanner("rrt*").name(), "RRTstar");  // names are matched without case and punctuation
  EXPECT_THROW(NamedPlanner("no-such"), std::invalid_argument);
  EXPECT_THROW(NamedPlanner().plan({}), std::invalid_argument);  // no map
}

// Property: exactly the planners that declare drives return drives.
TEST(NamedPlanner, DrivesAreReturnedExactlyIfDeclared) {
  int drives = 0;
  for (const std::string name : {"field", "hybrid"}) {
    NamedPlanner planner(name);
    Problem problem = across(2);
    const Plan plan = planner.plan(problem);
    ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
    EXPECT_EQ(planner.drives(), !plan.drive.legs.empty()) << name;
    drives += planner.drives();
  }
  EXPECT_EQ(drives, 1);
}

// Property: state kept from one plan does not change the next, also with other maps and goals in between.
TEST(NamedPlanner, ResultIsIndependentOfEarlierPlans) {
  NamedPlanner kept;
  int found = 0;
  for (unsigned seed = 1; seed <= 4; ++seed)
    for (const maps::Point goal : {maps::Point{36.5, 35.5}, {30.5, 5.5}}) {
      Problem problem = across(seed % 2 + 1);
      problem.goal = goal;
      const Plan plan = kept.plan(problem), fresh = NamedPlanner().plan(problem);
      EXPECT_EQ(plan.points, fresh.points);
      EXPECT_EQ(plan.cost_J, fresh.cost_J);
      found += plan.status == RouteStatus::Found;
    }
  EXPECT_GT(found, 3);
}

// Property: each reported cost is lower than the previous one, and the last equals the plan's cost.
TEST(NamedPlanner, ReportsDecreasingCostsWhileSampling) {
  NamedPlanner planner("InformedRRTstar");
  std::vector<double> costs;
  planner.onBetter([&costs](double cost_J) { costs.push_back(cost_J); });
  const Plan plan = planner.plan(across(1));
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  ASSERT_FALSE(costs.empty());
  EXPECT_TRUE(std::ranges::is_sorted(costs, std::greater<>()));
  EXPECT_NEAR(costs.back(), plan.cost_J, 1e-9 * plan.cost_J);
}

TEST(NamedPlanner, StoppedPlanIsMarkedInterrupted) {
  std::stop_source stop;
  Problem problem = across(3);
  problem.watch.stop = stop.get_token();
  NamedPlanner planner("RRTstar");
  EXPECT_FALSE(planner.plan(problem).interrupted);
  planner.onBetter([&stop](double) { stop.request_stop(); });
  const Plan plan = planner.plan(problem);
  EXPECT_EQ(plan.status, RouteStatus::Found);
  EXPECT_TRUE(plan.interrupted);
}

}  // namespace named_planner_test
}  // namespace talus::planner
