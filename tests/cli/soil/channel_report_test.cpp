#include <cmath>

#include <nlohmann/json.hpp>

#include <talus/cli/soil/channel_report.hpp>

namespace talus::cli {
namespace channel_report_test {

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

}  // namespace channel_report_test
}  // namespace talus::cli
