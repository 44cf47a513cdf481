#include <cmath>
#include <random>

#include <nlohmann/json.hpp>

#include <talus/cli/soil/trace_report.hpp>

namespace talus::cli {

namespace trace_report_test {

// Property: rows without slip, measurement or prediction are omitted.
TEST(ChannelReport, OnlyWholeRowsAreShownOverSlip) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  terramech::Trial trial;
  trial.measured = Eigen::MatrixXd::Constant(4, 4, kNone);
  trial.slip = {0.2, 0.1, 0.4, kNone};
  Eigen::MatrixXd told = Eigen::MatrixXd::Zero(4, 4);
  const auto c = static_cast<Eigen::Index>(terramech::Channel::Torque);
  trial.measured.col(c) << 0.3, kNone, 0.1, 0.2;
  told.col(c) << 0.31, 0.0, 0.12, 0.2;
  const Plot plot = overSlip(terramech::Channel::Torque, trial, {{"model", told}});
  ASSERT_EQ(plot.series.size(), 2U);
  EXPECT_EQ(plot.series[0].x, (std::vector{0.2, 0.4}));
  EXPECT_EQ(plot.series[0].y, (std::vector{0.3, 0.1}));
  EXPECT_EQ(plot.series[1].y, (std::vector{0.31, 0.12}));
}

TEST(ChannelReport, UnmeasuredChannelsAreOmitted) {
  EXPECT_EQ(errorsJson({0.5, NAN, 0.25, NAN}).dump(),
            R"({"drawbar_pull_over_load":0.5,"torque_over_load_radius":0.25})");
  EXPECT_EQ(changeText({0.1, NAN, 0.03, NAN}, {0.05, NAN, 0.02, NAN}),
            " drawbar_pull_over_load 0.1000 -> 0.0500 torque_over_load_radius 0.0300 -> 0.0200");
}

using testing::ElementsAre;
using testing::HasSubstr;

// Rows in which "temperature" is correlated with "depth", "same" is -2 depth, and "noise" is independent.
terramech::Trial trial() {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  terramech::Trial made;
  made.covariates = {"depth", "temperature", "same", "noise", "steady"};
  for (int row = 0; row < 200; ++row) {
    terramech::WheelState state;
    const double depth = normal(random);
    state.extra = {{"depth", depth},
                   {"temperature", 3.0 * depth + 0.5 * normal(random)},
                   {"same", row == 7 ? std::nan("") : -2.0 * depth},
                   {"noise", normal(random)},
                   {"steady", 5.0}};
    made.states.push_back(state);
  }
  return made;
}

terramech::Explanation explanation(const std::string& name, const std::string& covariate) {
  terramech::Explanation made;
  made.candidate.parts = {{.name = name, .covariate = covariate}};
  return made;
}

// Closed form: 3 x + 0.5 e has the correlation 3 / sqrt(9.25) = 0.986 with x, -2 x has -1: both above 0.9 in
// magnitude. Constant columns have no correlation; missing values are skipped.
TEST(TraceReport, CorrelatedColumnsAreConfounded) {
  EXPECT_THAT(confounded(trial(), "depth"), ElementsAre("temperature", "same"));
  EXPECT_TRUE(confounded(trial(), "noise").empty());
  EXPECT_TRUE(confounded(trial(), "steady").empty());
}

TEST(TraceReport, CovariateOfAGroupEffectIsTheGroupColumn) {
  EXPECT_EQ(covariateOf({.name = "a", .covariate = "constant", .only_column = "wheel", .only_value = "2"}),
            "wheel");
  EXPECT_EQ(covariateOf({.name = "a", .covariate = "depth"}), "depth");
}

// Property: order of the alternatives: other column, correlated column, other form of the effect, none.
TEST(TraceReport, ProposedMeasurementSeparatesTheClosestAlternative) {
  terramech::TracedEffect effect;
  effect.chosen = explanation("ding", "depth");
  effect.equal = {explanation("lyasko", "depth"), explanation("drift", "noise")};
  EXPECT_THAT(separatingMeasurement(trial(), effect), HasSubstr("depth and noise vary independently"));
  effect.equal.resize(1);
  EXPECT_THAT(separatingMeasurement(trial(), effect), HasSubstr("depth is correlated with temperature"));
  effect.chosen = explanation("ding", "noise");
  effect.equal = {explanation("lyasko", "noise")};
  EXPECT_THAT(separatingMeasurement(trial(), effect), HasSubstr("over a wider range of noise"));
  effect.equal.clear();
  EXPECT_EQ(separatingMeasurement(trial(), effect), "no close alternative");
}

TEST(TraceReport, FittedValuesFollowTheParametersOfTheForm) {
  terramech::TracedEffect effect;
  effect.chosen.candidate.parts = {{.name = "torque_offset", .covariate = "load_N", .parameters = {0.5}}};
  effect.parameter_std = {0.1};
  const std::vector<FittedNumber> numbers = fittedNumbers(effect);
  ASSERT_EQ(numbers.size(), 1U);
  EXPECT_EQ(numbers[0].value, 0.5);
  EXPECT_EQ(numbers[0].std, 0.1);
  EXPECT_FALSE(numbers[0].at_bound);
  effect.chosen.candidate.parts = {{.name = "empirical", .parameters = {1.0, 2.0}, .knots = {0.0, 1.0}}};
  EXPECT_TRUE(fittedNumbers(effect).empty());
}

TEST(TraceReport, RowsBeyondTheAxleAreReportedWithTheirErrors) {
  terramech::TableTrace trace;
  trace.beyond_axle = 3;
  trace.beyond_axle_rmse = {0.125, NAN, 0.5, NAN};
  EXPECT_THAT(beyondAxleText(trace), HasSubstr("3 rows with sinkage at or above the axle are excluded"));
  EXPECT_THAT(beyondAxleText(trace),
              testing::EndsWith("drawbar_pull_over_load 0.125, torque_over_load_radius 0.500"));
}

}  // namespace trace_report_test

}  // namespace talus::cli
