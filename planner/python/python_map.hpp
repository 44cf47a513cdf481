#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <talus/planner/c/session.hpp>
#include <talus/planner/route/route_json.hpp>

namespace talus::planner {

/// Map of the Python package, based on the session of the C interface. Used by one thread at a time.
class PythonMap {
 public:
  /// Input of the map as Python objects.
  struct Layers {
    pybind11::object heights, classes, rocks, keep_out;  ///< arrays of equal shape, or None
    pybind11::dict costs;                                ///< name: joules per metre
  };
  struct Ground {
    terramech::Rover rover;
    pybind11::object soils;  ///< a name or Soil, or a dict of class numbers to names or Soils
    costmap::TravelPolicy policy{};
    double resolution_m = 1.0;
    maps::Point south_west{};
    int threads = 1;
  };
  PythonMap(const Layers& layers, const Ground& ground);
  explicit PythonMap(costmap::TraversabilityMap map) : session_(std::make_shared<Session>(std::move(map))) {}
  /// Reads a map file.
  static std::unique_ptr<PythonMap> read(const std::string& path, int threads);

  const costmap::TraversabilityMap& map() const noexcept { return session_->map; }

  /// Updates the map in a window; heights may be None.
  void patch(const Layers& layers, maps::Point south_west);
  /// Adds telemetry, as columns or as the path of a file. Returns the number of rows used.
  std::size_t learn(const pybind11::object& telemetry);
  /// Re-evaluates all rows since the map was made or read (DriveIntake::settle()).
  void settle();
  void save(const std::string& path) const;
  /// Writes the route as GeoJSON, as `talus plan` does.
  void writeRoute(const Route& route, const std::string& path) const;
  Route plan(const PlannerSettings& settings, const PlanRequest& request, const pybind11::object& progress);
  PythonMap moved(maps::Cell tiles) const;

 private:
  std::shared_ptr<Session> session_;
  PlannerSettings settings_{};
  std::vector<RouteInput> files_;  // files from which the map was read
};

}  // namespace talus::planner
