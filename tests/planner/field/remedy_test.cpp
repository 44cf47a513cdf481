#include <talus/planner/field/remedy.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace {

using testing::drawn;

TEST(Remedy, APlaceIsNamedWithItsFaultAndTheNearestGround) {
  const auto map = drawn({"..#?.", "..##."});
  EXPECT_EQ(invalidPlace(*map, "start", {2.6, 0.5}),
            "start 2.60,0.50 lies on a blocked cell; the nearest traversable cell is 1.50,0.50");
  EXPECT_EQ(invalidPlace(*map, "goal", {3.9, 1.5}),
            "goal 3.90,1.50 lies on an unobserved cell; the nearest traversable cell is 4.50,1.50");
  EXPECT_EQ(invalidPlace(*map, "goal", {9.0, 0.5}),
            "goal 9.00,0.50 lies outside the map; the nearest traversable cell is 4.50,0.50");
}

TEST(Remedy, GroundTooSteepForEveryHeadingIsDangerous) {
  maps::Raster<costmap::CellCode> steep({.width = 2, .height = 1, .resolution_m = 1.0, .south_west = {}},
                                        costmap::CellCode({.dz_dx = 0.9, .dz_dy = 0.9, .curve = 0}));
  const costmap::CostGrid map = costmap::flattened(steep, testing::driveCost());
  EXPECT_EQ(invalidPlace(map, "start", {0.5, 0.5}),
            "start 0.50,0.50 lies on a dangerous cell: no heading is allowed there; no cell of this map is "
            "traversable");
}

// Closed form: six cells west of the wall; the nearest of them to the goal is two metres off.
TEST(Remedy, NoWayCountsWhatTheStartReaches) {
  const auto map = drawn({"..#..", "..#..", "..#.."});
  const EdgeLayer edges(map, EdgeUnits(map->cost(), 1.0));
  EXPECT_EQ(noWay(edges, {0.5, 0.5}, {3.5, 1.5}),
            "no route from 0.50,0.50 to 3.50,1.50: reachable from the start: 6 cells; the nearest of them to "
            "the goal is 1.50,1.50 (2.0 m from the goal)");
}

// A cliff is climbed by nobody and may yet be descended: cells are counted the way they are driven.
TEST(Remedy, ReachIsAlongTheDrive) {
  costmap::DriveCurve down_only = testing::curve({});
  for (int bin = costmap::DriveCurve::kBins / 2 + 1; bin < costmap::DriveCurve::kBins; ++bin)
    down_only.cost_J_per_m[static_cast<std::size_t>(bin)] = std::numeric_limits<float>::infinity();
  maps::Raster<costmap::CellCode> ramp({.width = 4, .height = 1, .resolution_m = 1.0, .south_west = {}},
                                       costmap::CellCode({.dz_dx = 0.2, .dz_dy = 0.0, .curve = 0}));
  const auto map = std::make_shared<costmap::CostGrid>(costmap::flattened(
      ramp, std::make_shared<costmap::DriveCost>(costmap::DriveCost::Limits{}, std::vector{down_only})));
  const EdgeLayer edges(map, EdgeUnits(map->cost(), 1.0));
  EXPECT_THAT(noWay(edges, {1.5, 0.5}, {3.5, 0.5}),
              ::testing::HasSubstr("reachable from the start: 2 cells"));
}

}  // namespace
}  // namespace talus::planner
