#include <memory>

#include <gtest/gtest.h>
#include <site_fixture.hpp>

#include <talus/costmap/map/traversability_map.hpp>
#include <talus/planner/reach/step_edges.hpp>

namespace talus::planner {
namespace step_edges_test {

using costmap::Hazard;
using maps::Cell;

// A map whose heights depend on x alone, with the gradients that its ground refuses.
struct Site {
  costmap::TraversabilityMap map;
  HazardsOf hazards = [this](Cell cell) { return map.surface().hazards(cell); };
  StepEdges edges{*map.published(), hazards, [](Cell, double gradient) { return gradient > 0.36; }};
};

template <typename Height>
std::unique_ptr<Site> site(Height height_m) {
  const maps::Grid grid{.width = 21, .height = 9, .resolution_m = 1.0, .south_west = {}};
  costmap::MapLayers layers{.elevation = {.elevation_m = maps::Raster<float>(grid, 0.0F)}};
  for (int row = 0; row < grid.height; ++row)
    for (int column = 0; column < grid.width; ++column)
      layers.elevation.elevation_m[{column, row}] = static_cast<float>(height_m(column));
  return std::unique_ptr<Site>(new Site{{std::move(layers), costmap::testGround(), {}}});
}

// Closed form: a vertical step of 0.9 m on a plane of gradient 0.1. The plane remains after the step is
// removed.
TEST(StepEdges, ASheerStepIsFoundOnAPlane) {
  const auto at = site([](int column) { return 0.1 * column + (column > 10 ? 0.9 : 0.0); });
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
  const auto at = site([](int column) { return 0.6 * std::clamp(column - 7, 0, 6); });
  for (const int column : {7, 13}) {
    ASSERT_TRUE(has(at->map.surface().hazards({column, 4}), Hazard::Step)) << column;
    EXPECT_EQ(at->edges.at({column, 4}), StepEdges::Kind::Slope) << column;
  }
}

// Property: a bend between gradients that the ground allows is not the edge of a slope and remains a step.
TEST(StepEdges, ABendOfAllowedGradientsIsNoSlope) {
  const auto at = site([](int column) { return 0.3 * std::abs(column - 10); });
  ASSERT_TRUE(has(at->map.surface().hazards({10, 4}), Hazard::Step));
  EXPECT_EQ(at->edges.at({10, 4}), StepEdges::Kind::None);
}

}  // namespace step_edges_test
}  // namespace talus::planner
