#pragma once

#include <string>
#include <vector>

#include "raster.hpp"

namespace safety {

/// A pose on a route.
struct Station {
  Place place;
  double heading_rad = 0.0;  ///< of the motion
  double along_m = 0.0;      ///< way from the start
  bool turning = false;      ///< turned to on the spot
};

/// A route as its file tells it.
struct Route {
  std::vector<Place> vertices;
  std::vector<double> elevation_m;  ///< of the vertices
  std::vector<double> turn_rad;     ///< on the spot, from a vertex's heading
  std::vector<double> heading_rad;
  std::vector<std::string> category;
  double immobilisation_risk = 0.0;  ///< printed

  double length_m() const;
  /// Poses no further apart than a step, at every vertex in the headings of both its legs, and no more than
  /// 0.1 rad apart where it turns on the spot.
  std::vector<Station> stations(double step_m) const;
};

/// Reads a route's GeoJSON. Throws std::runtime_error.
Route readRoute(const std::string& path);

}  // namespace safety
