#include <cmath>
#include <random>
#include <stop_token>

#include <talus/common/progress_monitor.hpp>
#include <talus/planner/bound/admissible_edges.hpp>
#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/route/motion_cost.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace admissible_edges_test {

using testing::drawn;

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
  costmap::TravelCurve free_of_charge;
  free_of_charge.cost_J_per_m.fill(0.0F);
  const maps::Raster<costmap::CellCode> cells(
      {.width = 3, .height = 3, .resolution_m = 1.0, .south_west = {}}, costmap::CellCode({.curve = 0}));
  const auto cost =
      std::make_shared<costmap::TravelCost>(costmap::TravelCost::Limits{}, std::vector{free_of_charge});
  const auto map = std::make_shared<costmap::CostGrid>(costmap::flattened(cells, cost));
  EXPECT_EQ(admissibleEdges(map, octagonsOf(map)), nullptr);
}

}  // namespace admissible_edges_test
}  // namespace talus::planner
