#include <cmath>
#include <numbers>
#include <random>

#include <talus/planner/route/heading_cost.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace heading_cost_test {

// Property: the cost is bit-identical to TravelCost for random cells and headings, including ties between
// bins.
TEST(HeadingCost, CostIsBitIdenticalToDriveCost) {
  const auto cost = testing::driveCost({.max_along = 0.25, .max_across = 0.3});
  std::mt19937 random(3);
  for (int k = 0; k < 200'000; ++k) {
    const int eighth = static_cast<int>(random() % 64);
    const double angle = k % 2 == 0 ? eighth * std::numbers::pi / 4 : static_cast<double>(random()) * 1.5e-9;
    const costmap::Direction heading =
        eighth == 0 ? costmap::Direction{0.0, -1.0} : costmap::Direction{std::cos(angle), std::sin(angle)};
    const costmap::CellCode cell({.dz_dx = (static_cast<int>(random() % 700) - 350) / 1024.0,
                                  .dz_dy = (static_cast<int>(random() % 700) - 350) / 1024.0,
                                  .curve = static_cast<std::uint8_t>(random() % 6)});
    ASSERT_EQ(HeadingCost(*cost, heading)(cell), cost->costPerMetre(cell, heading));
  }
}

}  // namespace heading_cost_test
}  // namespace talus::planner
