#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "library.hpp"
#include "pull_curve.hpp"
#include "raster.hpp"

namespace safety {

/// Properties of the ground of one class under one rover.
struct GroundKind {
  PullCurve fresh;
  PullCurve rut;
  double class_deviation = 0.05;  ///< standard deviation of DP/W of the class as a whole [-]
  double place_deviation = 0.05;  ///< standard deviation of DP/W between places (docs/limits.md) [-]
};

using Polygon = std::vector<Place>;

/// All data by which a route is judged, read from files.
struct Site {
  Raster elevation_m;
  std::optional<Raster> classes;                           ///< class numbers; nullopt: class 0 everywhere
  std::map<int, std::shared_ptr<const GroundKind>> kinds;  ///< by class number
  std::vector<Polygon> keep_out;
  Rover rover;

  /// Class number at a place; nullopt outside the map, without a class, or for a class without a soil.
  std::optional<int> classAt(Place p) const;
  /// Radius of the disc over which slopes are computed: half the diagonal between the wheels.
  double footprint_m() const;
  /// Whether a place lies in a keep-out polygon.
  bool keptOut(Place p) const;
};

/// Ground properties of a soil under a rover, computed once for each pair.
std::shared_ptr<const GroundKind> groundKind(const SoilPrior& prior, const Rover& rover);

}  // namespace safety
