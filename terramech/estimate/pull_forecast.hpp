#pragma once

#include <array>
#include <map>
#include <tuple>
#include <utility>

#include <talus/terramech/estimate/drawbar_pull.hpp>
#include <talus/terramech/estimate/soil_posterior.hpp>

/// Drawbar pull predicted from the posterior of the soil, at measured wheel samples and at other slips
/// (ours).
namespace talus::terramech {

/// Returns DP/W (drawbar pull over load) at a measured sample. For each soil of the posterior the pull is
/// computed at the most likely sinkage and slip; the result is the mean over the posterior. `noise` are the
/// errors of the readings.
Estimate pullOverLoad(const Wheel& wheel, const WheelSample& sample, const SoilPosterior& posterior,
                      const ReadingErrors& noise);

/// Drawbar pull and sinkage of a wheel at one load on one soil.
struct PullForecast {
  Estimate at_reference;         ///< DP/W (drawbar pull over load) at the reference slip
  Estimate most;                 ///< maximum DP/W over slip
  double most_slip = 0.0;        ///< mean slip of maximum DP/W [-]
  Estimate sinkage_over_radius;  ///< sinkage over radius, z/r, at the reference slip
  Estimate climbable_slope_rad;  ///< climbable slope arctan(most)
};

/// Slips [-] among which the maximum pull is searched.
inline constexpr std::array kForecastSlips{0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0};

/// Options of forecastPull() on the posterior of a soil.
struct PullForecastOptions {
  double load_N = 0.0;          ///< vertical load, > 0
  double reference_slip = 0.5;  ///< slip in (0, 1] at which traversability is assessed (thesis 3.5)
  int draws = 48;               ///< number of soils resampled from the posterior, >= 1
};

/// Returns the pull at the reference slip and the maximum pull over kForecastSlips. The equilibrium of the
/// wheel is solved on soils that are drawn from the posterior. A soil that cannot carry the load has DP/W = 0
/// and z/r = 1. Throws std::invalid_argument for options outside their range.
PullForecast forecastPull(const Wheel& wheel, const SoilPosterior& posterior,
                          const PullForecastOptions& options);

/// Cache of drawbar-pull forecasts on one soil at many loads. A forecast is interpolated linearly between two
/// cached loads 1 % apart. The number of solved forecasts depends on the range of loads: at most 140 per
/// wheel size for loads within a factor of two.
class PullForecasts {
 public:
  PullForecasts(SoilPosterior soil, double reference_slip)
      : soil_(std::move(soil)), reference_slip_(reference_slip) {}

  /// Returns the forecast for a wheel under the load load_N > 0.
  PullForecast at(const Wheel& wheel, double load_N);

 private:
  const PullForecast& solved(const Wheel& wheel, int step);

  SoilPosterior soil_;
  double reference_slip_;
  std::map<std::tuple<double, double, int>, PullForecast> kept_;  // key: radius, width, index of the load
};

}  // namespace talus::terramech
