#include <algorithm>
#include <cmath>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <talus/terramech/calibration/trace/run_proposal.hpp>

#include "calibration/traced_world.hpp"

namespace talus::terramech {
namespace run_proposal_test {

/// Trace of a world in which dust reduces the pull, with a second column correlated with dust.
TraceResult tied() {
  return traced(blind::makeWorld({.seed = 8, .effects = 1, .library = false, .unresolvable = "tied"}));
}

/// Simulates the proposed runs with the model of a cause, with sensor errors.
Trial made(const std::vector<ProposedRun>& runs, const RefinedModel& truth, std::mt19937& random) {
  std::normal_distribution<double> normal;
  Trial trial;
  for (std::size_t k = 0; k < runs.size(); ++k)
    for (const double slip : runs[k].slip) {
      WheelState s;
      for (const auto& [column, value] : runs[k].columns) {
        s.extra.emplace_back(column, value);
        s.setCovariate(column, value);
      }
      s.slip = slip;
      trial.states.push_back(s);
      trial.slip.push_back(slip + truth.noise.slipStd(slip) * normal(random));
      trial.load_N.push_back(s.load_N);
      trial.run.push_back(static_cast<int>(k));
    }
  SolvedContacts solved;
  trial.slip_variance = trial.load_variance = Eigen::VectorXd::Zero(trial.rows());
  trial.measured = predictRows(truth, trial, solved);
  for (int row = 0; row < trial.rows(); ++row)
    for (int c = 0; c < kChannels; ++c) {
      double& value = trial.measured(row, c);
      if (c == static_cast<int>(Channel::SideForce)) value = std::nan("");
      value *= 1.0 + truth.noise.relative[static_cast<std::size_t>(c)] * normal(random);
      trial.states[static_cast<std::size_t>(row)].slip = trial.slip[static_cast<std::size_t>(row)];
    }
  return trial;
}

TEST(RunProposal, SimulatedRunsIdentifyTheTrueCause) {
  // Property: simulated runs identify the true cause of two equal causes; twenty repetitions for each cause.
  const TraceResult result = tied();
  const std::vector<Cause> causes = causesOf(result);
  ASSERT_EQ(causes.size(), 2U);
  const std::vector<ProposedRun> runs = proposeRuns(result, 3);
  ASSERT_EQ(runs.size(), 3U);
  std::mt19937 random{7};
  int right = 0;
  for (std::size_t truth = 0; truth < 2; ++truth)
    for (int time = 0; time < 20; ++time) {
      const auto scores = scoreCauses(result, made(runs, causes[truth].model, random));
      right += scores[truth].probability > 0.5;
    }
  EXPECT_GE(right, 38);
}

TEST(RunProposal, EqualCausesDifferByTwoStdInTheProposedRun) {
  // Property: in the first run the predictions differ in some channel by more than two standard deviations of
  // either cause.
  const TraceResult result = tied();
  const std::vector<ProposedRun> runs = proposeRuns(result, 1);
  ASSERT_EQ(runs.size(), 1U);
  const RunPrediction &a = runs[0].predictions[0], &b = runs[0].predictions[1];
  double apart = 0.0;
  for (std::size_t c = 0; c < kChannels; ++c)
    if (std::isfinite(a.mean[c]))
      apart = std::max(apart, std::abs(a.mean[c] - b.mean[c]) / std::max(a.std[c], b.std[c]));
  EXPECT_GT(apart, 2.0);
}

TEST(RunProposal, ProposedRunsStayWithinTheMeasuredRange) {
  const TraceResult result = tied();
  for (const ProposedRun& run : proposeRuns(result, 3))
    for (const auto& [column, value] : run.columns) {
      const Eigen::VectorXd x = covariateValues(result.trial, column, {});
      EXPECT_GE(value, x.minCoeff()) << column;
      EXPECT_LE(value, x.maxCoeff()) << column;
    }
}

TEST(RunProposal, SingleCauseNeedsNoRun) {
  TraceResult result = tied();
  result.rivals.clear();
  EXPECT_EQ(causesOf(result).size(), 1U);
  EXPECT_TRUE(proposeRuns(result, 3).empty());
}

}  // namespace run_proposal_test
}  // namespace talus::terramech
