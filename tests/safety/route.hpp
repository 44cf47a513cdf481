#pragma once

#include <string>
#include <vector>

#include "raster.hpp"

namespace safety {

/// A pose on a route.
struct Station {
  Place place;
  double heading_rad = 0.0;  ///< direction of the motion
  double along_m = 0.0;      ///< distance along the route from the start
  bool turning = false;      ///< reached by a turn on the spot
};

/// A route as read from its file.
struct Route {
  std::vector<Place> vertices;
  std::vector<double> elevation_m;  ///< elevation of the vertices
  std::vector<double> turn_rad;     ///< turn on the spot at a vertex, from the vertex's heading
  std::vector<double> heading_rad;
  std::vector<std::string> category;
  double immobilisation_risk = 0.0;  ///< as printed by the program

  double length_m() const;
  /// Poses at most a step apart. Every vertex appears in the headings of both its legs; turns on the spot
  /// are sampled at most 0.1 rad apart.
  std::vector<Station> stations(double step_m) const;
};

/// Reads a route from GeoJSON. Throws std::runtime_error.
Route readRoute(const std::string& path);

}  // namespace safety
