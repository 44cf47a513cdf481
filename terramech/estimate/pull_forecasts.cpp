#include <cmath>

#include <talus/terramech/estimate/pull_forecasts.hpp>

namespace talus::terramech {
namespace {

constexpr double kStep = 0.01;  // step of ln W

Estimate between(const Estimate& a, const Estimate& b, double share) {
  return {.value = std::lerp(a.value, b.value, share), .std = std::lerp(a.std, b.std, share)};
}

}  // namespace

const PullForecast& PullForecasts::solved(const Wheel& wheel, int step) {
  const auto [place, added] = kept_.try_emplace({wheel.radius_m, wheel.width_m, step});
  if (added) {
    place->second =
        forecastPull(wheel, soil_, {.load_N = std::exp(kStep * step), .reference_slip = reference_slip_});
  }
  return place->second;
}

PullForecast PullForecasts::at(const Wheel& wheel, double load_N) {
  const double place = std::log(load_N) / kStep;
  const double below = std::floor(place);
  const PullForecast& a = solved(wheel, static_cast<int>(below));
  const PullForecast& b = solved(wheel, static_cast<int>(below) + 1);
  const double share = place - below;
  return {.at_reference = between(a.at_reference, b.at_reference, share),
          .most = between(a.most, b.most, share),
          .most_slip = std::lerp(a.most_slip, b.most_slip, share),
          .sinkage_over_radius = between(a.sinkage_over_radius, b.sinkage_over_radius, share),
          .climbable_slope_rad = between(a.climbable_slope_rad, b.climbable_slope_rad, share)};
}

}  // namespace talus::terramech
