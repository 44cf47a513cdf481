#include <thesis_runs.hpp>

#include <talus/terramech/estimate/pull_forecasts.hpp>

namespace talus::terramech {
namespace pull_forecasts_test {

TEST(PullForecasts, ForecastsMatchTheExactForecastPerLoadAndWheel) {
  // Property: linear interpolation between loads 1 % apart has an error below 1e-4; each wheel has its own
  // forecasts.
  ThesisRuns runs(31);
  const SoilPosterior soil = fitSoil(kThesisWheel, runs.next({.noise = 0.05}).samples, thesisSoils());
  PullForecasts forecasts(soil, 0.4);
  const Wheel large{.radius_m = 0.2, .width_m = 0.15};
  for (const Wheel& wheel : {kThesisWheel, large, kThesisWheel}) {
    for (const double load : {60.0, 73.21, 60.2}) {
      const PullForecast exact = forecastPull(wheel, soil, {.load_N = load, .reference_slip = 0.4});
      const PullForecast got = forecasts.at(wheel, load);
      EXPECT_NEAR(got.at_reference.value, exact.at_reference.value, 1e-4);
      EXPECT_NEAR(got.at_reference.std, exact.at_reference.std, 1e-4);
      EXPECT_NEAR(got.most.value, exact.most.value, 1e-4);
      EXPECT_NEAR(got.most_slip, exact.most_slip, 0.02);
      EXPECT_NEAR(got.sinkage_over_radius.value, exact.sinkage_over_radius.value, 1e-4);
      EXPECT_NEAR(got.sinkage_over_radius.std, exact.sinkage_over_radius.std, 1e-4);
      EXPECT_NEAR(got.climbable_slope_rad.value, exact.climbable_slope_rad.value, 1e-4);
    }
  }
}

}  // namespace pull_forecasts_test
}  // namespace talus::terramech
