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

}  // namespace figure_parts_test
}  // namespace talus::reproduce
