#include <cmath>

#include <talus/cli/soil/channel_report.hpp>

namespace talus::cli {
namespace agreement_plot_test {

// Property: rows without measurement or prediction are omitted; the line of equality spans the measured
// range.
TEST(AgreementPlot, OnlyMeasuredAndPredictedRowsAreShown) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Eigen::MatrixXd measured = Eigen::MatrixXd::Constant(4, 4, kNone), told = Eigen::MatrixXd::Zero(4, 4);
  const auto c = static_cast<Eigen::Index>(terramech::Channel::Torque);
  measured.col(c) << 0.3, kNone, 0.1, 0.2;
  told.col(c) << 0.31, 0.0, 0.12, kNone;
  const Plot plot = agreementPlot(terramech::Channel::Torque, measured, {{"model", told}});
  ASSERT_EQ(plot.series.size(), 2U);
  EXPECT_EQ(plot.series[0].x, (std::vector{0.3, 0.1}));
  EXPECT_EQ(plot.series[0].y, (std::vector{0.31, 0.12}));
  EXPECT_EQ(plot.series[1].x, (std::vector{0.1, 0.3}));
  EXPECT_EQ(plot.series[1].x, plot.series[1].y);
  EXPECT_EQ(agreementPlot(terramech::Channel::Sinkage, measured, {{"model", told}}).series.size(), 1U);
}

}  // namespace agreement_plot_test
}  // namespace talus::cli
