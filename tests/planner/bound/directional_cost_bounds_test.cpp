#include <cmath>
#include <numbers>
#include <random>

#include <talus/planner/bound/directional_cost_bounds.hpp>

#include "drawn_map.hpp"
#include "jagged_cost.hpp"

namespace talus::planner {
namespace directional_cost_bounds_test {

constexpr double kSector = 2.0 * std::numbers::pi / DirectionalCostBounds::kHeadings;

// The gauge function, interpolated between the limits of neighbouring headings.
double gauge(const DirectionalCostBounds::Limits& limits, double angle) {
  const auto k = static_cast<std::size_t>(angle / kSector);
  const double in = angle - static_cast<double>(k) * kSector;
  return (std::sin(kSector - in) * static_cast<double>(limits[k % limits.size()]) +
          std::sin(in) * static_cast<double>(limits[(k + 1) % limits.size()])) /
         std::sin(kSector);
}

costmap::CellCode randomCell(std::mt19937& random, int most, std::size_t curves) {
  const auto gradient = [&] {
    return (static_cast<int>(random() % (2U * static_cast<unsigned>(most))) - most) / 1024.0;
  };
  return costmap::CellCode(
      {.dz_dx = gradient(), .dz_dy = gradient(), .curve = static_cast<std::uint8_t>(random() % curves)});
}

// Property: no limit is above the cost of its heading, also between the tabulated headings, at the nodes of
// the cost table, and where only single headings are allowed.
TEST(DirectionalCostBounds, GaugeIsBelowTheCost) {
  for (const auto& cost :
       {testing::driveCost({.max_along = 0.4, .max_across = 0.4}), testing::jaggedCost()}) {
    DirectionalCostBounds headings(*cost);
    std::mt19937 random(3);
    for (int n = 0; n < 4'000; ++n) {
      const costmap::CellCode cell = randomCell(random, n % 2 == 0 ? 300 : 900, cost->curves().size());
      DirectionalCostBounds::Limits limits;
      const bool any = headings.of(cell, limits);
      const double aspect = std::atan2(cell.dzDy(), cell.dzDx()),
                   steepness = std::hypot(cell.dzDx(), cell.dzDy());
      const auto check = [&](double angle) {
        angle -= 2.0 * std::numbers::pi * std::floor(angle / (2.0 * std::numbers::pi));
        const float price = cost->costPerMetre(cell, {std::cos(angle), std::sin(angle)});
        if (std::isinf(price)) return;
        ASSERT_TRUE(any);
        ASSERT_LE(gauge(limits, angle), static_cast<double>(price)) << n << " " << angle;
      };
      for (int d = 0; d < 720; ++d) check(std::numbers::pi / 360.0 * d);
      for (int k = 0; k < 200 && steepness > 0.0; ++k) {
        const double along = k / 256.0 / steepness, across = k / 64.0 / steepness;
        if (along <= 1.0) check(aspect + std::acos(along)), check(aspect - std::acos(-along));
        if (across <= 1.0) check(aspect + std::asin(across)), check(aspect - std::asin(across));
      }
    }
  }
}

// Property: for a cost that is smooth and convex over headings, the limits are within half a percent of the
// cost.
TEST(DirectionalCostBounds, LimitsAreTightForASmoothCost) {
  costmap::TravelCurve curve;
  for (int bin = 0; bin < costmap::TravelCurve::kBins; ++bin) {
    const double g = costmap::TravelCurve::gradient(bin);
    curve.cost_J_per_m[static_cast<std::size_t>(bin)] = static_cast<float>(10.0 + 20.0 * g + 40.0 * g * g);
  }
  const costmap::TravelCost cost({.max_along = 0.9, .max_across = 0.9}, std::vector{curve});
  DirectionalCostBounds headings(cost);
  std::mt19937 random(5);
  for (int n = 0; n < 200; ++n) {
    const costmap::CellCode cell = randomCell(random, 200, 1);
    DirectionalCostBounds::Limits limits;
    ASSERT_TRUE(headings.of(cell, limits));
    for (int k = 0; k < DirectionalCostBounds::kHeadings; ++k) {
      const auto price = static_cast<double>(cost.costPerMetre(cell, DirectionalCostBounds::heading(k)));
      ASSERT_GE(static_cast<double>(limits[static_cast<std::size_t>(k)]), 0.995 * price) << n << " " << k;
    }
  }
}

TEST(DirectionalCostBounds, BlockedCellsHaveNoLimits) {
  const auto cost = testing::driveCost();
  DirectionalCostBounds::Limits limits;
  EXPECT_FALSE(
      DirectionalCostBounds(*cost).of(costmap::CellCode({.curve = costmap::CellCode::kBlocked}), limits));
  EXPECT_FALSE(
      DirectionalCostBounds(*cost).of(costmap::CellCode({.dz_dx = 1.5, .dz_dy = 1.5, .curve = 0}), limits));
}

}  // namespace directional_cost_bounds_test
}  // namespace talus::planner
