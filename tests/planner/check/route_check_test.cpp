#include <cmath>
#include <random>

#include <talus/planner/check/route_check.hpp>
#include <talus/planner/route/motion_cost.hpp>
#include <talus/planner/route/problem.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace {

using testing::drawn;
using testing::randomMap;

TEST(RouteCheck, FindsNothingOnGoodGround) {
  EXPECT_TRUE(violations(*drawn({"...", "..."}), {{0.5, 0.5}, {2.5, 1.5}}).empty());
}

TEST(RouteCheck, NamesPlaceAndReason) {
  const auto found = violations(*drawn({".#.?."}), {{0.5, 0.5}, {4.5, 0.5}});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0], (Violation{{1.5, 0.5}, "blocked for any heading"}));
  EXPECT_EQ(found[1], (Violation{{3.5, 0.5}, "unobserved cell"}));
}

TEST(RouteCheck, WhatIsNotAllowedIsNotHandedOut) {
  const auto map = drawn({".#."});
  Plan plan;
  plan.points = {{0.5, 0.5}, {0.9, 0.5}};
  EXPECT_FALSE(refusal(plan, *map, 0.0));
  plan.drive = {.start = {{0.5, 0.5}, 0.0}, .legs = {{{1.0, 0.0}, 0.0}}};  // the drive goes on into the wall
  EXPECT_TRUE(refusal(plan, *map, 0.0));
  plan.drive = {};
  plan.points.push_back({2.5, 0.5});
  EXPECT_EQ(refusal(plan, *map, 0.0), (Violation{{1.5, 0.5}, "blocked for any heading"}));
}

// A corner belongs to the cell north-east of it: a route may end there whatever lies in the others.
TEST(RouteCheck, ARouteMayEndOnACornerOfCells) {
  const auto map = drawn({"...", "...", "#.."});
  EXPECT_TRUE(violations(*map, {{2.5, 2.5}, {1.0, 1.0}}).empty());
  EXPECT_TRUE(violations(*map, {{1.0, 1.0}, {2.5, 2.5}}).empty());
  EXPECT_FALSE(violations(*map, {{2.5, 2.5}, {1.0, 1.0}, {2.5, 1.5}}).empty()) << "it turns there";
  EXPECT_FALSE(violations(*drawn({"..#", "...", "..."}), {{0.5, 0.5}, {2.0, 2.0}}).empty()) << "in a wall";
}

TEST(RouteCheck, LeavingTheMapIsOne) {
  const auto found = violations(*drawn({"..."}), {{0.5, 0.5}, {0.5, 3.5}});
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].reason, "outside the map");
}

TEST(RouteCheck, CornersCount) {
  const auto map = drawn({"#.", ".#"});
  EXPECT_FALSE(violations(*map, {{0.5, 0.5}, {1.5, 1.5}}).empty());
  EXPECT_FALSE(violations(*map, {{0.5, 0.5}, {1.0, 1.0}, {1.5, 1.2}}).empty());
}

TEST(RouteCheck, TiltDependsOnTheHeading) {
  // A slope of 0.2 eastwards under limits of 0.3 along and 0.1 across: up and down it, not across it.
  maps::Raster<costmap::CellCode> cells({.width = 3, .height = 3, .resolution_m = 1.0, .south_west = {}},
                                        costmap::CellCode({.dz_dx = 0.2, .dz_dy = 0.0, .curve = 0}));
  const auto map = costmap::flattened(cells, testing::driveCost({.max_along = 0.3, .max_across = 0.1}));
  EXPECT_TRUE(violations(map, {{0.5, 1.5}, {2.5, 1.5}}).empty());
  const auto across = violations(map, {{1.5, 0.5}, {1.5, 2.5}});
  ASSERT_FALSE(across.empty());
  EXPECT_EQ(across[0].reason, "slope across the heading above the roll limit");
}

// Property: a polyline has violations exactly where MotionCost is infinite, and where fine sampling meets a
// refusal.
TEST(RouteCheck, AgreesWithMotionCostAndFineSampling) {
  std::mt19937 random(11);
  const auto coordinate = [&random] { return 20.0 * static_cast<double>(random()) / 4294967296.0; };
  int refused = 0;
  for (unsigned seed = 1; seed <= 400; ++seed) {
    const auto map = randomMap({.seed = seed, .blocked = 0.03, .roughness = 0.22});
    const MotionCost cost(map);
    std::vector<maps::Point> route;
    for (int k = 0; k < 3; ++k) route.push_back({coordinate(), coordinate()});
    if (seed % 2 == 0)
      for (auto& p : route) p = {std::floor(p.x_m) + 0.5, std::floor(p.y_m) + 0.5};
    bool sampled = false;
    for (std::size_t i = 1; i < route.size(); ++i) {
      const maps::Point a = route[i - 1], b = route[i];
      const double length = std::hypot(b.x_m - a.x_m, b.y_m - a.y_m);
      for (double t = 0.0005; t < 1.0; t += 0.001) {
        const auto cell = map->grid().cellAt({a.x_m + t * (b.x_m - a.x_m), a.y_m + t * (b.y_m - a.y_m)});
        const costmap::Direction heading{(b.x_m - a.x_m) / length, (b.y_m - a.y_m) / length};
        sampled = sampled || std::isinf(map->cost().costPerMetre(map->at(*cell), heading));
      }
    }
    const bool found = !violations(*map, route).empty();
    EXPECT_EQ(found, std::isinf(cost.along(route))) << seed;
    if (sampled) {
      EXPECT_TRUE(found) << seed;
    }
    refused += found ? 1 : 0;
  }
  EXPECT_GT(refused, 50);
  EXPECT_LT(refused, 350);
}

}  // namespace
}  // namespace talus::planner
