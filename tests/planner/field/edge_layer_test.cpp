#include <cmath>
#include <stop_token>

#include <talus/common/progress_monitor.hpp>
#include <talus/planner/field/edge_layer.hpp>
#include <talus/planner/route/motion_cost.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace edge_layer_test {

using testing::randomMap;

using MapPointer = std::shared_ptr<const costmap::CostGrid>;

std::shared_ptr<const EdgeLayer> edgesOf(const MapPointer& map, int threads = 1) {
  return std::make_shared<EdgeLayer>(map, EdgeUnits(map->cost(), map->grid().resolution_m), threads);
}

// Property: an edge equals MotionCost between the centres, to one unit and 1/256 of the difference between
// neighbouring nodes (less than half a half-edge). The grid allows no motion that the exact segment does
// not.
TEST(EdgeLayer, EdgeCostMatchesTheMotionBetweenCentres) {
  int allowed = 0, blocked = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const auto map = randomMap({.width = 21, .height = 18, .seed = seed, .blocked = 0.2, .roughness = 0.35});
    const Kernels kernels = seed % 2 == 0 ? Kernels::Best : Kernels::Scalar;
    const auto edges = std::make_shared<EdgeLayer>(map, EdgeUnits(map->cost(), 1.0), 1, StopCheck{}, kernels);
    const MotionCost cost(map);
    for (int row = 0; row < 18; ++row)
      for (int column = 0; column < 21; ++column)
        for (std::size_t k = 0; k < 8; ++k) {
          const maps::Cell to{column, row}, from{column + kStep[k].column, row + kStep[k].row};
          const std::uint16_t edge = edges->into(edges->padded().index(to))[k];
          const double exact_J = cost({map->grid().centre(from), map->grid().centre(to)});
          ASSERT_EQ(edge != EdgeLayer::kBlocked, std::isfinite(exact_J)) << seed;
          ++(edge == EdgeLayer::kBlocked ? blocked : allowed);
          if (edge == EdgeLayer::kBlocked) continue;
          ASSERT_NEAR(edge * edges->units().unit_J(), exact_J,
                      2.0 * edges->units().unit_J() + 0.5 / 256.0 * exact_J);
        }
  }
  EXPECT_GT(allowed, 5'000);
  EXPECT_GT(blocked, 5'000);
}

// Property: after an update for a patch, across tile edges and at the map's border, the layer equals a
// rebuilt one.
TEST(EdgeLayer, UpdateEqualsRebuild) {
  const auto map = randomMap({.width = 100, .height = 90, .seed = 7});
  for (const CellBox box : {CellBox{{60, 60}, {70, 68}}, {{0, 0}, {3, 89}}, {{99, 89}, {99, 89}}}) {
    const costmap::Revision revision{
        .ranges = {{box.first, box.last}},
        .code = [](maps::Cell c, costmap::CellCode code) { return code.withCurve(c.row % 2 ? 255 : 3); },
        .cost = [&] { return map->content().cost; }};
    const auto newer = std::make_shared<costmap::CostGrid>(costmap::revised(*map, revision));
    EdgeLayer updated(map, EdgeUnits(map->cost(), 1.0));
    updated.update(newer, updated.units(), box);
    const auto anew = edgesOf(newer);
    for (std::size_t i = 0; i < anew->padded().size(); ++i)
      for (int k = 0; k < 8; ++k) ASSERT_EQ(updated.into(i)[k], anew->into(i)[k]) << i;
  }
}

TEST(EdgeLayer, StoppedLayerIsIncomplete) {
  const auto map = randomMap({.width = 90, .height = 90});
  std::stop_source source;
  source.request_stop();
  const EdgeUnits units(map->cost(), 1.0);
  EXPECT_FALSE(
      EdgeLayer(map, units, 1, ProgressMonitor{.progress = {}, .stop = source.get_token()}).complete());
  EXPECT_TRUE(EdgeLayer(map, units).complete());
}

TEST(EdgeLayer, ResultIsIndependentOfThreadCount) {
  const auto map = randomMap({.width = 90, .height = 300, .seed = 2});
  const auto one = edgesOf(map, 1), three = edgesOf(map, 3);
  for (std::size_t i = 0; i < one->padded().size(); ++i)
    for (int k = 0; k < 8; ++k) ASSERT_EQ(one->into(i)[k], three->into(i)[k]);
}

}  // namespace edge_layer_test
}  // namespace talus::planner
