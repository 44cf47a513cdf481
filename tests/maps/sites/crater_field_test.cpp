#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>

#include <talus/maps/sites/site_generator.hpp>

namespace talus::maps {
namespace crater_field_test {

TEST(CraterField, SizesFollowThePowerLaw) {
  const Grid grid{.width = 3000, .height = 3000, .resolution_m = 1.0};
  const auto craters =
      craterField(grid, {.seed = 1, .least_diameter_m = 4, .greatest_diameter_m = 400, .density = 0.04});
  const auto larger = [&](double d) {
    return std::count_if(craters.begin(), craters.end(), [=](const Crater& c) { return 2 * c.radius_m > d; });
  };
  // Closed form: the number of craters above D is proportional to D^-2 - Dmax^-2.
  EXPECT_NEAR(static_cast<double>(larger(8)) / static_cast<double>(larger(16)), 4.0, 0.25);
  EXPECT_NEAR(static_cast<double>(larger(4)), 0.04 * 3800 * 3800 / 16, 100);
}

TEST(CraterField, FreshCraterMatchesPikeProportions) {
  const Crater crater{.centre = {}, .radius_m = 10, .age = 0};
  // Printed in: Pike (1977): the depth is 0.2 and the rim height 0.036 of the diameter. Tolerance: rounding
  // of the rim.
  EXPECT_NEAR(crater.height_m(10) - crater.height_m(0), 0.2 * 20, 0.2);
  EXPECT_NEAR(crater.height_m(10), 0.036 * 20, 0.12);
  EXPECT_EQ(crater.height_m(30), 0.0);
  double steepest = 0;
  for (double r = 0; r < 30; r += 0.1) {
    steepest = std::max(steepest, std::abs(crater.height_m(r + 0.1) - crater.height_m(r)) / 0.1);
    EXPECT_LT(std::abs(crater.height_m(r + 0.1) - crater.height_m(r)), 0.1)
        << "no cliff, also where the ejecta end";
  }
  EXPECT_LT(std::atan(steepest) * 57.3, 40);
  const Crater worn{.centre = {}, .radius_m = 10, .age = 1};
  EXPECT_LT(worn.height_m(10) - worn.height_m(0), 0.06 * 20);
}

}  // namespace crater_field_test
}  // namespace talus::maps
