#pragma once

#include <array>

#include <talus/terramech/estimate/drawbar_pull.hpp>
#include <talus/terramech/estimate/soil_posterior.hpp>

/// Drawbar pull from the soil's posterior: at the samples it was inferred from, and at slips not driven
/// (ours).
namespace talus::terramech {

/// DP/W at a sample, by the contact at the (z, i) that the soil makes most likely, averaged over the
/// posterior.
Estimate pullOverLoad(const Wheel& wheel, const WheelSample& sample, const SoilPosterior& posterior,
                      const ReadingErrors& noise);

/// What the soil will bear, at one load.
struct PullForecast {
  Estimate at_reference;         ///< DP/W at the reference slip
  Estimate most;                 ///< DP/W at the slip of greatest pull
  double most_slip = 0.0;        ///< that slip, its mean [-]
  Estimate sinkage_over_radius;  ///< z/r at the reference slip
  Estimate climbable_slope_rad;  ///< arctan of `most`
};

/// Slips among which the greatest pull is sought.
inline constexpr std::array kForecastSlips{0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};

/// How to forecast.
struct PullForecastOptions {
  double load_N = 0.0;          ///< > 0
  double reference_slip = 0.5;  ///< (0, 1] (thesis 3.5)
  int draws = 48;               ///< soils out of the posterior that are driven on, >= 1
};

/// Extrapolates from the slips driven at to the reference slip and to the slip of greatest pull, by solving
/// the wheel on soils drawn from the posterior. Soils that cannot carry the load count as no pull and z/r
/// = 1. Throws std::invalid_argument for options out of range.
PullForecast forecastPull(const Wheel& wheel, const SoilPosterior& posterior,
                          const PullForecastOptions& options);

}  // namespace talus::terramech
