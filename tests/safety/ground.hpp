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

/// Ground of one class under one rover.
struct GroundKind {
  PullCurve fresh;
  PullCurve rut;
  double class_deviation = 0.05;  ///< of DP/W, of the class as a whole [-]
  double place_deviation = 0.05;  ///< of DP/W from place to place (docs/limits.md) [-]
};

using Polygon = std::vector<Place>;

/// All that a route is judged on, read from files.
struct Site {
  Raster elevation_m;
  std::optional<Raster> classes;                           ///< class numbers; none: all of class 0
  std::map<int, std::shared_ptr<const GroundKind>> kinds;  ///< by class number
  std::vector<Polygon> keep_out;
  Rover rover;

  /// Number of the class under a place; nothing where there is no ground, or none with a soil.
  std::optional<int> classAt(Place p) const;
  /// Radius of the disc that slopes are taken over: half the diagonal between the wheels.
  double footprint_m() const;
  /// Whether a place lies in a polygon to keep out of.
  bool keptOut(Place p) const;
};

/// A kind of ground, worked out once for each soil and rover.
std::shared_ptr<const GroundKind> groundKind(const SoilPrior& prior, const Rover& rover);

}  // namespace safety
