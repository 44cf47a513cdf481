#include <cmath>
#include <utility>

#include <talus/cli/draw/reach_scene.hpp>
#include <talus/planner/reach/reach.hpp>

namespace talus::cli {

using planner::Reach;

Scene reachScene(const maps::ElevationMap& map, const costmap::CostGrid& cost, const Severed& severed,
                 const SceneOptions& options) {
  Scene scene = sceneOf(map, options);
  planner::HeadingSets headings(cost.cost());
  const Reach from(cost, headings, Reach::Sense::From, severed.places.from);
  const Reach to(cost, headings, Reach::Sense::To, severed.places.to, severed.tolerance_m);
  ValueLayer layer{.name = "from the start: 0, to the goal: 1",
                   .unit = "",
                   .values = maps::Raster<float>(scene.grid(), std::nanf("")),
                   .range = {0.0, 1.0}};
  for (int row = 0; row < scene.grid().height; ++row)
    for (int column = 0; column < scene.grid().width; ++column) {
      const auto cell = cost.grid().cellAt(scene.grid().centre({column, row}));
      if (!cell) continue;
      if (from.holds(*cell)) layer.values[{column, row}] = 0.0F;
      if (to.holds(*cell)) layer.values[{column, row}] = 1.0F;
    }
  scene.layers.insert(scene.layers.begin(), std::move(layer));
  scene.facts.emplace_back("route", "no_route: " + severed.reason);
  scene.marks = {{"S", severed.places.from}, {"G", severed.places.to}};
  return scene;
}

}  // namespace talus::cli
