#include <cmath>

#include <talus/cli/soil/trace_report.hpp>
#include <talus/terramech/terramech_io.hpp>

namespace talus::cli {
namespace trace_answer_test {

using terramech::TraceResult;

/// Ten rows with errors above the noise floor and one candidate: gain `promised` to first order, `fitted`
/// after the fit.
TraceResult resultOf(double promised, double fitted) {
  TraceResult result;
  result.trial.states.resize(10, {.load_N = 50.0});
  result.trial.load_N.assign(10, 50.0);
  result.trial.run.assign(10, 0);
  result.trial.measured = Eigen::MatrixXd::Constant(10, terramech::kChannels, std::nan(""));
  result.trial.measured.col(0).setZero();
  result.base_rmse[0] = result.refined_rmse[0] = 0.1;
  result.held_out.base_rmse[0] = result.held_out.refined_rmse[0] = 0.1;
  result.noise_floor[0] = 0.01;
  result.threshold = 6.0;
  const terramech::Candidate curve{{{.name = "empirical", .covariate = "slip"}}, "empirical", 2};
  result.last_promises = {{curve, promised, 0.4}};
  result.rejected = {{.candidate = curve, .gain = fitted}};
  return result;
}

// The text must name the gain that is below the threshold of 6.0.
TEST(TraceAnswer, RejectedGainNamesTheInsufficientValue) {
  EXPECT_EQ(refusal(resultOf(2.5, 2.0)), "gain 2.5, below the 6.0 that would be evidence");
  EXPECT_EQ(refusal(resultOf(7.7, 5.1)),
            "gain 7.7 to first order, 5.1 when fitted, below the 6.0 that would be evidence");
  const TraceResult result = resultOf(7.7, 5.1);
  EXPECT_THAT(verdictText(result, answerOf(result)),
              testing::HasSubstr("varies most with slip (gain 7.7 to"));
}

TEST(TraceAnswer, FirstLineNamesCauseChannelAndErrorsBeforeAndAfter) {
  TraceResult result = resultOf(2.5, 2.0);
  terramech::TracedEffect effect;
  effect.chosen.candidate = {
      {{.name = "torque_offset", .covariate = "load_N", .parameters = {0.2}}}, "torque_sensor", 1};
  effect.channel = terramech::Channel::Torque;
  result.effects = {effect};
  result.held_out.refined_rmse[0] = 0.012;
  EXPECT_EQ(
      verdictText(result, answerOf(result)),
      "explained by 1 effect, torque_offset (load_N) in torque_over_load_radius: drawbar_pull_over_load "
      "on held-out rows from 10.00 to 1.20 noise floors");
  result.held_out.refined_rmse[0] = 0.04;
  EXPECT_THAT(
      verdictText(result, answerOf(result)),
      testing::AllOf(testing::StartsWith("partly explained by 1 effect, torque_offset"),
                     testing::HasSubstr("from 10.00 to 4.00 noise floors; it varies most with slip")));
}

TEST(TraceAnswer, RejectionNamesTheFailedCheck) {
  TraceResult result = resultOf(7.7, 7.1);
  EXPECT_THAT(refusal(result), testing::EndsWith("7.1 when fitted: gains more than noise would, but not "
                                                 "beside the others"));
  result.trial.moment.assign(10, 0);
  EXPECT_THAT(refusal(result), testing::HasSubstr("carries less than an effect of a drive must"));
  result.rejected.clear();
  EXPECT_THAT(refusal(result), testing::HasSubstr("accepted first, and left out"));
}

TEST(TraceAnswer, NothingMissingRequestsNoMeasurement) {
  TraceResult result = resultOf(2.5, 2.0);
  EXPECT_FALSE(answerOf(result).measure.empty());
  result.base_rmse[0] = result.refined_rmse[0] = 0.01;
  EXPECT_EQ(answerOf(result).measure, "");
}

// Property: side bulldozing of size 0 replaces, and so removes, the term of the base soil. A rear fill of
// size 0 adds nothing if the wheel does not dig.
TEST(TraceAnswer, EffectOfSizeZeroRemovesTheTermOfTheBase) {
  TraceResult result = resultOf(2.5, 2.0);
  for (int row = 0; row < 10; ++row) {
    auto& state = result.trial.states[static_cast<std::size_t>(row)];
    state = {.wheel = {.radius_m = 0.1, .width_m = 0.1},
             .load_N = 50.0,
             .slip = 0.3,
             .slip_angle_rad = 0.05 * row};
    result.trial.slip.push_back(state.slip);
  }
  result.base.soil = terramech::loadSoil("sandy_loam");
  result.refined = result.base;
  const auto take = [&](const char* name, const char* column, std::vector<double> parameters) {
    const terramech::Effect effect{.name = name, .covariate = column, .parameters = std::move(parameters)};
    result.refined.effects.push_back(effect);
    result.effects.emplace_back().chosen.candidate = {{effect}, "", 1};
  };
  take("side_bulldozing", "slip_angle_rad", {0.0});
  take("rear_fill", "slip", {0.0});
  take("skid_sinkage", "slip", {0.3});
  take("slip_sinkage_linear", "slip", {0.5});
  const std::vector<EffectRole> roles = rolesOf(result);
  ASSERT_EQ(roles.size(), 4U);
  EXPECT_EQ(roleText(roles[0]), "takes back the base's side_bulldozing and adds nothing in its place");
  EXPECT_FALSE(roles[1].adds);
  EXPECT_TRUE(roles[1].takes_back.empty());
  EXPECT_TRUE(roles[3].adds);
  EXPECT_EQ(roleText(roles[3]), "");
}

}  // namespace trace_answer_test
}  // namespace talus::cli
