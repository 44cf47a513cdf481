#include <cmath>

#include <talus/planner/field/cost_range.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace cost_range_test {

// Closed form: the minimum is 10 J/m on level ground (10 + 400 g^2 downhill). The maximum is that of the
// fifth curve: five times the cost of the steepest climb in the table, 76/256, in row 12, the last cross
// slope allowed.
TEST(CostRange, RangeCoversAllAllowedMetres) {
  const CostRange range = costRange(*testing::driveCost());
  const double g = 76.0 / 256;
  EXPECT_NEAR(range.least_J_per_m, 10.0, 1e-6);
  EXPECT_NEAR(range.most_J_per_m, 5 * (10 + 100 * g + 400 * g * g) * (1.0 + 0.08 * 12), 1e-3);
  EXPECT_TRUE(
      std::isinf(costRange(costmap::TravelCost({}, std::vector<costmap::TravelCurve>{})).least_J_per_m));
}

}  // namespace cost_range_test
}  // namespace talus::planner
