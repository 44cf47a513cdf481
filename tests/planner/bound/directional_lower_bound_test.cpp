#include <cmath>
#include <random>

#include <talus/planner/bound/directional_lower_bound.hpp>

#include "drawn_map.hpp"
#include "jagged_cost.hpp"

namespace talus::planner {
namespace directional_lower_bound_test {

// Property: the gauge between the values of neighbouring headings is never above the cost, in any direction,
// and every heading has a value.
TEST(DirectionalLowerBounds, GaugeIsBelowTheCost) {
  for (const auto& cost :
       {testing::driveCost({.max_along = 0.4, .max_across = 0.4}), testing::jaggedCost()}) {
    DirectionalLowerBounds headings(*cost);
    std::mt19937 random(3);
    for (int n = 0; n < 4'000; ++n) {
      const int most = n % 2 == 0 ? 300 : 900;
      const auto gradient = [&] { return (static_cast<int>(random()) % most) / 1024.0; };
      const costmap::CellCode cell({.dz_dx = gradient(),
                                    .dz_dy = gradient(),
                                    .curve = static_cast<std::uint8_t>(random() % cost->curves().size())});
      const auto prices = headings.of(cell);
      for (const float price : prices) ASSERT_GT(price, 0.0F);
      for (int d = 0; d < 360; ++d) {
        const double angle = 0.017453292519943295 * d, eighth = 0.78539816339744831;
        const auto k = static_cast<std::size_t>(angle / eighth);
        const double p = std::sin(eighth - (angle - static_cast<double>(k) * eighth)) / std::sin(eighth),
                     q = std::sin(angle - static_cast<double>(k) * eighth) / std::sin(eighth);
        const float price = cost->costPerMetre(cell, {std::cos(angle), std::sin(angle)});
        if (std::isinf(price)) continue;
        const double gauge =
            p * static_cast<double>(prices[k % 8]) + q * static_cast<double>(prices[(k + 1) % 8]);
        ASSERT_LE(gauge, static_cast<double>(price)) << n << " " << d;
      }
    }
  }
}

// A vehicle with rolling resistance `level` [J/m] that lifts its weight; downhill the cost is at least 0.
std::shared_ptr<const costmap::TravelCost> rollingCart(double level_J_per_m, double weight_N) {
  costmap::TravelCurve curve;
  for (int bin = 0; bin < costmap::TravelCurve::kBins; ++bin)
    curve.cost_J_per_m[static_cast<std::size_t>(bin)] = static_cast<float>(
        std::max(0.1 * level_J_per_m, level_J_per_m + weight_N * costmap::TravelCurve::gradient(bin)));
  return std::make_shared<costmap::TravelCost>(costmap::TravelCost::Limits{}, std::vector{curve});
}

// Property: for an allowed heading the bound is finite and not above the cost of the heading, also if
// gravity exceeds the rolling resistance many times or the ground costs nothing.
TEST(DirectionalLowerBounds, BoundsAreFiniteForAllowedHeadingsAndBelowTheCost) {
  for (const double level_J_per_m : {100.0, 10.0, 1.0, 0.0}) {
    const auto cost = rollingCart(level_J_per_m, 1000.0);
    DirectionalLowerBounds headings(*cost);
    for (int x = -380; x <= 380; x += 19)
      for (int y = -380; y <= 380; y += 19) {
        const costmap::CellCode cell({.dz_dx = x / 1024.0, .dz_dy = y / 1024.0, .curve = 0});
        const auto prices = headings.of(cell);
        for (std::size_t k = 0; k < 8; ++k) {
          const double length = std::hypot(kStep[k].column, kStep[k].row);
          const float exact = cost->costPerMetre(cell, {kStep[k].column / length, kStep[k].row / length});
          ASSERT_LE(prices[k], exact) << level_J_per_m << ": " << x << "," << y << " " << k;
          ASSERT_GE(prices[k], 0.0F);
        }
      }
  }
}

}  // namespace directional_lower_bound_test
}  // namespace talus::planner
