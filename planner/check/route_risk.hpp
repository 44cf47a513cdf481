#pragma once

#include <cstdint>
#include <vector>

#include <talus/common/common.hpp>
#include <talus/costmap/cost/cost_model.hpp>
#include <talus/planner/route/route.hpp>

namespace talus::planner {

/// Parameters of the risk simulation of a route.
struct RouteRiskOptions {
  double correlation_length_m = 5.0;  ///< correlation length of the soil (TravelPolicy), > 0
  /// Probability that too weak soil over one correlation length immobilises the rover, [0, 1]; the hazard per
  /// metre uses the same value.
  double entrapment = 1.0;
  /// Cell size of the map, >= 0. Soil is uniform within a cell; therefore the correlation between two parts
  /// of the route is computed for a distance of at least this size.
  double cell_m = 0.0;
  double tail = 0.05;      ///< share of the worst worlds over which RouteRisk::cvar is the mean, (0, 1]
  int worlds = 4000;       ///< number of simulated worlds (random draws of the soil), > 0
  std::uint64_t seed = 1;  ///< seed of the random draws
};

/// Returns the options given by the cost function and the cell size of the map.
RouteRiskOptions riskOptions(const costmap::CostGrid& map);

/// Risk of a route on spatially correlated soil.
struct RouteRisk {
  double immobilisation = 0.0;  ///< probability that the rover is immobilised on the route, [0, 1]
  double standard_error = 0.0;  ///< standard error of `immobilisation` for the number of worlds
  /// Conditional value at risk of the reserve: mean, over the worst share of worlds, of the smallest reserve
  /// beta + u on the route (riskAlong()), in standard deviations of DP/W; < 0: too weak on average in those
  /// worlds.
  double cvar = 0.0;
  double worst_x_m = 0.0;  ///< position that most often, over all worlds, has the smallest reserve
  double worst_y_m = 0.0;
};

/// Returns the probability of immobilisation from the start to each vertex.
///
/// A stretch is the part of the route between two consecutive vertices. It is too weak if its reserve beta +
/// u < 0. The reliability index beta follows from the hazard per metre of the stretch. The deviate u is
/// Gaussian with variance 1. It is the sum of a component shared by all ground of the terrain class
/// (RouteVertex::shared_variance_share) and a process along the route. The process has the correlation exp(-d
/// / correlation_length) over a distance d within a class, and is independent across changes of the class. A
/// world with too weak soil over a length T immobilises the rover with probability 1 - (1 - entrapment)^(T /
/// correlation_length). Each world is drawn under the condition that a selected stretch is too weak. A
/// stretch is selected in proportion to its expected length of too weak soil, and the world is weighted by
/// the inverse of the total too weak length in it. The estimate is unbiased and has the same relative
/// accuracy for 1e-9 and 0.1 (importance sampling of a union of events, adler_blanchet_liu_2012).
/// Deterministic. Throws std::invalid_argument if an option is out of range. The result is empty if `watch`
/// was stopped before all worlds of a long route were simulated; four million stretches (about 0.25 s) are
/// always simulated.
std::vector<double> riskAlong(const Route& route, const RouteRiskOptions& options,
                              const ProgressMonitor& watch = {});

/// Energy or time of a drive that arrives: its mean, and what it does not exceed with the probability 0.9.
struct DriveEffort {
  double mean = 0.0, p90 = 0.0;
};

/// Energy [J] and time [s] of the drives along a route that arrive, without turns.
struct RouteForecast {
  DriveEffort energy_J, time_s;
};

/// Returns the forecast of a route on a map from up to 1000 drives by the distribution of the strength of
/// riskAlong() (costmap::TravelForecast) and of the stiffness of the ruts of each class. Drives that fail are left out, unless all do. Deterministic.
RouteForecast routeForecast(const Route& route, const costmap::CostGrid& map,
                            const RouteRiskOptions& options);

/// Returns an upper bound of riskAlong() for any correlation of the soil: the sum of the risks of the single
/// stretches, at most 1. Deterministic, without random draws. Throws std::invalid_argument if an option is
/// out of range.
std::vector<double> riskBoundAlong(const Route& route, const RouteRiskOptions& options);

/// Returns the risk of the whole route by the method of riskAlong(), and the conditional value at risk of its
/// reserve after Rockafellar & Uryasev 2000 [rockafellar_uryasev_2000]. All values are NaN if `watch` was
/// stopped before all worlds were simulated (see riskAlong()).
RouteRisk routeRisk(const Route& route, const RouteRiskOptions& options = {},
                    const ProgressMonitor& watch = {});

}  // namespace talus::planner
