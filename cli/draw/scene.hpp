#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <talus/cli/draw/colour.hpp>
#include <talus/cli/draw/drive_story.hpp>
#include <talus/cli/draw/ticks.hpp>
#include <talus/costmap/cost/drive_cost.hpp>
#include <talus/maps/terrain/elevation_map.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::costmap {
class TraversabilityMap;
}

namespace talus::cli {

/// How many of a block's cells fall in each terramech::Category, by its number.
struct CategoryShares {
  std::array<std::uint8_t, 4> count{};
};

/// One of the classes of a layer that has classes in place of a scale.
struct LayerClass {
  std::string name;
  Colour colour;
};

/// The values between which all but the lowest and the highest 2 % lie, so that outliers do not take all colours; nothing
/// where none is finite.
std::optional<Range> innerRange(const maps::Raster<float>& values);

/// A quantity over the map that is shown in colours.
struct ValueLayer {
  std::string name;                   ///< "slope"
  std::string unit;                   ///< "deg"; empty for a ratio
  maps::Raster<float> values;         ///< NaN where there is none
  Range range;                        ///< values at the two ends of the scale
  bool zero_in_middle = false;        ///< colours diverge from the middle
  int decimals = 4;                   ///< that a page keeps of a value
  std::vector<LayerClass> classes{};  ///< values are indices of these; empty: a scale
};

/// What driving costs in each heading: of the cell in the middle of each block.
struct HeadingCosts {
  maps::Raster<costmap::CellCode> codes;
  maps::Raster<std::uint8_t> categories;  ///< terramech::Category by its number, as `talus explain` states it
  std::shared_ptr<const costmap::DriveCost> cost;
};

/// A place that is easily overlooked, to be marked with a ring around it.
struct Ring {
  maps::Point centre;
  double radius_m = 0.0;  ///< of what it surrounds
  std::string label;
};

/// A line of a summary: what, and its value with unit.
using Fact = std::pair<std::string, std::string>;

/// A route that is compared with others.
struct NamedRoute {
  std::string name;
  planner::Route route;
  std::vector<Fact> provenance{};
};

/// A quantity of several routes: its name, and the value of each.
struct ComparedFact {
  std::string name;
  std::vector<std::string> values;
};

/// All that a picture or a page shows, at the scale it is shown: rasters share one grid, at most a few
/// pixels' worth of cells a side.
struct Scene {
  std::string title;
  std::string subtitle;
  maps::Raster<float> elevation_m;          ///< NaN: no data
  maps::Raster<CategoryShares> categories;  ///< empty: not known
  std::vector<ValueLayer> layers;
  std::vector<Fact> facts;
  std::vector<Fact> provenance{};  ///< what it takes to make it again
  std::optional<planner::Route> route;
  std::vector<NamedRoute> routes{};        ///< where several are compared: the first, and the others
  std::vector<ComparedFact> comparison{};  ///< of these
  std::vector<std::pair<maps::Point, std::string>> partings{};  ///< where they part and meet again
  std::vector<std::pair<const char*, maps::Point>>
      marks{};  ///< places under a letter, where there is no route
  std::vector<Ring> rings{};
  std::optional<maps::Georeference> georeference{};  ///< where the map has one
  int cells_per_pixel = 1;              ///< of the map, a side, that a cell of the scene stands for
  std::optional<HeadingCosts> costs{};  ///< of a map of beliefs
  std::optional<DriveStory> story;      ///< a simulated drive, to be run through

  const maps::Grid& grid() const noexcept { return elevation_m.grid(); }
};

/// How large a scene may be.
struct SceneOptions {
  std::string title;
  int max_side = 1200;  ///< cells; larger maps are averaged over blocks
};

/// A map alone: elevation and slope.
Scene sceneOf(const maps::ElevationMap& map, const SceneOptions& options);

/// A map of beliefs: also categories, drawbar pull, its uncertainty and sinkage.
Scene sceneOf(const costmap::TraversabilityMap& map, const SceneOptions& options);

/// A route without its map: an empty ground around it.
Scene sceneOf(const planner::Route& route, const SceneOptions& options);

/// Puts a route on a scene, with the facts of its summary.
void addRoute(Scene& scene, const planner::Route& route);

}  // namespace talus::cli
