#pragma once

#include <array>

#include <talus/terramech/estimate/drawbar_pull.hpp>
#include <talus/terramech/estimate/soil_posterior.hpp>

/// Drawbar pull from the posterior of the soil, at the samples used for the posterior and at other slips
/// (ours).
namespace talus::terramech {

/// Returns DP/W at a sample: the contact at the most likely (z, i) of each soil, averaged over the posterior.
Estimate pullOverLoad(const Wheel& wheel, const WheelSample& sample, const SoilPosterior& posterior,
                      const ReadingErrors& noise);

/// Drawbar pull and sinkage of a soil at one load.
struct PullForecast {
  Estimate at_reference;         ///< DP/W at the reference slip
  Estimate most;                 ///< DP/W at the slip of maximum pull
  double most_slip = 0.0;        ///< mean slip of maximum pull [-]
  Estimate sinkage_over_radius;  ///< z/r at the reference slip
  Estimate climbable_slope_rad;  ///< arctan(most)
};

/// Slips [-] at which the maximum pull is searched.
inline constexpr std::array kForecastSlips{0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};

/// Options of forecastPull().
struct PullForecastOptions {
  double load_N = 0.0;          ///< > 0
  double reference_slip = 0.5;  ///< (0, 1] (thesis 3.5)
  int draws = 48;               ///< number of soils resampled from the posterior, >= 1
};

/// Returns the pull at the reference slip and at the slip of maximum pull, by solving the equilibrium of the
/// wheel on soils drawn from the posterior. A soil that cannot carry the load has DP/W = 0 and z/r = 1.
/// Throws std::invalid_argument for options outside their range.
PullForecast forecastPull(const Wheel& wheel, const SoilPosterior& posterior,
                          const PullForecastOptions& options);

}  // namespace talus::terramech
