#include <map>
#include <memory>
#include <stop_token>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <site_fixture.hpp>

#include <talus/common/common.hpp>
#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/planner/reach/lifted_ground.hpp>
#include <talus/terramech/mobility/turning.hpp>

#include "contour_plane.hpp"
#include "drawn_map.hpp"

namespace talus::planner {

namespace lifted_ground_test {

using costmap::Hazard;
using maps::Cell;

// A map whose heights depend on x alone, with the gradients that its ground refuses.
struct Slopes {
  costmap::TraversabilityMap map;
  HazardsOf hazards = [this](Cell cell) { return map.surface().hazards(cell); };
  StepEdges edges{*map.published(), hazards, [](Cell, double gradient) { return gradient > 0.36; }};
};

template <typename Height>
std::unique_ptr<Slopes> slopes(Height height_m) {
  const maps::Grid grid{.width = 21, .height = 9, .resolution_m = 1.0, .south_west = {}};
  costmap::MapLayers layers{.elevation = {.elevation_m = maps::Raster<float>(grid, 0.0F)}};
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      layers.elevation.elevation_m[{column, row}] = static_cast<float>(height_m(column));
  return std::unique_ptr<Slopes>(new Slopes{{std::move(layers), costmap::testGround(), {}}});
}

// Closed form: a vertical step of 0.9 m on a plane of gradient 0.1. The plane remains after the step is
// removed.
TEST(StepEdges, ASheerStepIsFoundOnAPlane) {
  const auto at = slopes([](int column) { return 0.1 * column + (column > 10 ? 0.9 : 0.0); });
  for (const int column : {10, 11}) {
    ASSERT_TRUE(has(at->map.surface().hazards({column, 4}), Hazard::Step)) << column;
    EXPECT_EQ(at->edges.at({column, 4}), StepEdges::Kind::Sheer) << column;
    EXPECT_NEAR(at->edges.settled({column, 4}).dzDx(), 0.1, costmap::CellCode::kStep);
    EXPECT_NEAR(at->edges.settled({column, 4}).dzDy(), 0.0, costmap::CellCode::kStep);
    EXPECT_GT(at->map.published()->at({column, 4}).dzDx(), 0.3) << "the plane over the step tilts";
  }
  EXPECT_EQ(at->edges.at({4, 4}), StepEdges::Kind::None);
}

// Property: the edges of a bank exceed the step limit, but are attributed to the slope of the bank, because
// no rise exceeds the rises on both sides.
TEST(StepEdges, EdgesOfABankAreOfItsSlope) {
  const auto at = slopes([](int column) { return 0.6 * std::clamp(column - 7, 0, 6); });
  for (const int column : {7, 13}) {
    ASSERT_TRUE(has(at->map.surface().hazards({column, 4}), Hazard::Step)) << column;
    EXPECT_EQ(at->edges.at({column, 4}), StepEdges::Kind::Slope) << column;
  }
}

// Property: a bend between gradients that the ground allows is not the edge of a slope and remains a step.
TEST(StepEdges, ABendOfAllowedGradientsIsNoSlope) {
  const auto at = slopes([](int column) { return 0.3 * std::abs(column - 10); });
  ASSERT_TRUE(has(at->map.surface().hazards({10, 4}), Hazard::Step));
  EXPECT_EQ(at->edges.at({10, 4}), StepEdges::Kind::None);
}

// A map as by drawn(), with further symbols: 's' too steep in any heading, 'k' keep-out, 'r' rocks, 'n'
// inflation, 'e' a step edge, 'w' ground of curve 5, whose soil is too weak.
struct Site {
  std::shared_ptr<const costmap::CostGrid> map;
  HazardsOf hazards;
};

costmap::TravelCurve upTo(double steepest, double cost_J) {
  costmap::TravelCurve made = testing::curve({.factor = cost_J / 10.0, .steepest = steepest});
  return made;
}

Site site(const std::vector<std::string>& rows, double gradient = 0.0, double pitch = 0.3,
          double soil = 0.31) {
  static const std::map<char, Hazard> kinds{{'s', Hazard::Slope | Hazard::Roughness},
                                            {'k', Hazard::KeepOut},
                                            {'r', Hazard::Rocks | Hazard::Slope},
                                            {'n', Hazard::Near},
                                            {'e', Hazard::Step}};
  const maps::Grid grid{.width = static_cast<int>(rows[0].size()),
                        .height = static_cast<int>(rows.size()),
                        .resolution_m = 1.0,
                        .south_west = {}};
  maps::Raster<costmap::CellCode> cells(grid);
  auto hazards = std::make_shared<maps::Raster<Hazard>>(grid, Hazard::None);
  for (int r = 0; r < grid.height; ++r)
    for (int c = 0; c < grid.width; ++c) {
      const char drawing = rows[static_cast<std::size_t>(grid.height - 1 - r)][static_cast<std::size_t>(c)];
      costmap::CellCode::Parts parts{.dz_dx = gradient, .curve = 0};
      if (drawing == 's') parts.dz_dx = 0.3;
      if (drawing == '?') parts.curve = costmap::CellCode::kUnknown;
      if (drawing == 'w') parts.curve = 1;
      if (kinds.contains(drawing)) {
        parts.curve = costmap::CellCode::kBlocked;
        (*hazards)[{c, r}] = kinds.at(drawing);
      }
      cells[{c, r}] = costmap::CellCode(parts);
    }
  const costmap::TravelCurve nothing = upTo(-1.0, 10.0);
  return {std::make_shared<costmap::CostGrid>(costmap::flattened(
              cells, std::make_shared<costmap::TravelCost>(
                         costmap::TravelCost::Limits{.max_along = pitch, .max_across = 0.05},
                         std::vector{upTo(soil, 10.0), nothing}))),
          [hazards](maps::Cell cell) { return (*hazards)[cell]; }};
}

Obstruction between(const Site& ground, const Segment& places = {{1.5, 2.5}, {7.5, 2.5}}) {
  HeadingSets headings(ground.map->cost());
  Reach reach(*ground.map, headings, Reach::Sense::From, places.from);
  return obstructionBetween(*ground.map, headings, reach, places, 0.0, ground.hazards);
}

std::optional<Constraint> causeOf(const Site& ground, const Segment& places = {{1.5, 2.5}, {7.5, 2.5}}) {
  return between(ground, places).lifting;
}

std::vector<std::string> wall(char of) {
  std::vector<std::string> rows(5, "nnnnnnnnn");
  for (int r = 1; r < 4; ++r) rows[static_cast<std::size_t>(r)] = std::string("n...") + of + "...n";
  return rows;
}

// Property: the reported hazard blocks the route on its own, also beside another hazard; if each wall has
// another hazard, no hazard is reported.
TEST(LiftedGround, OnlyBlockingHazardIsReported) {
  EXPECT_EQ(between(site(wall('k'))).hazard, Hazard::KeepOut);
  EXPECT_EQ(between(site(wall('r'))).hazard, Hazard::Rocks);
  EXPECT_EQ(between(site(wall('e'))).hazard, Hazard::Step);
  EXPECT_FALSE(between(site(wall('s'))).hazard);
  std::vector<std::string> rows = wall('k');
  rows[1][2] = 'r';
  const Obstruction found = between(site(rows));
  EXPECT_EQ(found.hazard, Hazard::KeepOut);
  EXPECT_THAT(text(found, {{1.5, 2.5}, {7.5, 2.5}}),
              ::testing::HasSubstr("keep-out areas, or cells that a layer"));
  for (std::string& row : rows)
    if (row[1] != 'n') row[5] = 'r';
  EXPECT_EQ(between(site(rows)).lifting, Constraint::Hazard);
  EXPECT_FALSE(between(site(rows)).hazard);
}

// A strip so narrow that the rim's clearance covers all of it in the middle.
TEST(LiftedGround, RimClearanceIsReported) {
  EXPECT_EQ(causeOf(site({"..nnnnn..", "..nnnnn.."}), {{0.5, 0.5}, {8.5, 0.5}}), Constraint::Rim);
}

// Property: a slope that exceeds both the limit and the soil's capacity is reported, although removing one
// of them opens no route.
TEST(LiftedGround, SlopeRefusedByLimitAndSoilIsReported) {
  const std::vector<std::string> plain(5, ".........");
  const Site steep = site(plain, 0.5, 0.1, 0.102);
  costmap::CostGrid::Content content = steep.map->content();
  const auto weak = [&](double margin) {
    costmap::TravelState state;
    state.energy_J_per_m = 10.0F;
    state.pull_margin = static_cast<float>(margin);
    auto table = std::make_shared<costmap::TabulatedStates>(
        std::vector<costmap::TravelState>(costmap::TravelCurve::kBins, state));
    auto made = content;
    made.cost = std::make_shared<costmap::TravelCost>(
        costmap::TravelCost::Limits{.max_along = 0.1, .max_across = 0.05},
        std::vector<costmap::GroundCost>{
            {.curve = testing::crossed(upTo(0.102, 10.0), 0.02, 2), .states = table}});
    return Site{std::make_shared<costmap::CostGrid>(std::move(made)), steep.hazards};
  };
  EXPECT_EQ(causeOf(weak(0.5)), Constraint::Pitch) << "the soil gives enough beyond the limit";
  EXPECT_EQ(causeOf(weak(0.2)), Constraint::Slope);
}

// Property: the clearance from the rim around a field of weak soil is not a passage; otherwise the reason
// would be "hazards".
TEST(LiftedGround, RimClearanceIsNoPassage) {
  std::vector<std::string> rows = wall('w');
  EXPECT_EQ(causeOf(site(rows)), Constraint::Soil);
  for (std::string& row : rows) row[4] = 'w';
  EXPECT_EQ(causeOf(site(rows)), Constraint::Soil);
}

// Property: a slope at the pitch limit is attributed to the limit if the soil's table ends there, and to the
// soil if its capacity ends before.
TEST(LiftedGround, PitchLimitIsReportedIfSoilCapacityReachesIt) {
  const std::vector<std::string> plain(5, ".........");
  EXPECT_EQ(causeOf(site(plain, 0.2, 0.1, 0.102)), Constraint::Pitch);
  EXPECT_EQ(causeOf(site(plain, 0.2, 0.1, 0.25)), Constraint::Pitch);
  EXPECT_EQ(causeOf(site(plain, 0.2, 0.3, 0.1)), Constraint::Soil);
  EXPECT_EQ(causeOf(site(plain, 0.2, 0.1, 0.05)), Constraint::Roll)
      << "straight up soil and limit refuse it, in turns they do not";
}

// Property: for a rover that tips on cross slopes, an uphill slope within the soil's capacity but above the
// pitch limit is not attributed to the soil.
TEST(LiftedGround, TippingIsNotAttributedToTheSoil) {
  terramech::Rover rover = costmap::testRover();
  rover.wheelbase_m = 2.0;
  rover.track_m = 0.6;
  rover.centre_of_mass_height_m = 1.2;
  const costmap::TravelCost::Limits limits{
      .max_along = 0.15, .max_across = 0.9, .stance = std::make_shared<const terramech::RoverStance>(rover)};
  Site ground = site(std::vector<std::string>(9, "........."), 0.3, 0.15, 0.6);
  costmap::CostGrid::Content content = ground.map->content();
  // Refused across from 0.25 on, where the rover tips.
  const costmap::TravelCurve curve = testing::crossed(upTo(0.155, 10.0), 0.0, 15);
  content.cost = std::make_shared<costmap::TravelCost>(limits, std::vector{curve});
  ground.map = std::make_shared<costmap::CostGrid>(std::move(content));
  EXPECT_EQ(causeOf(ground, {{1.5, 4.5}, {7.5, 4.5}}), Constraint::Pitch);
}

}  // namespace lifted_ground_test

namespace obstruction_search_test {

using testing::drawn;

Obstruction between(const std::shared_ptr<const costmap::CostGrid>& map, const Segment& places) {
  HeadingSets headings(map->cost());
  Reach reach(*map, headings, Reach::Sense::From, places.from);
  return obstructionBetween(*map, headings, reach, places, 0.0);
}

TEST(ObstructionSearch, ReportsBothCellSetsAndTheConstraintBetween) {
  const auto map = drawn({"..#..", "..#..", "..#.."});
  const Segment places{{0.5, 0.5}, {3.5, 1.5}};
  const Obstruction found = between(map, places);
  EXPECT_EQ(found.cells_from_start, 6U);
  EXPECT_EQ(found.cells_to_goal, 6U);
  EXPECT_NEAR(found.first.x_m - found.last.x_m, 2.0, 1e-9);
  ASSERT_TRUE(found.lifting);
  EXPECT_EQ(*found.lifting, Constraint::Hazard);
  EXPECT_THAT(text(found, places),
              ::testing::AllOf(::testing::HasSubstr("6 cells are reachable from the start, 6 lead"),
                               ::testing::HasSubstr("keep-out")));
}

// Property: a stop ends the flood fill between the sets and the search for a constraint; the result contains
// the places only.
TEST(ObstructionSearch, StopEndsTheSearch) {
  const auto map = drawn({"..#..", "..#..", "..#.."});
  const Segment places{{0.5, 0.5}, {3.5, 1.5}};
  HeadingSets headings(map->cost());
  Reach reach(*map, headings, Reach::Sense::From, places.from);
  std::stop_source source;
  source.request_stop();
  const Obstruction found = obstructionBetween(*map, headings, reach, places, 0.0, {},
                                               ProgressMonitor{.progress = {}, .stop = source.get_token()});
  EXPECT_FALSE(found.tried);
  EXPECT_FALSE(found.lifting);
  EXPECT_EQ(found.last, places.from);
  EXPECT_EQ(found.first, places.to);
}

}  // namespace obstruction_search_test

}  // namespace talus::planner
