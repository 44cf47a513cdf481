#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <talus/cli/draw/canvas.hpp>
#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/costmap/surface/surface_shape.hpp>
#include <talus/maps/maps.hpp>
#include <talus/planner/route/heading_set.hpp>
#include <talus/planner/route/polyline.hpp>
#include <talus/planner/route/route.hpp>
#include <talus/planner/simulation/simulation.hpp>

namespace talus::cli {

/// A coarser version of a grid: each coarse cell is a block of factor x factor fine cells. Blocks at the
/// eastern and northern edges may have fewer cells.
class Blocks {
 public:
  /// Divides the grid `fine` by the smallest factor for which no side of the coarse grid exceeds max_side
  /// cells.
  Blocks(const maps::Grid& fine, int max_side)
      : fine_(fine), factor_(std::max(1, (std::max(fine.width, fine.height) + max_side - 1) / max_side)) {
    const auto count = [this](int cells) { return (cells + factor_ - 1) / factor_; };
    coarse_ = {count(fine.width), count(fine.height), fine.resolution_m * factor_, fine.south_west};
  }

  const maps::Grid& coarse() const noexcept { return coarse_; }

  /// Returns the number of fine cells per side of a block.
  int factor() const noexcept { return factor_; }

  /// Returns the fine cell at the centre of a block.
  maps::Cell middle(maps::Cell block) const noexcept {
    return {std::min(fine_.width - 1, block.column * factor_ + factor_ / 2),
            std::min(fine_.height - 1, block.row * factor_ + factor_ / 2)};
  }

  /// Calls visit(cell) for a regular sample of at most 8 x 8 cells of the block.
  template <typename Visit>
  void forEach(maps::Cell block, Visit visit) const {
    const int stride = std::max(1, factor_ / 8);
    const int right = std::min(fine_.width, (block.column + 1) * factor_);
    const int top = std::min(fine_.height, (block.row + 1) * factor_);
    for (int row = block.row * factor_; row < top; row += stride)
      for (int column = block.column * factor_; column < right; column += stride)
        visit(maps::Cell{column, row});
  }

  /// Returns a raster with the mean of value(cell) over each block, without NaN values; NaN for a block whose
  /// values are all NaN.
  template <typename Value>
  maps::Raster<float> mean(Value value) const {
    maps::Raster<float> out(coarse_, std::nanf(""));
    costmap::forEachCell(costmap::allOf(coarse_), [&](maps::Cell block) {
      double sum = 0.0;
      int count = 0;
      forEach(block, [&](maps::Cell cell) {
        const auto v = static_cast<double>(value(cell));
        if (std::isnan(v)) return;
        sum += v;
        ++count;
      });
      if (count > 0) out[block] = static_cast<float>(sum / count);
    });
    return out;
  }

 private:
  maps::Grid fine_;
  int factor_;
  maps::Grid coarse_;
};

/// A closed interval, low < high.
struct Range {
  double low = 0.0;
  double high = 1.0;
};

/// Returns the greatest number of the form 1, 2 or 5 times a power of ten that does not exceed `value` > 0.
double roundBelow(double value);

/// Allowed headings of the cells of a map (planner::HeadingSets). They depend on the ground and on the steepness of a
/// cell: they are computed for steps of the steepness, and for the cells between steps that differ. Not thread-safe;
/// the map must outlive the object.
class HeadingsOfCells {
 public:
  explicit HeadingsOfCells(const costmap::TraversabilityMap& map);

  AllowedHeadings at(maps::Cell cell);

 private:
  AllowedHeadings on(costmap::CellCode::Curve curve, int steepness);
  AllowedHeadings of(costmap::CellCode code);

  const costmap::TraversabilityMap& map_;
  std::shared_ptr<const costmap::CostGrid> grid_;
  planner::HeadingSets sets_;
  std::vector<std::vector<AllowedHeadings>> known_;  // by curve and steepness; Unknown: not computed
};

/// Number of map cells in one block (cell of a scene), by their AllowedHeadings.
struct HeadingShares {
  std::array<std::uint8_t, 4> count{};
};

/// Returns the share of each of AllowedHeadings of the cells.
std::array<double, 4> sharesOf(const maps::Raster<HeadingShares>& headings);

/// A class of a layer that shows classes instead of a continuous scale.
struct LayerClass {
  std::string name;
  Colour colour;
};

/// Returns the quantiles of the finite values at the given shares, by nearest rank; NaN without finite values.
std::vector<double> quantiles(const maps::Raster<float>& values, const std::vector<double>& shares);

/// Shares between which colours change, so that outliers do not compress a colour scale.
inline const std::vector<double> kInner{0.02, 0.98};

/// Returns the slopes of planes that were fitted to all cells [deg].
maps::Raster<float> slope_deg(const maps::TerrainMetrics& metrics);

/// A layer of a scene: a quantity over the map that is drawn in colours.
struct ValueLayer {
  std::string name;                   ///< name of the quantity, e.g. "slope"
  std::string unit;                   ///< unit, e.g. "deg"; empty for a ratio
  maps::Raster<float> values;         ///< NaN: no value
  Range range;                        ///< values at the two ends of the scale
  bool zero_in_middle = false;        ///< true if the scale has diverging colours around its middle
  int decimals = 4;                   ///< number of decimals of the values in a page
  std::vector<LayerClass> classes{};  ///< classes to which `values` are indices; empty: continuous scale
};

/// Data of the driving cost by heading, for the cell at the centre of each block (cell of a scene).
struct HeadingCosts {
  /// Gradients and cost-curve index of the cells.
  maps::Raster<costmap::CellCode> codes;
  maps::Raster<std::uint8_t> categories;  ///< number of terramech::Category, as `talus explain` states it
  std::shared_ptr<const costmap::TravelCost> cost;
};

/// A small area of the map that is marked with a ring around it.
struct Ring {
  maps::Point centre;
  double radius_m = 0.0;  ///< radius of the marked area
  std::string label;
};

/// An area that is hatched over every layer.
struct HatchedArea {
  std::string name;
  Colour colour;
  maps::Raster<std::uint8_t> mask;  ///< 1 in the cells of the area
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

/// A cell whose displayed category changed during a drive.
struct CellChange {
  double time_s = 0.0;
  maps::Cell cell;
  std::uint8_t category = 0;  ///< terramech::Category as a number
};

/// Record of a simulated drive for an HTML page: events, changes of the map, and the true soil patches, which
/// the rover does not know.
struct TraverseRecord {
  planner::TraverseSimulation drive;
  std::vector<CellChange> changes;
  std::vector<planner::SoilPatch> patches;
  maps::Grid grid;  ///< grid of the cells of `changes`
};

/// Scene: contents of a picture or page at display resolution. All rasters share one grid of at most
/// SceneOptions::max_side cells per side.
struct Scene {
  std::string title;
  std::string subtitle;
  maps::Raster<float> elevation_m;       ///< NaN: no data
  maps::Raster<HeadingShares> headings;  ///< shares of the allowed headings; empty: not known
  std::vector<ValueLayer> layers;
  maps::Raster<std::uint32_t> image{};  ///< picture that covers the ground, as 0xAARRGGBB; empty: none
  std::vector<HatchedArea> areas{};     ///< keep-out areas, and ground whose cost a layer raises
  std::vector<Fact> facts;
  std::vector<Fact> provenance{};  ///< data needed to reproduce the result
  std::optional<planner::Route> route;
  std::vector<NamedRoute> routes{};        ///< routes of a comparison: the first route, then the others
  std::vector<ComparedFact> comparison{};  ///< quantities of `routes`
  /// Labelled positions of a scene, beside the ends of its routes.
  std::vector<std::pair<const char*, maps::Point>> marks{};
  std::vector<Ring> rings{};
  std::optional<maps::Georeference> georeference{};  ///< georeference of the map, if known
  int cells_per_pixel = 1;                           ///< number of map cells per scene cell and side
  std::optional<HeadingCosts> costs{};  ///< driving cost by heading, for traversability maps only
  std::optional<TraverseRecord> story;  ///< a simulated drive to be replayed

  const maps::Grid& grid() const noexcept { return elevation_m.grid(); }
};

/// Title and greatest size of a scene.
struct SceneOptions {
  std::string title;
  int max_side = 1200;  ///< greatest number of cells per side; larger maps are averaged in blocks
};

/// Returns the scene of an elevation map, with elevation and slope.
Scene sceneOf(const maps::ElevationMap& map, const SceneOptions& options);

/// Returns the scene of a traversability map: elevation, slope, allowed headings, drawbar pull with its standard
/// deviation, and sinkage.
Scene sceneOf(const costmap::TraversabilityMap& map, const SceneOptions& options);

/// Returns the scene of a route without a map: an empty area around the route.
Scene sceneOf(const planner::Route& route, const SceneOptions& options);

/// Returns a picture of the ground, such as an orthophoto, over a map's grid, for Scene::image: cells that are divided
/// until the longer side has up to 1024 pixels. Empty without a path. Throws the exceptions of maps::readImage().
maps::Raster<std::uint32_t> groundPicture(const std::string& path,
                                          const std::optional<maps::Georeference>& place,
                                          const maps::Grid& grid);

/// Adds what the ground is like to the facts: shares of the allowed headings, and the distribution of each layer.
void addGroundFacts(Scene& scene);

/// Adds a route and its summary to a scene.
void addRoute(Scene& scene, const planner::Route& route);

/// Adds two or more routes and their comparison to a scene; the first route is the reference. Facts that are equal
/// for all routes are appended to Scene::facts, those that differ to Scene::comparison, as are the stretches on
/// which the first two routes lie apart.
void compare(Scene& scene, std::vector<NamedRoute> routes);

/// A start and a goal without a feasible route between them.
struct Severed {
  /// Start and goal.
  planner::Segment places;
  double tolerance_m = 0.0;  ///< accepted distance of the end of a route from the goal
  std::string reason;        ///< reason for which there is no route, in one line
};

/// Returns the scene of a request without a feasible route. The first layer has two classes: cells that can
/// be reached from the start, and cells from which the goal can be reached; other cells have no value. A ring
/// marks the smaller of the two sets, and the title ends with the reason. The cost grid must be that of the
/// map.
Scene reachScene(const maps::ElevationMap& map, const costmap::CostGrid& cost, const Severed& severed,
                 const SceneOptions& options);

}  // namespace talus::cli
