#include <cmath>
#include <stop_token>

#include <thesis_runs.hpp>

#include <talus/terramech/estimate/many_samples.hpp>
#include <talus/terramech/estimate/soil_posterior.hpp>

namespace talus::terramech {
namespace many_samples_test {

std::vector<WheelReading> numbered(std::size_t count) {
  std::vector<WheelReading> readings;
  for (std::size_t k = 0; k < count; ++k)
    readings.push_back({.wheel = {}, .sample = {.load_N = static_cast<double>(k)}});
  return readings;
}

TEST(ManySamples, StdMatchesTheRmsErrorForSixHundredSamples) {
  // Property: over twelve soils of known class with 600 samples each, the RMS errors of c, phi and K are
  // within a factor of two of the posterior standard deviations. In a search that neglects the gradient of
  // the normalisation, the errors are five standard deviations.
  ThesisRuns runs(71);
  double squares[3] = {};
  constexpr int kSoils = 12;
  for (int k = 0; k < kSoils; ++k) {
    const ThesisRun run = runs.next({.noise = 0.05, .samples = 600});
    const auto p = fitSoil(kThesisWheel, run.samples,
                           {thesisSoils()[static_cast<std::size_t>(run.soil_class)]}, {.draws = 128});
    const double away[3] = {p.mean.cohesion_Pa - run.soil.cohesion_Pa,
                            p.mean.friction_angle_rad - run.soil.friction_angle_rad,
                            p.mean.shear_modulus_m - run.soil.shear_modulus_m};
    const ContactColumn column[3] = {kCohesion, kFriction, kShear};
    for (int m = 0; m < 3; ++m) squares[m] += away[m] * away[m] / p.covariance(column[m], column[m]) / kSoils;
    EXPECT_GT(p.effective_draws, 30.0);
  }
  for (const double s : squares) {
    EXPECT_GT(std::sqrt(s), 0.4);
    EXPECT_LT(std::sqrt(s), 2.0);
  }
}

TEST(ManySamples, QuadraticAndWeightedPosteriorsAgreeAtTheSwitch) {
  // Property: the method for more than 300 samples gives the same result as the method for 300 samples.
  ThesisRuns runs(72);
  const ThesisRun run = runs.next({.noise = 0.05, .samples = 301});
  const SoilMixture known{thesisSoils()[static_cast<std::size_t>(run.soil_class)]};
  const SoilPosterior weighed = fitSoil(kThesisWheel, std::span(run.samples).first(300), known);
  const SoilPosterior quadratic = fitSoil(kThesisWheel, run.samples, known);
  for (const ContactColumn k : {kCohesion, kFriction, kShear}) {
    const double std = std::sqrt(weighed.covariance(k, k));
    EXPECT_NEAR(std::sqrt(quadratic.covariance(k, k)), std, 0.25 * std);
  }
  EXPECT_NEAR(quadratic.mean.cohesion_Pa, weighed.mean.cohesion_Pa,
              0.5 * std::sqrt(weighed.covariance(kCohesion, kCohesion)));
  EXPECT_NEAR(quadratic.misfit, weighed.misfit, 0.05);
}

TEST(ManySamples, StdIsBoundedBelowByModelError) {
  // Property: from 4000 samples on the standard deviation is constant; with all samples counted it would
  // shrink by 1.4.
  ThesisRuns runs(74);
  const ThesisRun run = runs.next({.noise = 0.05, .samples = 8000});
  const SoilMixture known{thesisSoils()[static_cast<std::size_t>(run.soil_class)]};
  const SoilPosterior half = fitSoil(kThesisWheel, std::span(run.samples).first(4000), known);
  const SoilPosterior whole = fitSoil(kThesisWheel, run.samples, known);
  for (const ContactColumn k : {kCohesion, kFriction})
    EXPECT_NEAR(std::sqrt(whole.covariance(k, k) / half.covariance(k, k)), 1.0, 0.15);
}

TEST(ManySamples, ReportsProgressAndStopsOnRequest) {
  // Property: reported progress grows from 0 to 1; a stop request leaves no draws.
  ThesisRuns runs(73);
  const ThesisRun run = runs.next({.noise = 0.05, .samples = 5000});
  const SoilMixture known{thesisSoils()[static_cast<std::size_t>(run.soil_class)]};
  double last = 0.0;
  int reports = 0;
  SoilFitOptions options;
  options.watch.progress = [&](double fraction) {
    EXPECT_GE(fraction, last);
    EXPECT_LE(fraction, 1.0);
    last = fraction;
    ++reports;
  };
  EXPECT_FALSE(fitSoil(kThesisWheel, run.samples, known, options).draws.empty());
  EXPECT_GT(reports, 10);
  std::stop_source source;
  int after = 0;
  options.watch.stop = source.get_token();
  options.watch.progress = [&](double) { after += source.stop_requested() ? 1 : (source.request_stop(), 0); };
  EXPECT_TRUE(fitSoil(kThesisWheel, run.samples, known, options).draws.empty());
  EXPECT_EQ(after, 0);
}

TEST(ManySamples, SubsampleIsStratifiedWithoutPeriodicAliasing) {
  // Property: the selection is in order, without repetition, with one element of every section; a pattern
  // with the period of the sections is sampled in all phases.
  const auto all = numbered(4096);
  const auto part = spreadEvenly(all, 512);
  ASSERT_EQ(part.size(), 512u);
  int in_phase[8] = {};
  for (std::size_t k = 0; k < part.size(); ++k) {
    const auto row = static_cast<std::size_t>(part[k].sample.load_N);
    EXPECT_EQ(row / 8, k);
    ++in_phase[row % 8];
  }
  for (const int count : in_phase) EXPECT_NEAR(count, 64, 8);
  EXPECT_EQ(spreadEvenly(numbered(10), 512).size(), 10u);
}

}  // namespace many_samples_test
}  // namespace talus::terramech
