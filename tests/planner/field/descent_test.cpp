#include <talus/planner/field/cost_to_go.hpp>
#include <talus/planner/field/descent.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace descent_test {

using testing::drawn;
using testing::randomMap;

std::shared_ptr<const EdgeLayer> edgesOf(const std::shared_ptr<const costmap::CostGrid>& map) {
  return std::make_shared<EdgeLayer>(map, EdgeUnits(map->cost(), 1.0));
}

std::vector<maps::Cell> descentOf(const CostToGo& field, maps::Cell from) {
  return descent(
      field.edges(), from, [&](std::size_t at) { return field.units(field.edges().padded().cell(at)); },
      [&](std::size_t at) { return field.atGoal(at); });
}

// Property: successive cells of a descent are neighbours, and the sum of their edges, with the cost at the
// goal, equals the field to the unit.
TEST(Descent, DescentCostEqualsTheField) {
  int walked = 0;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const auto edges = edgesOf(randomMap({.seed = seed, .blocked = 0.2, .roughness = 0.3}));
    CostToGo field(edges, {{.cell = {3, 4}, .cost_J = 20.0}, {.cell = {16, 12}}});
    ASSERT_TRUE(field.settleAll());
    for (int row = 0; row < 20; ++row)
      for (int column = 0; column < 20; ++column) {
        const auto path = descentOf(field, {column, row});
        if (path.empty()) {
          EXPECT_EQ(field.units({column, row}), CostToGo::kUnreached);
          continue;
        }
        ++walked;
        std::uint32_t sum = field.atGoal(edges->padded().index(path.back()));
        for (std::size_t i = 1; i < path.size(); ++i) {
          const maps::Cell back{path[i - 1].column - path[i].column, path[i - 1].row - path[i].row};
          const auto heading = std::ranges::find(kStep, back) - kStep.begin();
          ASSERT_LT(heading, 8);
          sum += edges->into(edges->padded().index(path[i]))[heading];
        }
        ASSERT_EQ(sum, field.units({column, row})) << seed;
      }
  }
  EXPECT_GT(walked, 1'000);
}

// Closed form: on level ground two steps east and one north-east cost the same in any order; east comes
// first.
TEST(Descent, TiesAreResolvedByHeadingOrder) {
  CostToGo field(edgesOf(drawn({"....", "...."})), {{.cell = {3, 1}}});
  ASSERT_TRUE(field.settleAll());
  EXPECT_EQ(descentOf(field, {0, 0}), (std::vector<maps::Cell>{{0, 0}, {1, 0}, {2, 0}, {3, 1}}));
}

TEST(Descent, UnsettledFieldYieldsNoDescent) {
  CostToGo field(edgesOf(drawn({"....."})), {{.cell = {0, 0}}});
  EXPECT_TRUE(descentOf(field, {4, 0}).empty());  // the distance is unknown
  const auto flat = [](std::size_t) { return 5U; };
  EXPECT_TRUE(descent(field.edges(), {4, 0}, flat, [](std::size_t) { return 0U; }).empty());
}

}  // namespace descent_test
}  // namespace talus::planner
