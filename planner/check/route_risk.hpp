#pragma once

#include <cstdint>

#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// How the risk of a route is drawn.
struct RouteRiskOptions {
  double correlation_length_m = 5.0;  ///< of the soil, as DrivePolicy's, > 0
  double tail = 0.05;                 ///< share of the worst worlds that cvar looks at, in (0, 1]
  int worlds = 4000;                  ///< drawn, > 0
  std::uint64_t seed = 1;
};

/// The risk of a route over spatially correlated soil.
struct RouteRisk {
  double immobilisation = 0.0;  ///< probability that the soil fails the rover somewhere on the route
  double standard_error = 0.0;  ///< of that, from the number of worlds drawn
  double cvar = 0.0;  ///< mean over the worst share of worlds of the least reserve on the route, in standard
                      ///< deviations of the soil's pull; below 0: stuck on average in those worlds
  double worst_x_m = 0.0;  ///< where most worlds have their least reserve
  double worst_y_m = 0.0;
};

/// Draws worlds of soil along the route and drives it in each. The reserve at a vertex is beta + u: beta, its
/// reliability index, is what the hazard rate along the route says of it; u is a standard Gaussian process
/// along the route with correlation exp(-d / correlation_length). Conditional value at risk after Rockafellar
/// & Uryasev 2000 [rockafellar_uryasev_2000]. Deterministic. Throws std::invalid_argument out of range.
RouteRisk routeRisk(const Route& route, const RouteRiskOptions& options = {});

}  // namespace talus::planner
