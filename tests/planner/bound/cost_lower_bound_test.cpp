#include <cmath>
#include <random>

#include <talus/planner/bound/cost_lower_bound.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace cost_lower_bound_test {

// Property: no allowed metre in any heading costs less than the linear bound.
TEST(CostLowerBounds, BoundIsBelowTheCostInEveryHeading) {
  const auto cost = testing::driveCost({.max_along = 0.4, .max_across = 0.4});
  const CostLowerBounds lines(*cost);
  std::mt19937 random(2);
  for (int k = 0; k < 20'000; ++k) {
    const costmap::CellCode cell({.dz_dx = (static_cast<int>(random() % 800) - 400) / 1024.0,
                                  .dz_dy = (static_cast<int>(random() % 800) - 400) / 1024.0,
                                  .curve = static_cast<std::uint8_t>(random() % 5)});
    const CostLowerBound line = lines.of(cell);
    for (int h = 0; h < 48; ++h) {
      const costmap::Direction heading{std::cos(h * 0.1309), std::sin(h * 0.1309)};
      const double along = cell.dzDx() * heading.x + cell.dzDy() * heading.y;
      const double below = line.level_J_per_m + line.tilt_J_per_m * along;
      ASSERT_LE(below, static_cast<double>(cost->costPerMetre(cell, heading)) * (1 + 1e-6));
      ASSERT_GT(below, 0.0);
    }
  }
}

}  // namespace cost_lower_bound_test
}  // namespace talus::planner
