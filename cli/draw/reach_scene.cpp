#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <talus/cli/draw/reach_scene.hpp>
#include <talus/planner/reach/reach.hpp>

namespace talus::cli {

using planner::Reach;

namespace {

constexpr double kSmall = 0.15;  // of the map's diagonal: sets smaller than this share are marked

/// Number of reached cells, and their bounding circle.
struct ReachedExtent {
  std::size_t count = 0;
  double west = INFINITY, east = -INFINITY, south = INFINITY, north = -INFINITY;

  void add(maps::Point p) {
    ++count;
    west = std::min(west, p.x_m);
    east = std::max(east, p.x_m);
    south = std::min(south, p.y_m);
    north = std::max(north, p.y_m);
  }
  maps::Point centre() const { return {0.5 * (west + east), 0.5 * (south + north)}; }
  double radius_m() const { return 0.5 * std::hypot(east - west, north - south); }
};

}  // namespace

Scene reachScene(const maps::ElevationMap& map, const costmap::CostGrid& cost, const Severed& severed,
                 const SceneOptions& options) {
  Scene scene = sceneOf(map, options);
  planner::HeadingSets headings(cost.cost());
  const Reach from(cost, headings, Reach::Sense::From, severed.places.from);
  const Reach to(cost, headings, Reach::Sense::To, severed.places.to, severed.tolerance_m);
  ValueLayer layer{.name = "two sets that nothing connects",
                   .unit = "",
                   .values = maps::Raster<float>(scene.grid(), std::nanf("")),
                   .range = {0.0, 1.0},
                   .decimals = 0};
  ReachedExtent reached, leading;
  for (int row = 0; row < scene.grid().height; ++row)
    for (int column = 0; column < scene.grid().width; ++column) {
      const maps::Point centre = scene.grid().centre({column, row});
      const auto cell = cost.grid().cellAt(centre);
      if (!cell) continue;
      if (from.holds(*cell)) {
        layer.values[{column, row}] = 0.0F;
        reached.add(centre);
      } else if (to.holds(*cell)) {
        layer.values[{column, row}] = 1.0F;
        leading.add(centre);
      }
    }
  const std::string first = fmt::format("reached from the start: {} cells", reached.count);
  const std::string second = fmt::format("leading to the goal: {} cells", leading.count);
  layer.classes = {{first, seriesColour(0)}, {second, seriesColour(4)}};
  const bool start_is_small = reached.count <= leading.count;
  const ReachedExtent& small = start_is_small ? reached : leading;
  const maps::Grid& grid = scene.grid();
  if (small.count > 0 && small.radius_m() < kSmall * std::hypot(grid.width, grid.height) * grid.resolution_m)
    scene.rings.push_back({small.centre(), small.radius_m(), start_is_small ? first : second});
  scene.layers.insert(scene.layers.begin(), std::move(layer));
  scene.title += ": " + severed.reason;
  scene.facts.emplace_back("route", "no_route: " + severed.reason);
  scene.marks = {{"S", severed.places.from}, {"G", severed.places.to}};
  return scene;
}

}  // namespace talus::cli
