#include <cmath>

#include <thesis_runs.hpp>

#include <talus/terramech/estimate/soil_objective.hpp>

#include "exact_likelihood.hpp"

namespace talus::terramech {
namespace soil_objective_test {

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

}  // namespace soil_objective_test
}  // namespace talus::terramech
