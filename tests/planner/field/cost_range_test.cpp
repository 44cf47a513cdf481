#include <cmath>

#include <talus/planner/field/cost_range.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace cost_range_test {

// Closed form: 10 J on level ground; downhill 10 + 400 g^2 is never lower. The maximum is five times the
// cost of the steepest climb in the table, 76/256, crossed in the last row that the fifth curve allows, the
// twelfth.
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
