#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <talus/cli/draw/colour.hpp>
#include <talus/cli/draw/ticks.hpp>
#include <talus/cli/draw/traverse_record.hpp>
#include <talus/costmap/cost/travel_cost.hpp>
#include <talus/maps/terrain/elevation_map.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::costmap {
class TraversabilityMap;
}

namespace talus::cli {

/// Number of cells of a block in each terramech::Category, indexed by the category's number.
struct CategoryShares {
  std::array<std::uint8_t, 4> count{};
};

/// A class of a layer that shows classes instead of a scale.
struct LayerClass {
  std::string name;
  Colour colour;
};

/// Range from the 2 % to the 98 % quantile of the finite values, so that outliers do not compress the colour
/// scale; nothing without finite values.
std::optional<Range> innerRange(const maps::Raster<float>& values);

/// A quantity over the map that is drawn in colours.
struct ValueLayer {
  std::string name;                   ///< "slope"
  std::string unit;                   ///< "deg"; empty for a ratio
  maps::Raster<float> values;         ///< NaN: no value
  Range range;                        ///< values at the two ends of the scale
  bool zero_in_middle = false;        ///< diverging colours around the middle
  int decimals = 4;                   ///< decimals of the values in a page
  std::vector<LayerClass> classes{};  ///< `values` are indices into the classes; empty: a continuous scale
};

/// Driving cost by heading, of the cell at the centre of each block.
struct HeadingCosts {
  maps::Raster<costmap::CellCode> codes;
  maps::Raster<std::uint8_t> categories;  ///< terramech::Category by its number, as `talus explain` states it
  std::shared_ptr<const costmap::TravelCost> cost;
};

/// A small area, marked with a ring around it.
struct Ring {
  maps::Point centre;
  double radius_m = 0.0;  ///< radius of the marked area
  std::string label;
};

/// A line of a summary: name, and value with unit.
using Fact = std::pair<std::string, std::string>;

/// A route in a comparison.
struct NamedRoute {
  std::string name;
  planner::Route route;
  std::vector<Fact> provenance{};
};

/// A quantity of several routes: its name, and one value per route.
struct ComparedFact {
  std::string name;
  std::vector<std::string> values;
};

/// Contents of a picture or a page at display resolution. All rasters share one grid of at most
/// SceneOptions::max_side cells per side.
struct Scene {
  std::string title;
  std::string subtitle;
  maps::Raster<float> elevation_m;          ///< NaN: no data
  maps::Raster<CategoryShares> categories;  ///< empty: not known
  std::vector<ValueLayer> layers;
  std::vector<Fact> facts;
  std::vector<Fact> provenance{};  ///< data needed to reproduce the result
  std::optional<planner::Route> route;
  std::vector<NamedRoute> routes{};        ///< in a comparison: the first route, then the others
  std::vector<ComparedFact> comparison{};  ///< quantities of `routes`
  std::vector<std::pair<maps::Point, std::string>> partings{};  ///< begin and end of deviations
  std::vector<std::pair<const char*, maps::Point>> marks{};  ///< labelled places of a scene without a route
  std::vector<Ring> rings{};
  std::optional<maps::Georeference> georeference{};  ///< georeference of the map, if known
  int cells_per_pixel = 1;                           ///< cells of the map per cell of the scene and side
  std::optional<HeadingCosts> costs{};               ///< traversability maps only
  std::optional<TraverseRecord> story;               ///< a simulated drive for replay

  const maps::Grid& grid() const noexcept { return elevation_m.grid(); }
};

/// How large a scene may be.
struct SceneOptions {
  std::string title;
  int max_side = 1200;  ///< cells; larger maps are averaged in blocks
};

/// Scene of an elevation map: elevation and slope.
Scene sceneOf(const maps::ElevationMap& map, const SceneOptions& options);

/// Scene of a traversability map: also categories, drawbar pull with its standard deviation, and sinkage.
Scene sceneOf(const costmap::TraversabilityMap& map, const SceneOptions& options);

/// Scene of a route without a map: an empty area around the route.
Scene sceneOf(const planner::Route& route, const SceneOptions& options);

/// Adds a route and its summary to a scene.
void addRoute(Scene& scene, const planner::Route& route);

}  // namespace talus::cli
