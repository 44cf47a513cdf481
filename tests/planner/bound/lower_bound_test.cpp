#include <algorithm>
#include <cmath>
#include <random>
#include <stop_token>
#include <string>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/grid/field_planner.hpp>
#include <talus/planner/route/polyline.hpp>

#include "drawn_map.hpp"

namespace talus::planner {

namespace lower_bound_test {

using testing::drawn;

// Closed form: the minimum over the curves that occur in cells: 10 J times the number of the curve plus one.
TEST(CheapestMetre, MinimumIsTakenOverCurvesInUse) {
  EXPECT_NEAR(cheapestMetre_J(*drawn({"234", "#?4"})), 30.0, 1e-5);
  EXPECT_NEAR(cheapestMetre_J(*drawn({"4.4"})), 10.0, 1e-5);
  EXPECT_EQ(cheapestMetre_J(*drawn({"#?"})), 0.0);
}

// Closed form: 10 J/m on level ground in every direction; the cheaper gradients of a ramp elsewhere do not
// count.
TEST(StraightBound, BoundEqualsStraightLineCostOnUniformGround) {
  const auto map = drawn(std::vector<std::string>(60, std::string(60, '.')));
  for (int k = 0; k < 24; ++k) {
    const double angle = 0.2618 * k + 0.1;
    const Segment ends{{30.2, 29.7}, {30.2 + 25.0 * std::cos(angle), 29.7 + 25.0 * std::sin(angle)}};
    const double cost_J = MotionCost(map)(ends);
    EXPECT_NEAR(straightBoundOver_J(*map, ends, 0.0, cost_J), cost_J, 1e-6 * cost_J) << k;
    EXPECT_NEAR(straightBoundOver_J(*map, ends, 5.0, cost_J), 0.8 * cost_J, 1e-6 * cost_J) << k;
    EXPECT_LE(straightBound_J(*map, ends), straightBoundOver_J(*map, ends, 0.0)) << k;
  }
}

// Closed form: 30 J/m; ground of 10 J/m lies so far aside that reaching it costs more than the straight
// line.
TEST(StraightBound, CheapGroundOutOfReachIsExcluded) {
  std::vector<std::string> rows(120, std::string(120, '2'));
  for (int k = 0; k < 20; ++k)
    rows[static_cast<std::size_t>(k)].replace(100, 20, std::string(20, '.'));  // north-east
  const auto map = drawn(rows);
  const Segment ends{{10.5, 10.5}, {30.5, 20.5}};
  const double cost_J = MotionCost(map)(ends);
  EXPECT_NEAR(straightBoundOver_J(*map, ends, 0.0, cost_J), cost_J, 1e-6 * cost_J);
  EXPECT_NEAR(straightBoundOver_J(*map, ends, 0.0), cost_J, 1e-6 * cost_J);
}

// Closed form: a track of 10 J/m begins 3 m behind the start and ends 3 m behind the goal. The detour over
// ground of 50 J/m at both ends and the track is cheaper than the straight line of 1000 J.
TEST(StraightBound, CheapTrackBehindTheStartIsIncluded) {
  std::vector<std::string> rows(60, std::string(100, '4'));
  const auto track = [&rows](int column, int y) {
    rows[static_cast<std::size_t>(59 - y)][static_cast<std::size_t>(column)] = '.';
  };
  for (int y = 30; y <= 48; ++y) track(37, y), track(63, y);
  for (int column = 37; column <= 63; ++column) track(column, 48);
  const auto map = drawn(rows);
  const Segment ends{{40.5, 30.5}, {60.5, 30.5}};
  const MotionCost cost(map);
  const double round_J =
      cost.along({ends.from, {37.5, 30.5}, {37.5, 48.5}, {63.5, 48.5}, {63.5, 30.5}, ends.to});
  ASSERT_LT(round_J, cost(ends));
  EXPECT_LE(straightBoundOver_J(*map, ends, 0.0), round_J);
  EXPECT_LE(straightBoundOver_J(*map, ends, 0.0, cost(ends)), round_J);
}

OctagonOf octagonsOf(const std::shared_ptr<const costmap::CostGrid>& map) {
  return [map, octagons = std::make_shared<FittedOctagons>(map->cost())](maps::Cell cell) {
    return octagons->of(map->at(cell));
  };
}

// Property: the field over the corners is below the cost of every allowed motion between two corners,
// straight or with one bend, in any heading; on uniform patches, where the bound is close to the cost.
TEST(AdmissibleEdges, FieldIsALowerBoundOfEveryMotion) {
  int tried = 0, sharp = 0;
  for (unsigned seed = 1; seed <= 8; ++seed) {
    std::mt19937 random(seed);
    const auto below = [&random](unsigned limit) { return static_cast<int>(random() % limit); };
    maps::Raster<costmap::CellCode> cells({.width = 24, .height = 24, .resolution_m = 2.0, .south_west = {}});
    std::vector<costmap::CellCode> patches;
    for (int k = 0; k < 9; ++k)
      patches.push_back(costmap::CellCode({.dz_dx = (below(300) - 150) / 1024.0,
                                           .dz_dy = (below(300) - 150) / 1024.0,
                                           .curve = static_cast<std::uint8_t>(below(3))}));
    for (int row = 0; row < 24; ++row)
      for (int column = 0; column < 24; ++column)
        cells[{column, row}] = patches[static_cast<std::size_t>(row / 8 * 3 + column / 8)];
    const auto map = std::make_shared<costmap::CostGrid>(costmap::flattened(cells, testing::driveCost()));
    const MotionCost cost(map);
    const auto edges = admissibleEdges(map, octagonsOf(map)),
               back = admissibleEdges(map, octagonsOf(map), {}, RouteSense::FromStart);
    ASSERT_TRUE(edges && back);
    const auto corner = [&below] { return maps::Cell{below(25), below(25)}; };
    const auto place = [](maps::Cell c) { return maps::Point{2.0 * c.column, 2.0 * c.row}; };
    for (int g = 0; g < 4; ++g) {
      const maps::Cell goal = corner();
      CostToGo field(edges, {{.cell = goal}}), from_there(back, {{.cell = goal}});
      ASSERT_TRUE(field.settleAll() && from_there.settleAll());
      for (int k = 0; k < 400; ++k) {
        const maps::Cell start = corner();
        const double cost_J = k % 2 == 0 ? cost({place(start), place(goal)})
                                         : cost.along({place(start), place(corner()), place(goal)});
        if (!std::isfinite(cost_J)) continue;
        ++tried;
        const auto bound_J = field.cost_J(start);
        ASSERT_TRUE(bound_J);
        ASSERT_LE(*bound_J, cost_J * (1 + 1e-9)) << seed;
        sharp += *bound_J > 0.85 * cost_J;
        const double back_J = cost({place(goal), place(start)});
        ASSERT_LE(*from_there.cost_J(start), back_J * (1 + 1e-9)) << seed;
      }
    }
  }
  EXPECT_GT(tried, 2'000);
  EXPECT_GT(sharp, 50);
}

TEST(AdmissibleEdges, StopYieldsNoEdges) {
  std::stop_source source;
  source.request_stop();
  const auto map = drawn({".."});
  const ProgressMonitor stopped{.progress = {}, .stop = source.get_token()};
  EXPECT_EQ(admissibleEdges(map, octagonsOf(map), stopped), nullptr);
}

TEST(AdmissibleEdges, ZeroCostGroundYieldsNoEdges) {
  const costmap::TravelCurve free_of_charge = testing::curveOf([](double) { return 0.0; });
  const maps::Raster<costmap::CellCode> cells(
      {.width = 3, .height = 3, .resolution_m = 1.0, .south_west = {}}, costmap::CellCode({.curve = 0}));
  const auto cost =
      std::make_shared<costmap::TravelCost>(costmap::TravelCost::Limits{}, std::vector{free_of_charge});
  const auto map = std::make_shared<costmap::CostGrid>(costmap::flattened(cells, cost));
  EXPECT_EQ(admissibleEdges(map, octagonsOf(map)), nullptr);
}

// Property: every planned route through a random place that costs at most the stated cost stays in the corridor, which
// leaves cells out.
TEST(LowerBound, CorridorContainsEveryRouteOfItsCost) {
  int inside = 0, outside = 0, left_out = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    // Every second map is level ground, on which the corridor is tight.
    const auto map =
        seed % 2 == 0
            ? testing::randomMap({.width = 40, .height = 30, .seed = seed, .blocked = 0.1, .roughness = 0.1})
            : drawn(std::vector<std::string>(30, std::string(40, '.')));
    FieldPlanner planner;
    Problem asked{.map = map, .start = {2.3, 2.7}, .goal = {35.2, 27.9}};
    const Plan best = planner.plan(asked);
    if (best.status != RouteStatus::Found) continue;
    const double most_J = 1.1 * best.cost_J;
    const auto corridor = LowerBound().corridor(map, {asked.start, asked.goal}, 0.0, most_J);
    ASSERT_EQ(corridor.size(), map->grid().size());
    left_out += static_cast<int>(std::ranges::count(corridor, false));
    std::mt19937 random(seed);
    for (int k = 0; k < 60; ++k) {
      asked.via = {{0.1 * static_cast<double>(random() % 400), 0.1 * static_cast<double>(random() % 300)}};
      const Plan plan = planner.plan(asked);
      if (plan.status != RouteStatus::Found || plan.cost_J > most_J) {
        ++outside;
        continue;
      }
      ++inside;
      for (const maps::Point vertex : plan.points)
        EXPECT_TRUE(corridor[map->grid().index(*map->grid().cellAt(vertex))]) << seed << ' ' << k;
    }
  }
  EXPECT_GT(inside, 10);
  EXPECT_GT(outside, 10);
  EXPECT_GT(left_out, 100);
}

// Closed form: 10 J/m; a bound over corners of cells alone would be up to 7.6 % too low.
TEST(LowerBound, BoundEqualsStraightLineCostOnUniformGround) {
  const auto map = drawn(std::vector<std::string>(200, std::string(200, '.')));
  const Segment ends{{10.5, 10.5}, {190.5, 80.5}};
  const double best = 10.0 * std::hypot(180.0, 70.0);
  EXPECT_NEAR(LowerBound()(map, ends, 0.0), best, 1e-9 * best);
}

TEST(LowerBound, ToleranceLowersTheBound) {
  const auto map = drawn(std::vector<std::string>(60, std::string(60, '.')));
  const Segment ends{{5.5, 5.5}, {50.5, 50.5}};
  EXPECT_LT(LowerBound()(map, ends, 20.0), LowerBound()(map, ends, 0.0));
}

// Closed form: 50 m along a track of 1 J/m cost 50 J, although climbing on the track costs a thousand times
// as much and the ground beside the track ten times as much.
TEST(LowerBound, BoundIsValidIfSlopeCostDominatesRollingCost) {
  const costmap::TravelCurve ground = testing::curveOf([](double) { return 10.0; }),
                             track =
                                 testing::curveOf([](double g) { return std::max(0.1, 1.0 + 1000.0 * g); });
  maps::Raster<costmap::CellCode> cells({.width = 60, .height = 20, .resolution_m = 1.0, .south_west = {}},
                                        costmap::CellCode({.curve = 1}));
  for (int column = 0; column < 60; ++column) cells[{column, 10}] = costmap::CellCode({.curve = 0});
  const auto cost =
      std::make_shared<costmap::TravelCost>(costmap::TravelCost::Limits{}, std::vector{track, ground});
  const auto map = std::make_shared<costmap::CostGrid>(costmap::flattened(cells, cost));
  const Segment ends{{5.5, 10.5}, {55.5, 10.5}};
  EXPECT_NEAR(MotionCost(map)(ends), 50.0, 1e-6);
  EXPECT_LE(LowerBound()(map, ends, 0.0), 50.0);
}

}  // namespace lower_bound_test

}  // namespace talus::planner
