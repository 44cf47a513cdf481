#pragma once

#include <cstdint>
#include <vector>

#include <talus/common/progress_monitor.hpp>
#include <talus/costmap/cost/cost_grid.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// Parameters of the risk simulation of a route.
struct RouteRiskOptions {
  double correlation_length_m = 5.0;  ///< correlation length of the soil, as in TravelPolicy, > 0
  double entrapment = 1.0;  ///< share of the places with too weak soil that immobilise the rover, [0, 1], as
                            ///< in the hazard per metre
  /// Soil is uniform within a cell of this size: stretches are treated as at least this far apart, >= 0.
  double cell_m = 0.0;
  double tail = 0.05;  ///< share of the worst worlds averaged by cvar, in (0, 1]
  int worlds = 4000;   ///< number of simulated worlds, > 0
  std::uint64_t seed = 1;
};

/// Options of the map's cost, and the size of the map's cells.
RouteRiskOptions riskOptions(const costmap::CostGrid& map);

/// Risk of a route on spatially correlated soil.
struct RouteRisk {
  double immobilisation = 0.0;  ///< probability that the rover is immobilised on the route
  double standard_error = 0.0;  ///< of `immobilisation`, from the number of worlds
  double cvar = 0.0;  ///< mean, over the worst share of worlds, of the smallest reserve on the route, in
                      ///< standard deviations of the soil's pull; < 0: too weak on average in those worlds
  double worst_x_m = 0.0;  ///< place that most often has the smallest reserve
  double worst_y_m = 0.0;
};

/// Probability of immobilisation from the start to each vertex.
///
/// A stretch between two vertices is too weak if beta + u < 0. The reliability index beta follows from the
/// stretch's hazard per metre. u is Gaussian with variance 1: the sum of a component shared by all ground of
/// the class (RouteVertex::shared_variance_share) and a process along the route with correlation exp(-d /
/// correlation_length) within a class, independent across changes of the class. A world in which the soil is
/// too weak over a length T immobilises the rover with probability 1 - (1 - entrapment)^(T /
/// correlation_length). Worlds are drawn under the condition that one stretch fails, each stretch in
/// proportion to its expected length of too weak soil, and weighted by the inverse of the total length that
/// fails with it. The estimate is unbiased and equally accurate for 1e-9 and 0.1 (importance sampling of a
/// union of events, adler_blanchet_liu_2012). Deterministic. Throws std::invalid_argument if an option is out
/// of range. Empty if `watch` was stopped before all worlds of a long route were simulated; four million
/// stretches (about 0.25 s) are always simulated.
std::vector<double> riskAlong(const Route& route, const RouteRiskOptions& options,
                              const ProgressMonitor& watch = {});

/// Returns an upper bound of riskAlong() for any correlation of the soil: the sum of the stretches' own
/// risks, at most 1. Deterministic, without random draws. Throws std::invalid_argument if an option is out of
/// range.
std::vector<double> riskBoundAlong(const Route& route, const RouteRiskOptions& options);

/// Risk of the whole route as in riskAlong(), and the tail of its reserve: the conditional value at risk
/// after Rockafellar & Uryasev 2000 [rockafellar_uryasev_2000]. All values are NaN if `watch` was stopped
/// before all worlds were simulated (see riskAlong()).
RouteRisk routeRisk(const Route& route, const RouteRiskOptions& options = {},
                    const ProgressMonitor& watch = {});

}  // namespace talus::planner
