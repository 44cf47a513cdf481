#include "figure_parts.hpp"

#include <cmath>

namespace talus::reproduce {
namespace figure_parts_test {

using namespace cli;

// Closed form: mean and standard deviation of 2, 4, 4, 4, 5, 5, 7, 9 are 5 and 2.
TEST(FigureParts, MeanAndStdMatchClosedForm) {
  MeanAndStd of;
  for (const double value : {2, 4, 4, 4, 5, 5, 7, 9}) of.add(value);
  EXPECT_DOUBLE_EQ(of.mean(), 5.0);
  EXPECT_NEAR(of.std(), 2.0, 1e-12);
}

TEST(FigureParts, SeriesHelpersSetNamesAndValues) {
  const Series ramp = straight("ramp", 1.0, 2.0, 5.0);
  EXPECT_EQ(ramp.x, (std::vector<double>{0.0, 5.0}));
  EXPECT_EQ(ramp.y, (std::vector<double>{1.0, 11.0}));
  EXPECT_EQ(lines({"a", "b"})[1].name, "b");
  Series cloud = points("cloud");
  EXPECT_EQ(cloud.mark, Series::Mark::Points);
  put(cloud, 3.0, 4.0);
  EXPECT_EQ(cloud.y, (std::vector<double>{4.0}));
}

// Closed form: the ordinary least-squares line through the cloud that is drawn, in kPa, by its normal equations.
TEST(FigureParts, DrawnLineIsTheLeastSquaresFitOfTheDrawnPoints) {
  terramech::ThesisRun run = clayRun(5, 0.05);
  const FittedPoints fitted = fittedPoints(run, run.soil.shear_modulus_m, "clay");
  const auto n = static_cast<double>(fitted.cloud.x.size());
  EXPECT_EQ(fitted.cloud.x.size(), run.samples.size());
  double x = 0.0, y = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t i = 0; i < fitted.cloud.x.size(); ++i) {
    x += fitted.cloud.x[i], y += fitted.cloud.y[i];
    xx += fitted.cloud.x[i] * fitted.cloud.x[i], xy += fitted.cloud.x[i] * fitted.cloud.y[i];
  }
  const double slope = (n * xy - x * y) / (n * xx - x * x);
  EXPECT_NEAR(fitted.fit.tan_friction, slope, 1e-9);
  EXPECT_NEAR(1e-3 * fitted.fit.cohesion_Pa, (y - slope * x) / n, 1e-6);
}

// Property: a reading keeps the load and slip that it was asked for, and more slip gives more torque.
TEST(FigureParts, SampleHasTheGivenLoadAndSlip) {
  const auto slow = drive(middle(0), 80.0, 0.2), fast = drive(middle(0), 80.0, 0.6);
  EXPECT_EQ(slow.load_N, 80.0);
  EXPECT_EQ(slow.slip, 0.2);
  EXPECT_GT(fast.torque_Nm, slow.torque_Nm);
}

TEST(FigureParts, ClayRunHasHighCohesion) {
  const terramech::ThesisRun run = clayRun(3, 0.05);
  EXPECT_EQ(run.soil_class, 1);
  EXPECT_GT(run.soil.cohesion_Pa, 6500.0);
  EXPECT_EQ(run.soil.cohesion_Pa, clayRun(3, 0.05).soil.cohesion_Pa);
}

}  // namespace figure_parts_test
}  // namespace talus::reproduce
