#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <stdexcept>

#include <gmock/gmock.h>
#include <site_fixture.hpp>

#include <talus/common/common.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/planner/check/annotation.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/check/route_ends.hpp>
#include <talus/planner/planner.hpp>
#include <talus/planner/route/problem.hpp>

#include "drawn_map.hpp"

namespace talus::planner {

namespace route_ends_test {

using Kind = CellJudgement::Kind;

CellJudgement judged(const costmap::CellCode::Parts& parts, costmap::TravelCost::Limits limits = {}) {
  return CellJudge(testing::driveCost(limits)).of(costmap::CellCode(parts));
}

TEST(CellJudge, MostExpensiveHeadingOnAPlaneIsUphill) {
  const double g = 0.125;  // a node of the table
  const CellJudgement hill = judged({.dz_dx = g, .curve = 0});
  EXPECT_EQ(hill.kind, Kind::Open);
  EXPECT_NEAR(hill.highest_J_per_m, 10.0 + 100.0 * g + 400.0 * g * g, 1e-4);  // Closed form
  EXPECT_NEAR(judged({.curve = 2}).highest_J_per_m, 30.0, 1e-4);              // Closed form: level
  EXPECT_NEAR(CellJudge(testing::driveCost()).level_J_per_m(), 10.0, 1e-4);   // Closed form: curve 0
}

TEST(CellJudge, KindFollowsFromRefusedHeadings) {
  EXPECT_EQ(judged({.curve = costmap::CellCode::kUnknown}).kind, Kind::Unknown);
  EXPECT_EQ(judged({.curve = costmap::CellCode::kBlocked}).kind, Kind::Refused);
  // Slope 0.33 with limits of 0.28 along and 0.17 across: every heading violates one of the limits.
  EXPECT_EQ(judged({.dz_dx = 0.33, .curve = 0}, {.max_along = 0.28, .max_across = 0.17}).kind, Kind::Refused);
  EXPECT_EQ(judged({.dz_dx = 0.3, .curve = 0}, {.max_along = 0.28, .max_across = 0.36}).kind,
            Kind::Restricted);
  EXPECT_TRUE(std::isinf(judged({.dz_dx = 0.3, .curve = 0}, {.max_along = 0.28}).highest_J_per_m));
  EXPECT_THROW(CellJudge(nullptr), std::invalid_argument);
}

// Closed form, by brute force: 720 headings of random cells, each evaluated separately.
TEST(CellJudge, MatchesBruteForceOverHeadings) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> gradient(-0.3, 0.3);
  const auto cost = testing::driveCost({.max_along = 0.28, .max_across = 0.17});
  CellJudge judge(cost);
  int kinds[4] = {};
  for (int k = 0; k < 500; ++k) {
    const costmap::CellCode cell({.dz_dx = gradient(random), .dz_dy = gradient(random), .curve = 3});
    const CellJudgement judgement = judge.of(cell);
    ++kinds[static_cast<int>(judgement.kind)];
    int allowed = 0;
    float highest = 0.0F;
    for (int drawn = 0; drawn < 720; ++drawn) {
      const double heading = drawn * 0.5 * kDegree;
      const float each = cost->costPerMetre(cell, {std::cos(heading), std::sin(heading)});
      allowed += std::isfinite(each) ? 1 : 0;
      highest = std::fmax(highest, each);
    }
    EXPECT_EQ(judgement.kind == Kind::Open, allowed == 720);
    EXPECT_TRUE(allowed == 0 || judgement.kind != Kind::Refused);
    // The most expensive of 64 headings is off by at most half their spacing: 1 - cos(pi / 64) = 0.12 % of
    // the gradients.
    if (judgement.kind != Kind::Open) continue;
    EXPECT_NEAR(judgement.highest_J_per_m / highest, 1.0F, 0.005F);
  }
  EXPECT_GT(kinds[1], 20);
  EXPECT_GT(kinds[2], 20);
  EXPECT_GT(kinds[3], 20);
}

using costmap::Hazard;
using maps::Point;
using ::testing::HasSubstr;

constexpr double kCell_m = 0.2;
constexpr int kSide = 40;

costmap::MapLayers layers(std::mt19937& random, int obstacles) {
  costmap::MapLayers out;
  const maps::Grid grid{
      .width = kSide, .height = kSide, .resolution_m = kCell_m, .south_west = {100.0, 50.0}};
  out.elevation.elevation_m = maps::Raster<float>(grid, 0.0F);
  out.classes = maps::Raster<std::uint8_t>(grid, 1);
  out.keep_out = maps::Raster<std::uint8_t>(grid, 0);
  std::uniform_int_distribution<int> place(0, kSide - 1);
  for (int k = 0; k < obstacles; ++k) out.keep_out[{place(random), place(random)}] = 1;
  return out;
}

// Places of the four outermost wheels.
std::vector<Point> wheels(const Pose& pose) {
  const terramech::Rover rover = costmap::testRover();
  std::vector<Point> out;
  const double reach_m = std::hypot(rover.wheelbase_m, rover.track_m) / 2.0,
               angle_rad = std::atan2(rover.track_m, rover.wheelbase_m);
  for (const double from_axis :
       {angle_rad, -angle_rad, std::numbers::pi - angle_rad, std::numbers::pi + angle_rad})
    out.push_back({pose.place.x_m + reach_m * std::cos(pose.heading_rad + from_axis),
                   pose.place.y_m + reach_m * std::sin(pose.heading_rad + from_axis)});
  return out;
}

// Brute force: a pose has a violation if a wheel stands on a cell with a hazard that the rover must avoid, or
// outside the map, and no other pose has one.
TEST(RouteEnds, WheelsStandOnTheMapAndOnNoHazard) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0.0, 1.0), heading(-4.0, 4.0);
  int refused = 0, allowed = 0;
  for (int world = 0; world < 20; ++world) {
    const costmap::TraversabilityMap map(layers(random, 8), costmap::testGround(), {});
    const auto& grid = map.grid();
    const auto cost = map.published();
    const HazardsOf hazards = [&map](maps::Cell cell) { return map.surface().hazards(cell); };
    for (int k = 0; k < 500; ++k) {
      const Pose pose{{100.0 + kSide * kCell_m * share(random), 50.0 + kSide * kCell_m * share(random)},
                      heading(random)};
      if (hazards(*grid.cellAt(pose.place)) != Hazard::None) continue;
      const bool on_hazard = std::ranges::any_of(wheels(pose), [&](const Point& wheel) {
        const auto cell = grid.cellAt(wheel);
        return !cell || has(hazards(*cell), costmap::kKeptClearOf);
      });
      EXPECT_EQ(violationsAtEnds(*cost, {pose}, hazards).size(), on_hazard ? 1U : 0U)
          << pose.place.x_m << "," << pose.place.y_m << " " << pose.heading_rad;
      ++(on_hazard ? refused : allowed);
    }
  }
  EXPECT_GT(refused, 200);
  EXPECT_GT(allowed, 3000);
}

TEST(RouteEnds, UnknownGroundIsNoViolationWhereThePolicyPermitsIt) {
  std::mt19937 random(7);
  costmap::MapLayers one = layers(random, 0);
  one.elevation.elevation_m[{20, 22}] = std::numeric_limits<float>::quiet_NaN();
  for (const bool permitted : {false, true}) {
    const costmap::TraversabilityMap map(one, costmap::testGround({.allow_unknown = permitted}), {});
    const HazardsOf hazards = [&map](maps::Cell cell) { return map.surface().hazards(cell); };
    // A front wheel stands on the unobserved cell, then outside of the map.
    const std::vector<Pose> poses{{{103.8, 54.1}, 0.5 * std::numbers::pi}, {{104.0, 57.8}, 0.9}};
    EXPECT_EQ(violationsAtEnds(*map.published(), poses, hazards).size(), permitted ? 0U : 2U);
    EXPECT_EQ(violationsAtEnds(*map.published(), poses).size(), permitted ? 0U : 2U);
  }
}

TEST(RouteEnds, RouteThatEndsWithAWheelOffTheMapIsRefused) {
  std::mt19937 random(7);
  const costmap::TraversabilityMap map(layers(random, 0), costmap::testGround(), {});
  // The heading 3 east, 4 north points one wheel to the north, 0.5 m from the centre; the border is at 58 m.
  Plan plan{.status = RouteStatus::Found, .points = {{102.2, 55.18}, {104.0, 57.58}}, .cost_J = 1.0};
  const Route route = checkedRoute(plan, {.map = *map.published(), .planner = "talus"});
  EXPECT_EQ(route.status, RouteStatus::NoneFound);
  EXPECT_THAT(route.reason, HasSubstr("a wheel would stand outside the map at the end 104.00,57.58"));
  EXPECT_THAT(route.reason, HasSubstr("more than 0.50 m away"));
  ASSERT_TRUE(route.refused);
  plan.points = {{102.2, 55.08}, {104.0, 57.48}};
  EXPECT_EQ(checkedRoute(plan, {.map = *map.published(), .planner = "talus"}).status, RouteStatus::Found);
}

// End to end: the straight route arrives with a wheel on a keep-out cell, 0.5 m from the goal.
TEST(RouteEnds, PlannedRouteEndsWithNoWheelOnAKeepOutArea) {
  std::mt19937 random(7);
  costmap::MapLayers one = layers(random, 0);
  for (const bool kept_out : {false, true}) {
    one.keep_out[{20, 22}] = kept_out ? 1 : 0;
    const costmap::TraversabilityMap map(one, costmap::testGround(), {});
    PlanRequest request{.start = {102.25, 51.59}, .goal = {104.05, 53.99}};
    request.hazards = [&map](maps::Cell cell) { return map.surface().hazards(cell); };
    const Route route = Planner().plan(map.published(), request);
    EXPECT_EQ(route.status, kept_out ? RouteStatus::NoneFound : RouteStatus::Found) << route.reason;
    EXPECT_THAT(route.reason, HasSubstr(kept_out ? "on ground to avoid at the end 104.05,53.99" : ""));
  }
}

TEST(RouteEnds, EndsOfADriveIncludeItsTurnsInPlaceThere) {
  const PosePath drive{.start = {{1.0, 2.0}, 0.0},
                       .legs = {{.turn_rad = 0.25},
                                {.arc = {2.0, 0.0}},
                                {.turn_rad = 1.0},
                                {.arc = {1.0, 0.5}},
                                {.arc = {1.0, 0.0}},
                                {.turn_rad = -0.15}}};
  const auto ends = endPoses(drive);
  // Three poses of the first turn after the start, and the arrival with one pose within the last turn.
  std::vector<double> headings_rad;
  for (const Pose& pose : ends) headings_rad.push_back(pose.heading_rad);
  ASSERT_THAT(headings_rad, ::testing::Pointwise(::testing::DoubleNear(1e-12),
                                                 {0.0, 0.25 / 3, 0.5 / 3, 0.25, 1.75, 1.675, 1.6}));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(ends[i].place.x_m, 1.0);
  for (std::size_t i = 5; i < 7; ++i) EXPECT_EQ(ends[i].place.x_m, ends[4].place.x_m);
  EXPECT_GT(ends[4].place.x_m, 2.0);
}

}  // namespace route_ends_test

}  // namespace talus::planner
