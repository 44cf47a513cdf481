#pragma once

#include <cstdint>

#include "judge.hpp"

namespace safety {

/// Probability of immobilisation somewhere on a route, estimated by Monte Carlo sampling of worlds.
struct DrawnRisk {
  double immobilisation = 0.0;
  double standard_error = 0.0;
  int weak_worlds = 0;  ///< number of worlds in which the route is too weak somewhere
};

/// Options of the sampling.
struct RiskDraw {
  int worlds = 2000;
  double entrapment = 0.01;  ///< immobilisation probability of 5 m of too weak ground (docs/limits.md)
  std::uint64_t seed = 1;
};

/// Draws departures of the ground at stations one metre apart from the Gaussian posterior of the belief
/// (class and place effects together) by its Cholesky factor. In a world in which the wheels have no
/// equilibrium along and across the slope over T metres, the rover is immobilised with probability 1 - (1 -
/// entrapment)^(T / 5 m).
DrawnRisk drawnRisk(const Site& site, const Belief& belief, const Route& route, const RiskDraw& draw = {});

}  // namespace safety
