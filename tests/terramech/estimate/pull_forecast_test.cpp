#include <cmath>

#include <thesis_runs.hpp>

#include <talus/terramech/contact/wong_reece.hpp>
#include <talus/terramech/estimate/pull_forecast.hpp>

namespace talus::terramech {
namespace pull_forecast_test {

TEST(PullForecast, PullAtTheSamplesMatchesTheTruth) {
  // Property: with 2 % errors the RMS error over 12 soils is below 0.012 (goal over 500 soils: 0.008).
  ThesisRuns runs(31);
  const ReadingErrors noise = ReadingErrors::relative(0.02);
  double squares = 0.0;
  int count = 0;
  for (int k = 0; k < 12; ++k) {
    const ThesisRun run = runs.next({.noise = 0.02});
    const SoilPosterior p = fitSoil(kThesisWheel, run.samples, thesisSoils(), {.noise = noise, .draws = 48});
    for (std::size_t i = 0; i < run.samples.size(); ++i, ++count) {
      squares +=
          std::pow(pullOverLoad(kThesisWheel, run.samples[i], p, noise).value - run.pull_over_load[i], 2);
    }
  }
  EXPECT_LT(std::sqrt(squares / count), 0.012);
}

TEST(PullForecast, PullUsesTheMostLikelyStateInsteadOfTheRawReading) {
  // Property: on a known soil, a sinkage reading 10 % too high changes the pull by less than half of the
  // change without correction, because load and torque correct the sinkage.
  ThesisRuns runs(33);
  for (int k = 0; k < 6; ++k) {
    const ThesisRun run = runs.next({.noise = 0.0});
    SoilPosterior known;
    known.draws = {{.soil = run.soil, .weight = 1.0}};
    WheelSample s = run.truth[5];
    s.sinkage_m *= 1.1;
    const ForceVector raw = contactForces(run.soil, kThesisWheel, {.sinkage_m = s.sinkage_m, .slip = s.slip});
    const double moved = pullOverLoad(kThesisWheel, s, known, {}).value - run.pull_over_load[5];
    EXPECT_LT(std::abs(moved), 0.5 * std::abs(raw[kPull] / raw[kLoad] - run.pull_over_load[5]));
  }
}

TEST(PullForecast, ExtrapolatesToSlipsNotDriven) {
  // Property: from exact readings at slips below 0.4, DP/W at slip 0.5 and its maximum are within 0.02 of
  // the soil's values.
  ThesisRuns runs(6);
  const ThesisRun run = runs.next({.noise = 0.0, .samples = 3});
  const SoilPosterior p =
      fitSoil(kThesisWheel, run.samples, thesisSoils(), {.noise = ReadingErrors::relative(2e-3)});
  const PullForecast f = forecastPull(kThesisWheel, p, {.load_N = 80.0});
  const Soil soil = soilOf(run.soil);
  const double truth = equilibrium(soil, kThesisWheel, {.load_N = 80.0, .slip = 0.5}).drawbar_pull_N / 80.0;
  EXPECT_NEAR(f.at_reference.value, truth, 0.02);
  EXPECT_GE(f.most.value, f.at_reference.value);
  EXPECT_NEAR(f.climbable_slope_rad.value, std::atan(f.most.value), 1e-12);
}

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

}  // namespace pull_forecast_test
}  // namespace talus::terramech
