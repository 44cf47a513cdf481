#include <cmath>
#include <numbers>
#include <random>

#include <talus/planner/bench/slip_world.hpp>
#include <talus/planner/check/annotation.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/pose/pose_planner.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace pose_planner_test {

using testing::randomMap;

Problem across(const std::shared_ptr<const costmap::CostGrid>& map, double radius_m) {
  return {.map = map,
          .start = {2.5, 2.5},
          .goal = {37.5, 35.5},
          .kinematics = {.turning_radius_m = radius_m,
                         .turns = {.on_arc = {.energy_J = 1.0, .time_s = 1.0},
                                   .in_place = {.energy_J = 4.0, .time_s = 1.0},
                                   .at_vertex = {}},
                         .cusp = {.energy_J = 2.5, .time_s = 0.5}}};
}

// Whether the exact arcs, sampled every hundredth of a metre, are allowed in the heading of each point.
bool drivable(const costmap::CostGrid& map, const PosePath& drive) {
  Pose pose = drive.start;
  for (const auto& leg : drive.legs) {
    const int steps = 1 + static_cast<int>(std::abs(leg.arc.length_m) / 0.01 + std::abs(leg.turn_rad) / 0.01);
    const double side = leg.arc.length_m < 0.0 ? std::numbers::pi : 0.0;
    for (int k = 0; k < steps; ++k) {
      const double share = (k + 0.5) / steps;
      const Pose at =
          after(pose, PosePath::Leg{{leg.arc.length_m * share, leg.arc.curvature_1_m}, leg.turn_rad * share});
      const double way = at.heading_rad + side;
      const auto cell = map.grid().cellAt(at.place);
      if (!cell || std::isinf(map.cost().costPerMetre(map.at(*cell), {std::cos(way), std::sin(way)})))
        return false;
    }
    pose = after(pose, leg);
  }
  return true;
}

TEST(PosePlanner, ReturnedDrivesAreValidUnderDenseSampling) {
  // Property: on random ground, with and without reversing and turning in place, each drive passes dense
  // sampling of its arcs, has the requested start and end, and costs at least the bound.
  int found = 0;
  for (unsigned seed = 1; seed <= 12; ++seed)
    for (const double radius_m : {0.0, 1.5, 3.0})
      for (const bool reverse : {true, false}) {
        const auto map =
            randomMap({.width = 40, .height = 40, .seed = seed, .blocked = 0.06, .roughness = 0.2});
        Problem problem = across(map, radius_m);
        problem.kinematics.may_reverse = reverse;
        problem.start_heading_rad = 0.3 * seed;
        const Plan plan = PosePlanner().plan(problem);
        if (plan.status != RouteStatus::Found) continue;
        ++found;
        EXPECT_TRUE(drivable(*map, plan.drive)) << "seed " << seed << " radius " << radius_m;
        EXPECT_EQ(plan.points.front(), problem.start);
        EXPECT_NEAR(plan.points.back().x_m, 37.5, 1e-6);
        EXPECT_NEAR(plan.points.back().y_m, 35.5, 1e-6);
        EXPECT_NEAR(std::remainder(plan.drive.start.heading_rad - 0.3 * seed, 2 * std::numbers::pi), 0.0,
                    1e-9);
        EXPECT_GE(plan.cost_J, plan.lower_bound_J);
        const RouteShape made = shape(plan.drive);
        if (radius_m > 0.0) {
          EXPECT_LE(made.max_curvature_1_m, 1.0 / radius_m + 1e-9);
        }
        if (!reverse) {
          EXPECT_EQ(made.cusps, 0);
        }
      }
  EXPECT_GT(found, 40);
}

// Property: vertices are distinct except at turns and reversals. (Arcs of 1e-8 m at the end of a curve have
// no usable heading and must not become vertices.)
TEST(PosePlanner, VerticesAreDistinctExceptAtTurnsAndReversals) {
  int found = 0, together = 0;
  for (unsigned seed = 1; seed <= 12; ++seed)
    for (const double radius_m : {0.0, 1.5, 3.0}) {
      const auto map =
          randomMap({.width = 40, .height = 40, .seed = seed, .blocked = 0.06, .roughness = 0.2});
      const Plan plan = PosePlanner().plan(across(map, radius_m));
      if (plan.status != RouteStatus::Found) continue;
      ++found;
      const auto chord = chords(plan.drive, *map);
      for (std::size_t i = 1; i < chord.size(); ++i)
        together += std::hypot(chord[i].place.x_m - chord[i - 1].place.x_m,
                               chord[i].place.y_m - chord[i - 1].place.y_m) < 0.01
                        ? 1
                        : 0;
      const Route route = annotated(plan, {.map = *map});
      for (std::size_t i = 1; i < route.vertices.size(); ++i) {
        const RouteVertex &a = route.vertices[i - 1], &b = route.vertices[i];
        if (a.turn_rad != 0.0 || b.turn_rad != 0.0 || a.reverse != b.reverse) continue;
        EXPECT_GE(std::hypot(b.x_m - a.x_m, b.y_m - a.y_m), 0.01)
            << "seed " << seed << " radius " << radius_m << " vertex " << i << " of "
            << route.vertices.size();
      }
      Polyline way;
      for (const RouteVertex& v : route.vertices) way.push_back({v.x_m, v.y_m});
      EXPECT_TRUE(violations(*map, way).empty()) << "seed " << seed << " radius " << radius_m;
    }
  EXPECT_GT(found, 20);
  EXPECT_GT(together, 10);
}

TEST(PosePlanner, HeadingIsContinuousAtViaPoints) {
  const auto map = randomMap({.width = 40, .height = 40, .seed = 4, .blocked = 0.0, .roughness = 0.1});
  Problem problem = across(map, 2.0);
  problem.via = {{30.5, 5.5}};
  const Plan plan = PosePlanner().plan(problem);
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  double nearest_m = 100.0;
  for (const Pose& pose : sampled(plan.drive, 0.05))
    nearest_m = std::min(nearest_m, std::hypot(pose.place.x_m - 30.5, pose.place.y_m - 5.5));
  EXPECT_LT(nearest_m, 0.06);
}

TEST(PosePlanner, ReportCountsTurns) {
  // Closed form: on level ground of 10 J/m a quarter turn in place takes 4 J and one second per radian.
  const auto map = testing::drawn(std::vector<std::string>(12, std::string(20, '.')));
  Problem problem = across(map, 0.0);
  problem.goal = {12.5, 2.5};
  problem.start_heading_rad = std::numbers::pi / 2;
  problem.kinematics.may_reverse = false;
  problem.kinematics.stop = {.energy_J = 6.0, .time_s = 2.0};  // cost of the stop as well
  problem.kinematics.turns.on_arc.energy_J = 50.0;             // makes every arc too expensive
  const Plan plan = PosePlanner().plan(problem);
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  EXPECT_NEAR(plan.cost_J, 108.0 + 5.0 * std::numbers::pi / 2, 1e-3);
  const Route route = annotated(plan, {.map = *map, .kinematics = problem.kinematics});
  EXPECT_NEAR(route.energy_J, 6.0 + 4.0 * std::numbers::pi / 2,
              1e-9);  // the drawn map has no energy table
  EXPECT_NEAR(route.time_s, 2.0 + std::numbers::pi / 2, 1e-9);
  ASSERT_TRUE(route.drive.has_value());
  EXPECT_EQ(route.drive->turns_in_place, 1);
  EXPECT_NEAR(route.vertices.front().turn_rad, -std::numbers::pi / 2, 1e-9);
  EXPECT_NEAR(route.vertices.front().heading_rad, std::numbers::pi / 2, 1e-9);
  EXPECT_NEAR(route.vertices[1].heading_rad, 0.0, 1e-9);
}

TEST(PosePlanner, ArcIsPreferredToAStopForACheapBend) {
  // Property: if a stop costs more than the few extra cells of an arc, the drive rounds the corner on an
  // arc.
  std::vector<std::string> rows(24, std::string(24, '.'));
  for (std::size_t row = 6; row < 18; ++row) rows[row].replace(6, 12, 12, '#');
  Problem problem = across(testing::drawn(rows), 0.0);
  problem.start = {2.5, 6.5};
  problem.goal = {17.5, 21.5};
  problem.kinematics.stop = {.energy_J = 100.0};
  const Plan route = FieldPlanner().plan(problem);
  const Plan plan = PosePlanner().plan(problem);
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  EXPECT_EQ(shape(plan.drive).turns_in_place, 0);
  EXPECT_LT(plan.cost_J, route.cost_J + 50.0);
  EXPECT_TRUE(violations(*problem.map, plan.drive, 0.0).empty());
}

TEST(PosePlanner, ReverseVertexHasTheOppositeHeading) {
  const auto map = testing::drawn({"######", "#....#", "######"});
  Problem problem = across(map, 2.0);
  problem.start = {4.5, 1.5};
  problem.goal = {1.5, 1.5};
  problem.start_heading_rad = 0.0;
  const Plan plan = PosePlanner().plan(problem);
  ASSERT_EQ(plan.status, RouteStatus::Found) << plan.reason;
  const Route route = annotated(plan, {.map = *map});
  EXPECT_TRUE(route.vertices.front().reverse);
  EXPECT_NEAR(std::remainder(route.vertices.front().heading_rad, 2 * std::numbers::pi), 0.0, 1e-9);
}

TEST(RouteCheckOfDrives, ViolationsMatchDenseSamplingOfRandomArcs) {
  // Property: an arc that crosses a blocked cell by dense sampling is refused, and few other arcs are.
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int refused = 0, allowed = 0, grazing = 0;
  for (unsigned k = 0; k < 400; ++k) {
    const auto map = randomMap({.width = 16, .height = 16, .seed = k + 1, .blocked = 0.12, .roughness = 0.0});
    const double radius_m = 1.0 + 2.0 * unit(random), side = k % 2 ? 1.0 : -1.0;
    const PosePath arc{.start = {{5.0 + 6.0 * unit(random), 5.0 + 6.0 * unit(random)}, 7.0 * unit(random)},
                       .legs = {{{(k % 3 ? 4.0 : -4.0) * unit(random), side / radius_m}, 0.0}}};
    bool hit = false;
    for (const Pose& pose : sampled(arc, 0.002)) {
      const auto cell = map->grid().cellAt(pose.place);
      hit = hit || map->at(*cell).curve() >= map->cost().curves().size();
    }
    const bool found = !violations(*map, arc, radius_m).empty();
    EXPECT_TRUE(found || !hit) << k;
    refused += hit;
    allowed += !found;
    grazing += found && !hit;
  }
  EXPECT_GT(refused, 50);
  EXPECT_GT(allowed, 50);
  EXPECT_LE(grazing, 2);
}

TEST(RouteCheckOfDrives, TurnInPlaceRequiresEveryHeading) {
  const auto steep = testing::drawn({">"});
  const costmap::CostGrid grid({.grid = steep->grid(),
                                .tiles = steep->content().tiles,
                                .cost = testing::driveCost({.max_along = 0.3, .max_across = 0.1}),
                                .version = 1});
  EXPECT_TRUE(violations(grid, PosePath{.start = {{0.5, 0.5}, 0.0}, .legs = {{{}, 0.2}}}, 0.0).empty());
  EXPECT_FALSE(
      violations(grid, PosePath{.start = {{0.5, 0.5}, 0.0}, .legs = {{{}, std::numbers::pi}}}, 0.0).empty());
  EXPECT_FALSE(violations(grid, PosePath{.start = {{0.5, 0.5}, 0.0}, .legs = {{{}, 0.2}}}, 1.0).empty());
}

// Property: on steep, slippery worlds (slip_world.hpp), where a cell may be left in two narrow cones of
// headings only, a rover that turns in place at no cost can drive most routes of the field at little extra
// cost, and has another drive otherwise. The turns of a field route may pass infeasible headings, those of a
// drive may not: of the worlds 1001 to 1060 four have a drive that costs over 0.5 % more, or none.
TEST(PosePlanner, DrivesFollowFieldRoutesWithNarrowHeadingCones) {
  int dearer = 0;
  for (std::uint64_t seed = 1001; seed <= 1020; ++seed) {
    const SlipWorld world = slipWorld({.seed = seed});
    Problem problem{.map = world.map, .start = {8.5, 8.5}, .goal = {87.5, 87.5}, .prove = false};
    const Plan route = FieldPlanner().plan(problem);
    ASSERT_EQ(route.status, RouteStatus::Found);
    const Plan plan = PosePlanner().plan(problem);
    ASSERT_EQ(plan.status, RouteStatus::Found) << seed << ": " << plan.reason;
    dearer += plan.cost_J > 1.005 * route.cost_J;
    EXPECT_TRUE(drivable(*world.map, plan.drive)) << seed;
    EXPECT_TRUE(violations(*world.map, plan.drive, 0.0).empty()) << seed;
    EXPECT_TRUE(violations(*world.map, plan.points).empty()) << seed;
  }
  EXPECT_LE(dearer, 3);
}

// Property: if the field proves that no route exists, the plan of a drive returns the same status and reason,
// without advice on the heading.
TEST(PosePlanner, FieldProofOfNoRouteAppliesToDrives) {
  Problem problem{.map = testing::drawn({"......#......", "......#......", "......#......"}),
                  .start = {1.5, 1.5},
                  .goal = {11.5, 1.5},
                  .kinematics = {.turning_radius_m = 0.5}};
  const Plan field = FieldPlanner().plan(problem);
  ASSERT_EQ(field.status, RouteStatus::NoRoute);
  for (const double tolerance_m : {0.0, 1.0}) {
    problem.goal_tolerance_m = tolerance_m;
    PosePlanner planner;
    const Plan drive = planner.plan(problem);
    EXPECT_EQ(drive.status, RouteStatus::NoRoute);
    EXPECT_EQ(drive.reason, FieldPlanner().plan(problem).reason);
  }
}

// Property: with a tolerance the drive ends within it and costs no more than a drive to the goal itself,
// also if the goal's own cell is refused.
TEST(PosePlanner, DriveEndsWithinTheGoalTolerance) {
  int shorter = 0;
  for (unsigned seed = 1; seed <= 6; ++seed) {
    const auto map = randomMap({.width = 40, .height = 40, .seed = seed, .blocked = 0.04});
    Problem problem = across(map, 1.5);
    const Plan exact = PosePlanner().plan(problem);
    problem.goal_tolerance_m = 5.0;
    const Plan near = PosePlanner().plan(problem);
    if (exact.status != RouteStatus::Found) continue;
    ASSERT_EQ(near.status, RouteStatus::Found) << near.reason;
    EXPECT_LE(near.cost_J, exact.cost_J);
    EXPECT_LE(near.lower_bound_J, near.cost_J);
    EXPECT_LE(std::hypot(near.points.back().x_m - 37.5, near.points.back().y_m - 35.5), 5.0);
    EXPECT_TRUE(drivable(*map, near.drive));
    shorter += near.cost_J < exact.cost_J;
  }
  EXPECT_GT(shorter, 3);

  Problem blocked{
      .map = testing::drawn({"....................", ".................#..", "...................."}),
      .start = {1.5, 1.5},
      .goal = {17.5, 1.5},
      .kinematics = {.turning_radius_m = 0.5}};
  const Plan refused = PosePlanner().plan(blocked);
  EXPECT_EQ(refused.status, RouteStatus::GoalInvalid);
  EXPECT_EQ(refused.reason, FieldPlanner().plan(blocked).reason);
  blocked.goal_tolerance_m = 2.0;
  EXPECT_EQ(PosePlanner().plan(blocked).status, RouteStatus::Found);
}

}  // namespace pose_planner_test
}  // namespace talus::planner
