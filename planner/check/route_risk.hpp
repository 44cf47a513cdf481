#pragma once

#include <cstdint>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// How the risk of a route is drawn.
struct RouteRiskOptions {
  double correlation_length_m = 5.0;  ///< of the soil, as DrivePolicy's, > 0
  double entrapment = 1.0;  ///< share of the places with too weak soil that hold the rover, [0, 1]: as its
                            ///< hazard per metre counts it
  double cell_m =
      0.0;  ///< the soil of a cell of this size is one: stretches of different cells are at least so
            ///< far apart, >= 0
  double tail = 0.05;  ///< share of the worst worlds that cvar looks at, in (0, 1]
  int worlds = 4000;   ///< drawn, > 0
  std::uint64_t seed = 1;
};

/// The options that a map's cost was made with, and the size of its cells.
RouteRiskOptions riskOptions(const costmap::CostGrid& map);

/// The risk of a route over spatially correlated soil.
struct RouteRisk {
  double immobilisation = 0.0;  ///< probability that some place of the route holds the rover
  double standard_error = 0.0;  ///< of that, from the number of worlds drawn
  double cvar = 0.0;  ///< mean over the worst share of worlds of the least reserve on the route, in standard
                      ///< deviations of the soil's pull; below 0: too weak on average in those worlds
  double worst_x_m = 0.0;  ///< where most worlds have their least reserve
  double worst_y_m = 0.0;
};

/// Probability of immobilisation from the start to each vertex.
///
/// A stretch between two vertices is too weak where beta + u < 0. beta, its reliability index, is what its hazard
/// per metre says; u is Gaussian with variance 1: a part that all ground of its class shares (RouteVertex::
/// shared_doubt), and for the rest a process along the route with correlation exp(-d / correlation_length) within
/// a class, drawn anew where the class changes. A world in which the route is too weak for T metres holds the
/// rover with 1 - (1 - entrapment)^(T / correlation_length). Worlds are drawn under the condition that a stretch
/// fails, each stretch as often as it contributes, and divided by the metres that fail together with it: unbiased,
/// and as exact for 1e-9 as for 0.1 (importance sampling of a union of events, adler_blanchet_liu_2012).
/// Deterministic. Throws std::invalid_argument out of range. Empty when `watch` was stopped before all worlds of a long
/// route were drawn; four million stretches of worlds, a quarter of a second, are always drawn.
std::vector<double> riskAlong(const Route& route, const RouteRiskOptions& options,
                              const ProgressMonitor& watch = {});

/// What riskAlong() is never above, however the soil is correlated: the stretches' own risks, added up, at most 1. It takes no
/// draws. Throws as that does.
std::vector<double> riskBoundAlong(const Route& route, const RouteRiskOptions& options);

/// The risk of the whole route as riskAlong() has it, and the tail of its reserve: conditional value at risk after Rockafellar & Uryasev
/// 2000 [rockafellar_uryasev_2000]. Where `watch` was stopped before all worlds were drawn, which riskAlong() tells of, all is NaN.
RouteRisk routeRisk(const Route& route, const RouteRiskOptions& options = {},
                    const ProgressMonitor& watch = {});

}  // namespace talus::planner
