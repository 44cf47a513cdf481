#include <cmath>
#include <limits>
#include <numbers>
#include <stop_token>

#include <thesis_runs.hpp>

#include <talus/terramech/estimate/soil_estimation.hpp>
#include <talus/terramech/estimate/soil_objective.hpp>
#include <talus/terramech/numerics/functions.hpp>

#include "exact_likelihood.hpp"

namespace talus::terramech {

namespace soil_objective_test {

const SoilBox kUnit{SoilVector::Zero(), SoilVector::Ones()};

SoilMatrix correlated() {
  SoilMatrix a;
  a << 2, .5, .1, 0, .3, .2, 1, -.9, .4, 0, 0, .1, .05, .04, 0, .3, 0, .2, 3, .1, .1, 0, 0, .2, .5;
  return a * a.transpose() + 0.001 * SoilMatrix::Identity();
}

TEST(TruncatedGaussian, EveryDrawLiesWithinBounds) {
  // Property: draws lie in the box, also if the mean is far outside.
  for (const double mean : {0.5, -40.0, 900.0}) {
    const TruncatedGaussian g(SoilVector::Constant(mean), correlated(), kUnit);
    const auto points = evenPoints(kSoilParameters, 200);
    for (int k = 0; k < 200; ++k) {
      const auto [at, log_density] = g.draw(points.col(k));
      EXPECT_GE(at.minCoeff(), -1e-9);
      EXPECT_LE(at.maxCoeff(), 1.0 + 1e-9);
      EXPECT_TRUE(std::isfinite(log_density));
    }
  }
}

TEST(TruncatedGaussian, InverseDensityIntegratesToTheBoxVolume) {
  // Property: the mean of 1/density over draws is the volume of the box, 1 (4000 even points: 5 %).
  const TruncatedGaussian g(SoilVector::Constant(0.4), 0.3 * SoilMatrix::Identity(), kUnit);
  const auto points = evenPoints(kSoilParameters, 4000);
  double volume = 0.0;
  for (int k = 0; k < 4000; ++k) volume += std::exp(-g.draw(points.col(k)).log_density) / 4000.0;
  EXPECT_NEAR(volume, 1.0, 0.05);
}

TEST(TruncatedGaussian, WithoutBoundsItIsTheGaussian) {
  // Closed form: the density of the untruncated Gaussian at the draw.
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const TruncatedGaussian g(SoilVector::Zero(), SoilMatrix::Identity(),
                            {SoilVector::Constant(-kInfinity), SoilVector::Constant(kInfinity)});
  const auto [at, log_density] = g.draw(SoilVector::Constant(0.3));
  EXPECT_NEAR(log_density, -0.5 * at.squaredNorm() - 2.5 * std::log(2.0 * std::numbers::pi), 1e-9);
}

const ReadingErrors kErrors = ReadingErrors::relative(0.05);

TEST(StatePopulation, FewSamplesLeaveReadingsUnchanged) {
  StatePopulation population;
  const WheelSample s{.load_N = 80.0, .torque_Nm = 3.0, .sinkage_m = 0.01, .slip = 0.4};
  for (int count = 0; count <= 3; ++count) {
    EXPECT_DOUBLE_EQ(population.load(s, kErrors).value, 80.0);
    EXPECT_NEAR(population.load(s, kErrors).std, 4.0, 1e-12);
    EXPECT_EQ(population.slip(s, kErrors).value, 0.4);
    EXPECT_NEAR(population.slip(s, kErrors).std, 0.02, 1e-15);
    population.add(s, kErrors);
  }
}

TEST(StatePopulation, ShrinksReadingsTowardsThePopulation) {
  // Closed form: with true ln W and slip Gaussian with known spread, and errors as stated, an error is
  // reduced by the factor sqrt(V / (V + s^2)), as is its standard deviation. 4000 readings determine the
  // spread to 2 %.
  constexpr int kCount = 4000;
  constexpr double kSpread = 0.08;  // standard deviation of ln W
  StatePopulation population;
  std::vector<double> truth;
  std::vector<WheelSample> readings;
  const Eigen::MatrixXd points = evenPoints(3, kCount);
  for (int k = 0; k < kCount; ++k) {
    truth.push_back(std::log(80.0) + kSpread * normalQuantile(points(0, k)));
    readings.push_back({.load_N = std::exp(truth.back() + 0.05 * normalQuantile(points(1, k))),
                        .torque_Nm = 3.0,
                        .sinkage_m = 0.01,
                        .slip = 0.4 + 0.02 * normalQuantile(points(2, k))});
    population.add(readings.back(), kErrors);
  }
  double squares = 0.0, stated = 0.0, slip_squares = 0.0;
  for (int k = 0; k < kCount; ++k) {
    const Estimate load = population.load(readings[static_cast<std::size_t>(k)], kErrors);
    squares += std::pow(std::log(load.value) - truth[static_cast<std::size_t>(k)], 2) / kCount;
    stated += std::pow(load.std / load.value, 2) / kCount;
    slip_squares +=
        std::pow(population.slip(readings[static_cast<std::size_t>(k)], kErrors).value - 0.4, 2) / kCount;
  }
  const double share = kSpread * kSpread / (kSpread * kSpread + 0.05 * 0.05);
  EXPECT_NEAR(std::sqrt(squares), 0.05 * std::sqrt(share), 0.002);
  EXPECT_NEAR(std::sqrt(stated), 0.05 * std::sqrt(share), 0.002);
  EXPECT_LT(std::sqrt(slip_squares), 0.005);  // all rows have one slip and a reading error of 0.02
}

// A class with one soil only.
SoilClass known(const ContactSoil& soil) {
  SoilClass exact;
  exact.parameters = {Marginal::fixed(soil.cohesion_Pa), Marginal::fixed(soil.friction_angle_rad),
                      Marginal::fixed(soil.sinkage_exponent), Marginal::fixed(soil.sinkage_modulus),
                      Marginal::fixed(soil.shear_modulus_m)};
  return exact;
}

TEST(SoilObjective, ResidualsVanishForTheTrueSoil) {
  // Property: for exact readings the residuals are small. Tolerance: 10-point quadrature, 1e-4 of the load,
  // relative to errors of 5 %.
  ThesisRuns runs(3);
  const ThesisRun run = runs.next({.noise = 0.0});
  const SoilClass exact = known(run.soil);
  const SoilObjective objective(exact, {.noise = {}, .outlier_share = 0.01});
  for (const WheelSample& s : run.truth) {
    EXPECT_LT(objective.misfit(SoilVector::Constant(0.5), {kThesisWheel, s}).residual.norm(), 0.01);
    EXPECT_NEAR(objective.likelyState(run.soil, {kThesisWheel, s}).sinkage_m, s.sinkage_m,
                1e-4 * s.sinkage_m);
  }
}

TEST(SoilObjective, CostIsTheMarginalLikelihoodOverSinkageAndSlipErrors) {
  // Property: with errors of 2 % the linearised likelihood equals the exact likelihood for each soil and
  // reading, up to the neglected second order: 0.04 at the median, more in the tails. The factor z converts
  // d/dz to d/d ln z.
  ThesisRuns runs(8);
  double sum = 0.0, squares = 0.0;
  constexpr int kSoils = 40, kSamples = 10, kAll = kSoils * kSamples;
  for (int k = 0; k < kSoils; ++k) {
    const ThesisRun run = runs.next({.noise = 0.02, .samples = kSamples});
    const SoilClass exact = known(run.soil);
    const SoilObjective objective(exact, {ReadingErrors::relative(0.02), 0.0});
    for (const WheelSample& s : run.samples) {
      const double cost = objective.misfit(SoilVector::Zero(), {kThesisWheel, s}).cost;
      const double apart = cost + std::log(s.sinkage_m * exactLikelihood(run.soil, s, 0.02));
      sum += apart;
      squares += apart * apart;
    }
  }
  EXPECT_NEAR(sum / kAll, 0.0, 0.03);
  EXPECT_LT(std::sqrt(squares / kAll), 0.12);
}

TEST(SoilObjective, LikelyStateCorrectsAReadingTowardsTheTruth) {
  // Property: the load reading corrects a sinkage reading that is 10 % too high.
  ThesisRuns runs(4);
  const ThesisRun run = runs.next({.noise = 0.0});
  const SoilMixture classes = thesisSoils();
  const SoilObjective objective(classes[0], {.noise = {}, .outlier_share = 0.01});
  WheelSample s = run.truth[3];
  s.sinkage_m *= 1.1;
  const double moved = objective.likelyState(run.soil, {kThesisWheel, s}).sinkage_m;
  EXPECT_LT(moved, s.sinkage_m - 0.02 * run.truth[3].sinkage_m);
  EXPECT_GT(moved, run.truth[3].sinkage_m * 0.98);
}

TEST(SoilObjective, QuadraticIsInvariantUnderShiftOfItsOrigin) {
  // Closed form: minimum of a quadratic function.
  SoilQuadratic q;
  q.cost = 2.0;
  q.gradient << 1, -2, 3, 0, 0.5;
  q.information = SoilMatrix::Identity() * 3.0;
  const SoilVector somewhere = SoilVector::Constant(0.7);
  const SoilVector elsewhere = SoilVector::Constant(-0.2);
  EXPECT_NEAR(q.movedTo(somewhere).costAt(elsewhere), q.costAt(elsewhere), 1e-12);
}

TEST(SoilObjective, OutliersHaveReducedWeight) {
  // Property: an exact reading has a weight near 1; a torque read at four times its value has a weight of
  // 0.01.
  ThesisRuns runs(5);
  const ThesisRun run = runs.next({.noise = 0.0});
  const SoilClass exact = known(run.soil);
  const SoilObjective objective(exact, {.noise = {}, .outlier_share = 0.01});
  WheelSample s = run.truth[2];
  EXPECT_GT(objective.misfit(SoilVector::Zero(), {kThesisWheel, s}).weight, 0.99);
  s.torque_Nm *= 4.0;
  EXPECT_LT(objective.misfit(SoilVector::Zero(), {kThesisWheel, s}).weight, 0.02);
}

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

}  // namespace soil_objective_test

}  // namespace talus::terramech
