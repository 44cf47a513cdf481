#pragma once

#include <map>
#include <tuple>

#include <talus/terramech/estimate/pull_forecast.hpp>

namespace talus::terramech {

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
