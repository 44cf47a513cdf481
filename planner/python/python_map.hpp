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

/// A map as Python holds it: the session of the C interface. One thread at a time works on it.
class PythonMap {
 public:
  /// What it is made from, as Python gives it.
  struct Layers {
    pybind11::object heights, classes, rocks, keep_out;  ///< arrays of one shape, or None
    pybind11::dict costs;                                ///< name: joules a metre
  };
  struct Ground {
    terramech::Rover rover;
    pybind11::object soils;  ///< a name or Soil, or a dict of class numbers to them
    costmap::DrivePolicy policy{};
    double resolution_m = 1.0;
    maps::Point south_west{};
    int threads = 1;
  };
  PythonMap(const Layers& layers, const Ground& ground);
  explicit PythonMap(costmap::TraversabilityMap map) : session_(std::make_shared<Session>(std::move(map))) {}
  /// A map file.
  static std::unique_ptr<PythonMap> read(const std::string& path, int threads);

  const costmap::TraversabilityMap& map() const noexcept { return session_->map; }

  /// New ground in a window; heights may be None.
  void patch(const Layers& layers, maps::Point south_west);
  /// Columns of telemetry, or the path of a file. Rows that taught something.
  std::size_t learn(const pybind11::object& telemetry);
  /// What all rows since the map was made or read say of the sensors (DriveIntake::settle()).
  void settle();
  void save(const std::string& path) const;
  /// The GeoJSON of `talus plan`.
  void writeRoute(const Route& route, const std::string& path) const;
  Route plan(const PlannerSettings& settings, const PlanRequest& request, const pybind11::object& progress);
  PythonMap moved(maps::Cell tiles) const;

 private:
  std::shared_ptr<Session> session_;
  PlannerSettings settings_{};
  std::vector<RouteInput> files_;  // that the map was read from
};

}  // namespace talus::planner
