#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include <gmock/gmock.h>
#include <site_fixture.hpp>

#include <talus/costmap/costmap.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/problem.hpp>
#include <talus/terramech/mobility/turning.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace route_check_test {

using testing::drawn;
using testing::randomMap;

TEST(RouteCheck, RouteOnTraversableGroundHasNoViolation) {
  EXPECT_TRUE(violations(*drawn({"...", "..."}), {{0.5, 0.5}, {2.5, 1.5}}).empty());
}

TEST(RouteCheck, ViolationHasPlaceAndReason) {
  const auto found = violations(*drawn({".#.?."}), {{0.5, 0.5}, {4.5, 0.5}});
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0], (Violation{{1.5, 0.5}, "blocked for any heading"}));
  EXPECT_EQ(found[1], (Violation{{3.5, 0.5}, "unobserved cell"}));
}

// Property: a corner belongs to the cell north-east of it, and a route may end there whatever the other
// cells contain.
TEST(RouteCheck, RouteMayEndOnACellCorner) {
  const auto map = drawn({"...", "...", "#.."});
  EXPECT_TRUE(violations(*map, {{2.5, 2.5}, {1.0, 1.0}}).empty());
  EXPECT_TRUE(violations(*map, {{1.0, 1.0}, {2.5, 2.5}}).empty());
  EXPECT_FALSE(violations(*map, {{2.5, 2.5}, {1.0, 1.0}, {2.5, 1.5}}).empty()) << "it turns there";
  EXPECT_FALSE(violations(*drawn({"..#", "...", "..."}), {{0.5, 0.5}, {2.0, 2.0}}).empty()) << "in a wall";
}

TEST(RouteCheck, LeavingTheMapIsAViolation) {
  const auto found = violations(*drawn({"..."}), {{0.5, 0.5}, {0.5, 3.5}});
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].reason, "outside the map");
}

TEST(RouteCheck, CornerContactIsAViolation) {
  const auto map = drawn({"#.", ".#"});
  EXPECT_FALSE(violations(*map, {{0.5, 0.5}, {1.5, 1.5}}).empty());
  EXPECT_FALSE(violations(*map, {{0.5, 0.5}, {1.0, 1.0}, {1.5, 1.2}}).empty());
}

TEST(RouteCheck, TurnThroughTippingHeadingsIsAViolation) {
  terramech::Rover rover = costmap::testRover();
  rover.wheelbase_m = rover.track_m = 1.0;
  rover.centre_of_mass_height_m = 1.0;
  const auto map = testing::plane(20, {0.0, 0.6}, 0.0, std::make_shared<const terramech::RoverStance>(rover));
  EXPECT_TRUE(violations(*map, {{2.5, 2.5}, {6.5, 6.5}, {10.5, 9.5}}).empty());
  for (const maps::Point next : {maps::Point{2.5, 10.5}, maps::Point{10.5, 2.5}}) {
    const auto found = violations(*map, {{2.5, 2.5}, {6.5, 6.5}, next});
    EXPECT_TRUE(violationsOfChords(*map, {{2.5, 2.5}, {6.5, 6.5}, next}).empty())
        << "a drive may reverse there";
    ASSERT_EQ(found.size(), 1U);
    EXPECT_EQ(found[0],
              (Violation{{6.5, 6.5}, "turn through a heading that tips: centre of mass past the wheels"}));
  }
}

TEST(RouteCheck, TiltLimitDependsOnHeading) {
  // A slope of 0.2 eastwards with limits of 0.3 along and 0.1 across: allowed up and down, refused across.
  maps::Raster<costmap::CellCode> cells({.width = 3, .height = 3, .resolution_m = 1.0, .south_west = {}},
                                        costmap::CellCode({.dz_dx = 0.2, .dz_dy = 0.0, .curve = 0}));
  const auto map = costmap::flattened(cells, testing::driveCost({.max_along = 0.3, .max_across = 0.1}));
  EXPECT_TRUE(violations(map, {{0.5, 1.5}, {2.5, 1.5}}).empty());
  const auto across = violations(map, {{1.5, 0.5}, {1.5, 2.5}});
  ASSERT_FALSE(across.empty());
  EXPECT_EQ(across[0].reason, "slope across the heading above the roll limit");
}

// Property: a polyline has violations exactly if MotionCost is infinite and fine sampling meets a refusal.
TEST(RouteCheck, ViolationsMatchInfiniteMotionCostAndFineSampling) {
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

// A slope that steepens eastwards, on soil with a standard deviation.
costmap::TraversabilityMap steepening(const costmap::TravelPolicy& policy = {}) {
  costmap::MapLayers layers;
  const maps::Grid grid{.width = 120, .height = 20, .resolution_m = 0.5, .south_west = {}};
  layers.elevation.elevation_m = maps::Raster<float>(grid);
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column) {
      const double x = grid.centre({column, row}).x_m;
      layers.elevation.elevation_m[{column, row}] = static_cast<float>(0.5 * 0.006 * x * x);
    }
  return {std::move(layers), costmap::testGround(policy), {.footprint_radius_m = 1.0}};
}

// Closed form: for a normal estimate, the quantile of P(pull < gradient) is linear in the gradient with
// slope 1/std, and the first danger is reported where the probability exceeds the requested quantile.
TEST(RouteMonitor, DangerIsReportedWhereFailureProbabilityExceedsTheQuantile) {
  const costmap::TraversabilityMap map = steepening();
  const auto grid = map.published();
  const std::vector<maps::Point> up{{2.0, 5.25}, {58.0, 5.25}};
  const auto found = dangers(*grid, up, 0.02);
  ASSERT_GT(found.size(), 4U);
  const auto deviations = [](double p) {  // the inverse of the normal distribution, by bisection
    double low = -9.0, high = 9.0;
    for (int k = 0; k < 60; ++k)
      (0.5 * std::erfc(-0.5 * (low + high) / std::sqrt(2.0)) < p ? low : high) = 0.5 * (low + high);
    return low;
  };
  const auto gradient = [&](const Danger& d) { return grid->at(*grid->grid().cellAt(d.place)).dzDx(); };
  const Danger *first = &found.front(), *last = first;
  for (const Danger& d : found)
    if (d.probability < 1.0) last = &d;
  EXPECT_GT(first->probability, 0.02);
  EXPECT_LT(first->probability, 0.03);  // one cell further, a few thousandths of gradient
  EXPECT_NEAR(first->along_m, first->place.x_m - 2.0, 1e-9);
  const double std = map.costs().ground({60, 10})->pull.std;
  const double steepness =
      (deviations(last->probability) - deviations(first->probability)) / (gradient(*last) - gradient(*first));
  EXPECT_NEAR(steepness * std, 1.0, 0.15);  // bins of gradient are 1/256 wide
  for (std::size_t i = 1; i < found.size(); ++i) {
    EXPECT_GE(found[i].along_m, found[i - 1].along_m);
    EXPECT_GE(found[i].probability, found[i - 1].probability);
  }
}

// Property: a violation is a danger with probability 1 at any quantile; downhill no danger is reported.
TEST(RouteMonitor, ViolationsAreDangersWithProbabilityOne) {
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> share(0.01, 0.99);
  for (int trial = 0; trial < 50; ++trial) {
    const auto map = randomMap({.seed = static_cast<unsigned>(trial + 1)});
    const maps::Grid& grid = map->grid();
    std::vector<maps::Point> route;
    for (int k = 0; k < 6; ++k) route.push_back({grid.width * share(random), grid.height * share(random)});
    const auto hard = violations(*map, route);
    const auto found = dangers(*map, route, 0.5);
    std::vector<Violation> told;
    for (const Danger& d : found) {
      told.push_back({d.place, d.reason});
      EXPECT_EQ(d.probability, 1.0);
    }
    EXPECT_THAT(told, ::testing::UnorderedElementsAreArray(hard));
    EXPECT_TRUE(std::ranges::is_sorted(found, {}, &Danger::along_m));
  }
  EXPECT_TRUE(dangers(*steepening().published(), {{30.0, 5.25}, {2.0, 5.25}}).empty());
}

// Property: the entrapment probability changes the cost and not the reported dangers.
TEST(RouteMonitor, DangerIsIndependentOfEntrapmentProbability) {
  const std::vector<maps::Point> up{{2.0, 5.25}, {58.0, 5.25}};
  const auto usual = dangers(*steepening().published(), up, 0.02);
  ASSERT_GT(usual.size(), 4U);
  for (const double entrapment : {0.0, 1e-300, 1.0}) {
    costmap::TravelPolicy policy;
    policy.entrapment = entrapment;
    const auto found = dangers(*steepening(policy).published(), up, 0.02);
    ASSERT_EQ(found.size(), usual.size()) << entrapment;
    for (std::size_t i = 0; i < usual.size(); ++i)
      EXPECT_EQ(found[i].probability, usual[i].probability) << entrapment;
  }
}

// Property: a vertex at any distance outside the map is reported as outside the map.
TEST(RouteCheck, DistantVerticesAreOutsideTheMap) {
  const auto map = drawn({"....", "....", "...."});
  for (const double far : {1e3, 1e9, 1e14, 1e300}) {
    for (const maps::Point out : {maps::Point{far, 1.5}, maps::Point{1.5, -far}, maps::Point{-far, far}}) {
      const auto found = violations(*map, {{1.5, 1.5}, out, {2.5, 1.5}});
      ASSERT_FALSE(found.empty()) << far;
      for (const Violation& v : found) EXPECT_EQ(v.reason, "outside the map");
      EXPECT_FALSE(dangers(*map, {{1.5, 1.5}, out}).empty());
    }
  }
}

TEST(RouteMonitor, InvalidQuantileAndPositionAreRejected) {
  const auto map = drawn({"..."});
  for (const double quantile : {0.0, 1.0, -1.0, static_cast<double>(NAN)})
    EXPECT_THROW(dangers(*map, {{0.5, 0.5}}, quantile), std::invalid_argument);
  EXPECT_THROW(dangers(*map, {{0.5, NAN}}), std::invalid_argument);
  EXPECT_TRUE(dangers(*map, {}).empty());
}

}  // namespace route_check_test
}  // namespace talus::planner
