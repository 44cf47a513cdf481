#include <random>

#include <talus/planner/field/cost_to_go.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace cost_to_go_repair_test {

using testing::randomMap;

// Property: for any change of a patch, with a complete or partial field, the repaired field equals the
// recomputed field.
TEST(CostToGo, RepairEqualsRecomputation) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    std::mt19937 random(seed);
    const auto below = [&random](unsigned limit) { return static_cast<int>(random() % limit); };
    const auto map = randomMap({.width = 70, .height = 60, .seed = seed, .blocked = 0.2});
    maps::Raster<costmap::CellCode> cells(map->grid());
    for (int row = 0; row < 60; ++row)
      for (int column = 0; column < 70; ++column) cells[{column, row}] = map->at({column, row});
    const EdgeUnits units(map->cost(), 1.0);
    const auto edges = std::make_shared<EdgeLayer>(map, units);
    const FieldGoal goal{.cell = {below(70), below(60)}};
    const maps::Cell until{below(70), below(60)};
    CostToGo field(edges, {goal});
    ASSERT_TRUE(seed % 2 == 0 ? field.settle(until) : field.settleAll());
    for (int round = 0; round < 4; ++round) {
      const maps::Cell first{below(60), below(50)};
      const CellBox box{first, {first.column + below(10), first.row + below(10)}};
      for (int row = box.first.row; row <= box.last.row; ++row)
        for (int column = box.first.column; column <= box.last.column; ++column)
          cells[{column, row}] =
              costmap::CellCode({.dz_dx = 0.004 * below(100) - 0.2,
                                 .dz_dy = 0.1,
                                 .curve = static_cast<std::uint8_t>(below(3) == 0 ? 255 : below(5))});
      const auto newer = std::make_shared<costmap::CostGrid>(costmap::flattened(cells, map->content().cost));
      edges->update(newer, units, box);
      field.repair(box);
      CostToGo anew(std::make_shared<EdgeLayer>(newer, units), {goal});
      ASSERT_TRUE(field.settle(until) && anew.settle(until));
      ASSERT_EQ(field.units(until), anew.units(until)) << seed;
      if (seed % 2 == 0 && round < 3) continue;
      ASSERT_TRUE(field.settleAll() && anew.settleAll());
      for (int row = 0; row < 60; ++row)
        for (int column = 0; column < 70; ++column)
          ASSERT_EQ(field.units({column, row}), anew.units({column, row}))
              << seed << ": " << column << "," << row;
    }
  }
}

}  // namespace cost_to_go_repair_test
}  // namespace talus::planner
