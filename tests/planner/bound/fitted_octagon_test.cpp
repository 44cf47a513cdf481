#include <cmath>
#include <numbers>
#include <random>

#include <talus/planner/bound/fitted_octagon.hpp>

#include "drawn_map.hpp"
#include "jagged_cost.hpp"

namespace talus::planner {

namespace fitted_octagon_test {

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
  const costmap::TravelCurve curve =
      testing::curveOf([](double g) { return 10.0 + 20.0 * g + 40.0 * g * g; });
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

constexpr double kEighth = std::numbers::pi / 4.0;

// The gauge of an octagon: linear between the weights of neighbouring headings.
double gauge(const Octagon& octagon, double angle) {
  const auto k = static_cast<std::size_t>(angle / kEighth);
  const double in = angle - static_cast<double>(k) * kEighth;
  return (std::sin(kEighth - in) * static_cast<double>(octagon[k % 8]) +
          std::sin(in) * static_cast<double>(octagon[(k + 1) % 8])) /
         std::sin(kEighth);
}

void expectConvexAndPositive(const Octagon& octagon) {
  for (std::size_t k = 0; k < 8; ++k) {
    ASSERT_GT(octagon[k], 0.0F);
    ASSERT_LE(octagon[k], (octagon[(k + 1) % 8] + octagon[(k + 7) % 8]) * 0.70710678F * 1.000001F);
  }
}

// Property: by brute force over 3600 directions, no octagon is above the cost of a cell of random curve and
// gradient, whatever decrease is wanted; and every octagon is convex.
TEST(FittedOctagon, GaugeIsBelowTheCostInEveryDirection) {
  for (const auto& cost :
       {testing::driveCost({.max_along = 0.4, .max_across = 0.4}), testing::jaggedCost()}) {
    DirectionalCostBounds bounds(*cost);
    FittedOctagons octagons(*cost);
    std::mt19937 random(3);
    const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
    for (int n = 0; n < 1'000; ++n) {
      const int most = n % 2 == 0 ? 300 : 900;
      const auto gradient = [&] { return (static_cast<int>(random()) % most) / 1024.0; };
      const costmap::CellCode cell({.dz_dx = gradient(),
                                    .dz_dy = gradient(),
                                    .curve = static_cast<std::uint8_t>(random() % cost->curves().size())});
      DirectionalCostBounds::Limits limits;
      if (!bounds.of(cell, limits)) {
        ASSERT_TRUE(std::isinf(octagons.of(cell).front()));
        continue;
      }
      Octagon wanted;  // of a plane; in every fourth case of no function
      const double steep = 40.0 * unit(), towards = 2.0 * std::numbers::pi * unit();
      for (std::size_t k = 0; k < 8; ++k)
        wanted[k] = static_cast<float>(
            n % 4 == 0 ? 40.0 * unit() : steep * std::cos(towards - static_cast<double>(k) * kEighth));
      for (const Octagon& octagon : {octagons.of(cell), fittedOctagon(limits, wanted)}) {
        expectConvexAndPositive(octagon);
        for (int d = 0; d < 3'600; ++d) {
          const double angle = std::numbers::pi / 1800.0 * d;
          const float price = cost->costPerMetre(cell, {std::cos(angle), std::sin(angle)});
          if (std::isfinite(price)) {
            ASSERT_LE(gauge(octagon, angle), static_cast<double>(price)) << n << " " << d;
          }
        }
      }
    }
  }
}

// Closed form: on level ground of 10 J/m the regular octagon in the circle of the limits has weights of 10
// cos(22.5 degrees). For a wanted plane that decreases by the limit along any direction, the octagon has a
// corner there: its weights at the two headings beside the direction are at least those of the plane, but for
// the cosine of half a sector of the limits and rounding.
TEST(FittedOctagon, OctagonHasACornerAtTheWantedPlane) {
  const auto cost = testing::driveCost();
  const costmap::CellCode level({.curve = 0});
  DirectionalCostBounds::Limits limits;
  ASSERT_TRUE(DirectionalCostBounds(*cost).of(level, limits));
  FittedOctagons octagons(*cost);
  for (const float weight : octagons.of(level))
    EXPECT_NEAR(static_cast<double>(weight), 10.0 * std::cos(0.5 * kEighth), 0.03);
  for (int d = 0; d < 90; ++d) {
    const double towards = std::numbers::pi / 45.0 * d;
    Octagon plane;
    for (std::size_t k = 0; k < 8; ++k)
      plane[k] = static_cast<float>(10.0 * std::cos(towards - static_cast<double>(k) * kEighth));
    const Octagon octagon = fittedOctagon(limits, plane);
    const auto beside = static_cast<std::size_t>(towards / kEighth);
    for (const std::size_t k : {beside % 8, (beside + 1) % 8}) EXPECT_GE(octagon[k], 0.997F * plane[k]) << d;
  }
}

}  // namespace fitted_octagon_test

}  // namespace talus::planner
