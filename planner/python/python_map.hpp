#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <talus/planner/c/session.hpp>
#include <talus/planner/route/route_json.hpp>
#include <talus/planner/site/site.hpp>

namespace talus::planner {

/// Map class of the Python package, based on a session of the C interface. One thread at a time may use an
/// object.
class PythonMap {
 public:
  /// Layers of the map as Python objects.
  struct Layers {
    pybind11::object heights, classes, rocks, keep_out;  ///< arrays of equal shape, or None
    pybind11::dict costs;  ///< cost layers: name of the layer, and array of additional costs [J/m]
  };
  /// Rover, soils and placement of the map.
  struct Ground {
    terramech::Rover rover;
    pybind11::object soils;          ///< name of a soil or a Soil; or dict from class number to name or Soil
    costmap::TravelPolicy policy{};  ///< safety policy and weights of the cost function
    double resolution_m = 1.0;       ///< side length of a cell, > 0
    maps::Point south_west{};        ///< south-western corner of the map
    std::string crs{};               ///< EPSG code or WKT of a projected CRS; empty: local metres
    int threads = 1;                 ///< number of threads, >= 1
  };
  PythonMap(const Layers& layers, const Ground& ground);
  explicit PythonMap(Map map) : session_(std::make_shared<Session>(std::move(map))) {}
  /// Reads a map file; `threads` is the number of threads, >= 1.
  static std::unique_ptr<PythonMap> read(const std::string& path, int threads);
  /// Reads a site (talus::readSite()) and builds its map; `threads` is the number of threads, >= 1.
  static std::unique_ptr<PythonMap> fromFiles(const SiteFiles& files, int threads);

  const costmap::TraversabilityMap& map() const noexcept { return session_->map.ground(); }

  /// Updates the layers in a window with the south-western corner `south_west`; heights may be None.
  void patch(const Layers& layers, maps::Point south_west);
  /// Adds wheel telemetry to the map. `telemetry` contains columns or is the path of a file. Returns the
  /// number of rows used.
  std::size_t learn(const pybind11::object& telemetry);
  /// Evaluates all telemetry rows again that were added since the map was created or read
  /// (DriveIntake::settle()).
  void settle();
  /// Writes a map file.
  void save(const std::string& path) const;
  /// Writes the route as `talus plan -o` does, in the format that the ending of the path selects.
  void writeRoute(const Route& route, const std::string& path) const;
  /// Plans a route; `progress` may be None (see inBackground()).
  Route plan(const PlannerSettings& settings, const PlanRequest& request, const pybind11::object& progress);
  /// Returns category and causes at a place (talus::Map::explain()).
  costmap::Explanation explain(maps::Point place, std::optional<double> heading_rad) const;
  /// Returns what a polyline costs (talus::Planner::score()); `progress` may be None.
  Score score(const std::vector<maps::Point>& path, bool prove, int threads,
              const pybind11::object& progress) const;
  /// Returns the map with its window moved by a number of tiles (64 x 64 cells) in x and y.
  PythonMap moved(maps::Cell tiles) const;

 private:
  std::shared_ptr<Session> session_;
  PlannerSettings settings_{};
  std::vector<InputFile> files_;  // files from which the map was read
};

}  // namespace talus::planner
