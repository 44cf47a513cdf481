#include <cmath>

#include <thesis_runs.hpp>

#include <talus/terramech/estimate/soil_estimation.hpp>

namespace talus::terramech {
namespace soil_filter_test {

TEST(SoilFilter, EqualsTheBatchEstimateWithinTheWindow) {
  // Property: filter and batch fit have the same modes within the tolerance of the search, and therefore
  // almost equal draws.
  ThesisRuns runs(8);
  const ThesisRun run = runs.next({.noise = 0.05});
  SoilFilter filter(kThesisWheel, thesisSoils(), {});
  for (const WheelSample& s : run.samples) filter.add(s);
  const SoilPosterior batch = fitSoil(kThesisWheel, run.samples, thesisSoils());
  EXPECT_NEAR(filter.posterior().mean.cohesion_Pa, batch.mean.cohesion_Pa,
              0.15 * std::sqrt(batch.covariance(0, 0)));
  EXPECT_NEAR(filter.posterior().mean.friction_angle_rad, batch.mean.friction_angle_rad,
              0.15 * std::sqrt(batch.covariance(1, 1)));
}

TEST(SoilFilter, MatchesTheBatchEstimateBeyondTheWindow) {
  // Property: with 40 samples, 12 of them kept, the result is within half a standard deviation of the fit of
  // all 40.
  ThesisRuns runs(12);
  const ThesisRun run = runs.next({.noise = 0.05, .samples = 40});
  SoilFilter filter(kThesisWheel, thesisSoils(), {});
  for (const WheelSample& s : run.samples) filter.add(s);
  const SoilPosterior batch = fitSoil(kThesisWheel, run.samples, thesisSoils());
  const SoilPosterior p = filter.posterior();
  EXPECT_NEAR(p.mean.cohesion_Pa, batch.mean.cohesion_Pa, 0.5 * std::sqrt(batch.covariance(0, 0)) + 50.0);
  EXPECT_NEAR(p.mean.sinkage_exponent, batch.mean.sinkage_exponent,
              0.5 * std::sqrt(batch.covariance(2, 2)) + 0.01);
  EXPECT_EQ(filter.samples(), 40u);
}

TEST(SoilFilter, RejectedSampleLeavesTheStateUnchanged) {
  ThesisRuns runs(3);
  SoilFilter filter(kThesisWheel, thesisSoils(), {});
  for (const WheelSample& s : runs.next({.noise = 0.05}).samples) filter.add(s);
  const double before = filter.mode().cohesion_Pa;
  EXPECT_THROW(filter.add({.load_N = -1.0, .torque_Nm = 1.0, .sinkage_m = 0.01, .slip = 0.3}),
               std::invalid_argument);
  EXPECT_EQ(filter.mode().cohesion_Pa, before);
  EXPECT_EQ(filter.samples(), 10u);
}

TEST(SoilFilter, SinkageExponentHasNoBiasOverManySamples) {
  // Property: over eight runs of sixty samples the mean departure of n from the batch fit is below 0.3
  // standard deviations. Without the slope of the normalisation n is 0.7 too low.
  ThesisRuns runs(44);
  double departure = 0.0;
  for (int k = 0; k < 8; ++k) {
    const ThesisRun run = runs.next({.noise = 0.05, .samples = 60});
    const SoilMixture known{thesisSoils()[static_cast<std::size_t>(run.soil_class)]};
    SoilFilter filter(kThesisWheel, known, {});
    for (const WheelSample& s : run.samples) filter.add(s);
    const SoilPosterior batch = fitSoil(kThesisWheel, run.samples, known);
    departure += (filter.posterior().mean.sinkage_exponent - batch.mean.sinkage_exponent) /
                 std::sqrt(batch.covariance(kExponent, kExponent)) / 8.0;
  }
  EXPECT_NEAR(departure, 0.0, 0.3);
}

TEST(SoilFilter, RetainsInformationOfSamplesOutsideTheWindow) {
  // Property: sixty samples on a known class give smaller standard deviations of phi and K than the last
  // twelve alone.
  ThesisRuns runs(44);
  const ThesisRun run = runs.next({.noise = 0.05, .samples = 60});
  const SoilMixture known{thesisSoils()[static_cast<std::size_t>(run.soil_class)]};
  SoilFilter filter(kThesisWheel, known, {});
  for (const WheelSample& s : run.samples) filter.add(s);
  const auto all = filter.posterior().covariance;
  const auto window = fitSoil(kThesisWheel, std::span(run.samples).last(12), known).covariance;
  EXPECT_LT(all(kShear, kShear), 0.5 * window(kShear, kShear));
  EXPECT_LT(all(kFriction, kFriction), 0.5 * window(kFriction, kFriction));
}

}  // namespace soil_filter_test
}  // namespace talus::terramech
