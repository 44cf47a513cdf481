#include <cmath>

#include <gtest/gtest.h>
#include <ompl/base/ProjectionEvaluator.h>
#include <ompl/base/ScopedState.h>

#include <talus/planner/sampling/map_space.hpp>

namespace talus::planner {
namespace map_space_test {

const maps::Grid kGrid{.width = 40, .height = 30, .resolution_m = 2.5, .south_west = {-7.0, 1000.0}};

// Property: every place within the bounds, including the corners, lies in a cell of the map; a place outside
// is moved to the nearest of them.
TEST(MapSpace, PlacesWithinBoundsLieOnTheMap) {
  const auto space = std::make_shared<MapSpace>(kGrid);
  space->setup();
  ompl::base::ScopedState<MapSpace> state(space);
  for (const maps::Point place : {maps::Point{-99.0, -99.0}, {1e9, 1e9}, {-7.0, 1075.0}, {93.0, 1000.0}}) {
    MapSpace::setPlace(state.get(), place);
    space->enforceBounds(state.get());
    EXPECT_TRUE(kGrid.cellAt(MapSpace::place(state.get()))) << place.x_m << "," << place.y_m;
  }
  MapSpace::setPlace(state.get(), {1e9, 1030.0});
  space->enforceBounds(state.get());
  EXPECT_NEAR(MapSpace::place(state.get()).x_m, 93.0, 1e-9);  // Closed form: -7 + 40 * 2.5
  EXPECT_EQ(MapSpace::place(state.get()).y_m, 1030.0);
}

// Closed form: metres of the map plane, and projection cells of 16 x 2.5 m.
TEST(MapSpace, DistanceIsInMetresAndProjectionCellsAreSixteenCells) {
  const auto space = std::make_shared<MapSpace>(kGrid);
  space->setup();
  ompl::base::ScopedState<MapSpace> a(space), b(space);
  MapSpace::setPlace(a.get(), {0.0, 1010.0});
  MapSpace::setPlace(b.get(), {30.0, 1050.0});
  EXPECT_DOUBLE_EQ(space->distance(a.get(), b.get()), 50.0);
  EXPECT_EQ(space->getDefaultProjection()->getCellSizes(), (std::vector<double>{40.0, 40.0}));
}

}  // namespace map_space_test
}  // namespace talus::planner
