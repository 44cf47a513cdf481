#pragma once

#include <map>
#include <memory>
#include <string>

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <talus/planner/c/session.hpp>

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

  const costmap::TraversabilityMap& map() const noexcept { return session_->map; }

  /// New ground in a window; heights may be None.
  void patch(const Layers& layers, maps::Point south_west);
  /// Columns of telemetry, or the path of a file. Rows that taught something.
  std::size_t learn(const pybind11::object& telemetry);
  Route plan(const PlannerSettings& settings, const PlanRequest& request, const pybind11::object& progress);
  PythonMap moved(maps::Cell tiles) const;

 private:
  std::shared_ptr<Session> session_;
  PlannerSettings settings_{};
};

}  // namespace talus::planner
