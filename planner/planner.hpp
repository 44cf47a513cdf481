#pragma once

/// Umbrella header of talus::planner: planning of routes with Talus' own planners or with a planner from a
/// shared library, and a check of routes that is independent of the planners.
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/costmap/cost/cost_model.hpp>
#include <talus/costmap/costmap.hpp>
#include <talus/maps/maps.hpp>
#include <talus/planner/check/route_check.hpp>
#include <talus/planner/plugin/global_planner.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// Rectangle in map coordinates [m] with sides on cell borders.
struct MapBox {
  maps::Point low;   ///< south-western corner
  maps::Point high;  ///< north-eastern corner
};

/// Map that does not fit in memory: an overview of the whole map, and tiles (64 x 64 cells) of full
/// resolution around routes, which are computed box by box. Memory grows with the length of the routes, not
/// with the size of the map. Not thread-safe.
class WindowedMap {
 public:
  /// Grid, overview and source of the cells of full resolution.
  struct Parts {
    maps::Grid grid;                                    ///< grid of the whole map at full resolution
    std::shared_ptr<const costmap::CostGrid> overview;  ///< cost map of the whole map in larger cells
    /// Function that returns the map of a box at full resolution; empty if the box contains no data. It is
    /// called from one thread.
    std::function<std::optional<costmap::TraversabilityMap>(const MapBox&)> build;
  };

  /// Throws std::invalid_argument if `overview` or `build` is missing.
  explicit WindowedMap(Parts parts);

  /// Returns the overview of the whole map.
  const std::shared_ptr<const costmap::CostGrid>& overview() const noexcept { return parts_.overview; }

  /// Returns a cost map with the tiles within `margin_cells` of a line and with all tiles computed before;
  /// other tiles are unknown. The tiles are identical to those of a map that is computed as a whole. The
  /// computation ends early after a stop. Throws std::invalid_argument if the map that `build` returns does
  /// not cover exactly the cells of its box.
  std::shared_ptr<const costmap::CostGrid> around(const std::vector<maps::Point>& line, double margin_cells,
                                                  const ProgressMonitor& watch = {});

  /// Returns the elevation [m] on tiles that were computed; empty elsewhere.
  std::optional<double> elevation_m(maps::Point point) const;

  /// Returns the grid of the whole map.
  const maps::Grid& grid() const noexcept { return parts_.grid; }
  /// Returns the number of cells computed at full resolution so far, in whole tiles.
  std::size_t cellsBuilt() const noexcept;

 private:
  using Tile = std::pair<int, int>;  // row, column
  std::set<Tile> missing(const std::vector<maps::Point>& line, double margin_cells) const;
  void build(const std::set<Tile>& tiles);
  void take(const costmap::TraversabilityMap& built, maps::Cell first, const std::set<Tile>& tiles);

  Parts parts_;
  costmap::CostGrid::Content content_;
  std::map<Tile, maps::Raster<float>> built_;  // elevation of built tiles, with a border of one cell
};

}  // namespace talus::planner

namespace talus {

using terramech::Telemetry;
/// Counts and findings of the telemetry that a map learned from.
using LearnReport = costmap::DriveReport;

/// What is known of a site before any wheel drove on it: readSite() reads it from files.
struct Site {
  costmap::MapLayers layers;    ///< elevation, terrain classes, rocks, keep-out areas, costs
  costmap::GroundModel ground;  ///< rover, soil of each terrain class, policy
  costmap::TraversabilityMap::Options options{};
};

/// Computes hazards and costs of each cell. Throws std::invalid_argument if a layer has another grid than the
/// elevation or an invalid value.
costmap::TraversabilityMap traversabilityMap(Site site, const ProgressMonitor& watch = {});

/// Traversability map of a site that learns from the rover's wheels. Only one thread may change or plan on a map at a
/// time; ground().published() may be called from any thread.
class Map {
 public:
  /// Builds the map with traversabilityMap().
  explicit Map(Site site, const ProgressMonitor& watch = {});
  explicit Map(costmap::TraversabilityMap map);
  /// Reads a file of save(), `talus costmap` or `talus update`, with rover, soils, policy and evidence; `threads` >= 1.
  /// @throws InputError
  static Map read(const std::string& path, int threads = 1, const ProgressMonitor& watch = {});
  Map(Map&&) noexcept;
  Map& operator=(Map&&) noexcept;
  ~Map();

  /// Writes the map to a file, completely or not at all. @throws InputError
  void save(const std::string& path) const;

  /// Adds the telemetry of one whole drive (costmap::addDrive()). @throws InputError if a required column is missing
  LearnReport learn(const Telemetry& drive);
  /// Adds the next part of the drive that is under way, in order of time; a part contains all rows of a time.
  /// Returns the number of its rows that the map uses.
  std::size_t learnPart(const Telemetry& part);
  /// Evaluates all parts again together (costmap::DriveIntake::settle()). Recommended at each stop of the rover.
  LearnReport settle();

  /// Replaces the ground of a window by a new observation (costmap::TraversabilityMap::patch()).
  void patch(const costmap::SurfacePatch& seen);
  /// Moves the window by whole tiles of 64 cells (costmap::TraversabilityMap::moved()); the drive under way goes on.
  void move(maps::Cell tiles);

  /// Returns category and causes at a place for driving in one heading [rad]; without, in the worst heading. Throws
  /// std::invalid_argument if the place lies outside the map.
  costmap::Explanation explain(maps::Point place, std::optional<double> heading_rad = std::nullopt) const;

  const costmap::TraversabilityMap& ground() const noexcept { return *map_; }
  costmap::TraversabilityMap& ground() noexcept { return *map_; }

 private:
  std::unique_ptr<costmap::TraversabilityMap> map_;
  std::unique_ptr<costmap::DriveIntake> intake_;
};

using planner::Route;
using planner::RouteVertex;

/// What a given polyline costs, as a route with the planner "none". A polyline that may not be driven has the status
/// NoRoute, an infinite cost, and energy and time of the cells with finite values.
struct Score : Route {
  std::vector<planner::Violation> violations{};  ///< places where it may not be driven, with the reason
  std::optional<Route> best{};  ///< with PlanRequest::prove: the route of plan() between its ends
};

/// Planner of routes: one of Talus' own planners, or a planner from a shared library (a plugin), which runs in a
/// child process. The search takes account of the chassis and the risk limit of the request. Each route is checked
/// with planner::violations(), and each vertex has the elevation of the map. If there is no route, the result has the
/// status and the reason. Computed data are kept for later routes on the same map or on a newer version of the map,
/// without effect on the routes. Not thread-safe: use one object per thread; the objects may share a map.
class Planner {
 public:
  /// Selects an own planner by `settings.planner`; empty: the default planner. `plugin` is the file of a shared
  /// library whose planner of that name is used instead. Throws std::invalid_argument with field, value and bound for
  /// a setting out of range, and with the most similar name for an unknown planner; InputError under the conditions
  /// of planner::loadPlugin().
  explicit Planner(const PlannerSettings& settings = {}, const std::string& plugin = {});
  Planner(Planner&&) noexcept;
  Planner& operator=(Planner&&) noexcept;
  ~Planner();

  /// Returns the name of the planner for reports.
  const std::string& name() const noexcept;

  /// Returns the capabilities of the selected own planner. For a plugin, unsupported fields of a request are
  /// rejected in the child process.
  PlannerCapabilities capabilities() const;

  /// Plans a route on a map, whose hazards the reason names. Throws std::invalid_argument if a field of the request
  /// is out of its range, or if the planner does not support a field that is set.
  Route plan(const Map& map, PlanRequest request);

  /// Plans a route on a version of a map, not null, or throws in the same way.
  Route plan(const std::shared_ptr<const costmap::CostGrid>& map, const PlanRequest& request);

  /// Plans a route with the planner "field" on a map that is not held in memory. A route on a coarse overview
  /// of the map guides the search, and windows of full resolution are computed along the overview route. The status
  /// NoRoute is not a proof, because routes that the overview does not resolve are missed. Of the optional
  /// constraints only via points are supported.
  Route plan(planner::WindowedMap& map, const PlanRequest& request);

  /// Returns what a polyline of at least one point costs under the cost function of the planners. Of the request,
  /// `chassis`, `prove` (plans between the ends; without it the bound is straightBoundOver_J()) and `watch` are used.
  Score score(const costmap::TraversabilityMap& map, const std::vector<maps::Point>& path,
              PlanRequest request = {});

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace talus
