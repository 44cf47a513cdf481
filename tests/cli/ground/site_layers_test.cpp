#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include <site_map.hpp>

#include <talus/cli/ground/site_layers.hpp>

namespace talus::cli {
namespace site_layers_test {

std::map<std::string, maps::Raster<float>> layersOf(const costmap::TraversabilityMap& map) {
  std::map<std::string, maps::Raster<float>> layers;
  for (maps::Layer& layer : siteLayers(map, 1)) layers.emplace(layer.name, std::move(layer.values));
  return layers;
}

// Closed form: a plane rising eastwards by 0.1 has slope atan 0.1; uphill costs more than downhill; cells
// without elevation are NaN except for their category.
TEST(SiteLayers, LayersOfAPlaneMatchClosedForm) {
  const std::vector<std::string> rows(14, "1111111?222222");
  auto layers = layersOf(costmap::mapOf(rows, 0.1));
  EXPECT_EQ(layers.size(), 13U);
  const maps::Cell sand{3, 7}, hole{7, 7}, dust{11, 7};
  EXPECT_NEAR(layers["slope"][sand], std::atan(0.1), 1e-4);
  EXPECT_NEAR(layers["elevation"][sand], 1000.3, 1e-3);
  EXPECT_NEAR(layers["step"][sand], layers["step"][dust], 1e-3);
  EXPECT_GT(layers["energy_per_metre_uphill"][sand], layers["energy_per_metre_downhill"][sand]);
  EXPECT_EQ(layers["class"][sand], 1.0F);
  EXPECT_EQ(layers["class"][dust], 2.0F);
  EXPECT_TRUE(std::isnan(layers["elevation"][hole]));
  EXPECT_TRUE(std::isnan(layers["energy_per_metre_uphill"][hole]));
}

// Property: the layer equals a count of 720 headings by the cost of a metre; each kind of cell occurs.
TEST(SiteLayers, AllowedHeadingsMatchTheCostsOfHeadings) {
  std::set<float> seen;
  for (const double gradient : {0.0, 0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.5}) {
    const auto map = costmap::mapOf(std::vector<std::string>(14, "1111111222222"), gradient);
    auto layers = layersOf(map);
    const auto grid = map.published();
    for (const maps::Cell cell : {maps::Cell{3, 7}, maps::Cell{10, 7}}) {
      int allowed = 0;
      for (int k = 0; k < 720; ++k) {
        const double heading = k * std::numbers::pi / 360.0;
        allowed +=
            std::isfinite(grid->cost().costPerMetre(grid->at(cell), {std::cos(heading), std::sin(heading)}));
      }
      const float expected = allowed == 720 ? 0.0F : allowed > 0 ? 1.0F : 2.0F;
      EXPECT_EQ(layers["allowed_headings"][cell], expected) << gradient;
      seen.insert(expected);
    }
  }
  EXPECT_EQ(seen.size(), 3U);
}

// Property: the weaker soil has less drawbar pull and more sinkage; categories equal those of the map.
TEST(SiteLayers, LayersMatchTheMap) {
  const auto map = costmap::mapOf({"1111111222222", "1111111222222", "11111112222#2", "1111111222222"});
  auto layers = layersOf(map);
  EXPECT_GT((layers["drawbar_pull_over_load"][{2, 1}]), (layers["drawbar_pull_over_load"][{11, 2}]));
  EXPECT_LT((layers["sinkage_over_radius"][{2, 1}]), (layers["sinkage_over_radius"][{11, 2}]));
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 13; ++column)
      EXPECT_EQ((layers["category"][{column, row}]), static_cast<float>(map.belief({column, row}).category));
  EXPECT_TRUE(std::isnan(layers["energy_per_metre_uphill"][{11, 1}]));  // keep-out cell
}

}  // namespace site_layers_test
}  // namespace talus::cli
