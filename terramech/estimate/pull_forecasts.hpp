#pragma once

#include <map>
#include <tuple>

#include <talus/terramech/estimate/pull_forecast.hpp>

namespace talus::terramech {

/// Forecasts at many loads on one soil, each by a straight line between two loads 1 % apart that were solved
/// and are kept: a table of any length costs as many solutions as it has distinct loads, at most 140 a wheel
/// size where they differ by a factor of two.
class PullForecasts {
 public:
  PullForecasts(SoilPosterior soil, double reference_slip)
      : soil_(std::move(soil)), reference_slip_(reference_slip) {}

  /// At a load [N] > 0 on a wheel.
  PullForecast at(const Wheel& wheel, double load_N);

 private:
  const PullForecast& solved(const Wheel& wheel, int step);

  SoilPosterior soil_;
  double reference_slip_;
  std::map<std::tuple<double, double, int>, PullForecast> kept_;  // by radius, width, step of load
};

}  // namespace talus::terramech
