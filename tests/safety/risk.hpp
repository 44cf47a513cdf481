#pragma once

#include <cstdint>

#include "judge.hpp"

namespace safety {

/// The chance that soil holds the rover somewhere on a route, by drawing worlds.
struct DrawnRisk {
  double immobilisation = 0.0;
  double standard_error = 0.0;
  int weak_worlds = 0;  ///< in which the route is too weak somewhere
};

/// How worlds are drawn.
struct RiskDraw {
  int worlds = 2000;
  double entrapment = 0.01;  ///< of a place that is too weak, 5 m of it (docs/limits.md)
  std::uint64_t seed = 1;
};

/// Draws departures of the ground at stations a metre apart from the Gaussian that the belief leaves, class and
/// place together, by its Cholesky factor. A world in which the wheels together do not hold the slope, along and across it,
/// over T metres holds the rover with 1 - (1 - entrapment)^(T / 5 m).
DrawnRisk drawnRisk(const Site& site, const Belief& belief, const Route& route, const RiskDraw& draw = {});

}  // namespace safety
