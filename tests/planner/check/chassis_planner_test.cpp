#include <stop_token>

#include <talus/planner/check/chassis_planner.hpp>
#include <talus/planner/grid/field_planner.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace chassis_planner_test {

terramech::Rover rover(int wheels) {
  terramech::Rover made{.name = "cart",
                        .mass_kg = 100.0,
                        .wheel_count = wheels,
                        .wheelbase_m = 1.2,
                        .track_m = 1.0,
                        .clearance_m = 0.3,
                        .max_pitch_rad = 0.5,
                        .max_roll_rad = 0.5,
                        .max_torque_Nm = 10.0};
  return made;
}

TEST(ChassisPlanner, RouteAvoidsInsufficientGroundClearance) {
  const auto map = testing::drawn(std::vector<std::string>(20, std::string(20, '.')));
  maps::Raster<float> ground(map->grid());
  for (int r = 3; r < 20; ++r) ground[{10, r}] = 3.0F;  // a wall with a gap in the south
  const Chassis chassis(ground, rover(4), Suspension::Rigid);
  FieldPlanner field;
  const Problem problem{.map = map, .start = {3.5, 10.5}, .goal = {16.5, 10.5}};
  const auto plan = planOnChassis(problem, chassis, [&](const Problem& p) { return field.plan(p); });
  // The gap is two cells beside the edge of the raster: too narrow for wheels half a metre from the centre.
  EXPECT_EQ(plan.status, RouteStatus::NoneFound);
  EXPECT_NE(plan.reason.find("no detour found where"), std::string::npos) << plan.reason;
  for (int r = 3; r < 7; ++r) ground[{10, r}] = 0.0F;
  const auto open = planOnChassis(problem, chassis, [&](const Problem& p) { return field.plan(p); });
  ASSERT_EQ(open.status, RouteStatus::Found) << open.reason;
  EXPECT_TRUE(chassis.violations(open.points).empty());
  EXPECT_GT(open.cost_J, 140.0);
}

// Property: a search that is stopped does not report that no detour exists.
TEST(ChassisPlanner, StopYieldsCancelled) {
  const auto map = testing::drawn(std::vector<std::string>(20, std::string(20, '.')));
  maps::Raster<float> ground(map->grid());
  for (int r = 3; r < 20; ++r) ground[{10, r}] = 3.0F;
  const Chassis chassis(ground, rover(4), Suspension::Rigid);
  FieldPlanner field;
  std::stop_source source;
  Problem problem{.map = map, .start = {3.5, 10.5}, .goal = {16.5, 10.5}};
  problem.watch.stop = source.get_token();
  int rounds = 0;
  const auto plan = planOnChassis(problem, chassis, [&](const Problem& p) {
    Plan found = field.plan(p);
    ++rounds;
    source.request_stop();
    return found;
  });
  EXPECT_EQ(plan.status, RouteStatus::Cancelled) << plan.reason;
  EXPECT_EQ(rounds, 1);
}

}  // namespace chassis_planner_test
}  // namespace talus::planner
