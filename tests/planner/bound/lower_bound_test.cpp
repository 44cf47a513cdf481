#include <cmath>
#include <random>

#include <talus/planner/bound/cost_lower_bound.hpp>
#include <talus/planner/bound/directional_lower_bound.hpp>
#include <talus/planner/bound/lower_bound.hpp>
#include <talus/planner/grid/field_planner.hpp>

#include "drawn_map.hpp"

namespace talus::planner {
namespace {

using testing::drawn;
using testing::randomMap;

// Property: no allowed metre in any heading costs less than the line says.
TEST(CostLowerBounds, StayBelowTheCost) {
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

// Curves of many shapes: bends, jumps and holes, not only valleys.
std::shared_ptr<const costmap::DriveCost> jaggedCost() {
  std::mt19937 random(7);
  const auto unit = [&random] { return static_cast<double>(random()) / 4294967296.0; };
  std::vector<costmap::DriveCurve> curves;
  for (int k = 0; k < 6; ++k) {
    costmap::DriveCurve made = testing::curve({.factor = 1.0 + k, .steepest = 0.1 + 0.1 * k});
    for (float& value : made.cost_J_per_m) value *= static_cast<float>(1.0 + 0.3 * k * unit());
    if (k > 3) made.cost_J_per_m[static_cast<std::size_t>(costmap::DriveCurve::kBins / 2 + 7 * k)] = INFINITY;
    curves.push_back(made);
  }
  return std::make_shared<costmap::DriveCost>(costmap::DriveCost::Limits{.max_along = 0.5, .max_across = 0.4},
                                              curves);
}

// Property: the gauge between the prices of neighbouring headings is nowhere above the cost, in any
// direction, and every heading has a price.
TEST(DirectionalLowerBounds, TheirGaugeStaysBelowTheCost) {
  for (const auto& cost : {testing::driveCost({.max_along = 0.4, .max_across = 0.4}), jaggedCost()}) {
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

// Property: no polyline costs less, of which the best that the planner finds, refined as hard as we can, is
// the sharpest.
TEST(LowerBound, IsBelowEveryRouteFound) {
  for (unsigned seed = 1; seed <= 25; ++seed) {
    const auto map =
        randomMap({.width = 40, .height = 30, .seed = seed, .blocked = 0.1, .roughness = 0.02 * (seed % 12)});
    FieldPlanner planner({.finest_cells = 0.25,
                          .shift = {12, 12},
                          .corridor = {.reach_cells = 6, .points_per_edge = 6},
                          .slides = 6});
    for (const maps::Point start : {maps::Point{2.3, 2.7}, maps::Point{39.9, 0.1}}) {
      const Problem asked{.map = map, .start = start, .goal = {20.2, 27.9}, .prove = false};
      const Plan plan = planner.plan(asked);
      if (plan.status != RouteStatus::Found) continue;
      const double bound = LowerBound()(map, {asked.start, asked.goal}, 0.0);
      EXPECT_LE(bound, plan.cost_J) << seed;
      EXPECT_GT(bound, 0.0);
    }
  }
}

// Ramps of one gradient and soil, 20 cells wide: ground on which the bound is sharp enough to be wrong.
std::shared_ptr<const costmap::CostGrid> ramps(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<costmap::CellCode> patches;
  const auto gradient = [&random] { return (static_cast<int>(random() % 400) - 200) / 1024.0; };
  for (int k = 0; k < 16; ++k)
    patches.push_back(costmap::CellCode(
        {.dz_dx = gradient(), .dz_dy = gradient(), .curve = static_cast<std::uint8_t>(random() % 3)}));
  maps::Raster<costmap::CellCode> cells({.width = 80, .height = 80, .resolution_m = 1.0, .south_west = {}});
  for (int row = 0; row < 80; ++row)
    for (int column = 0; column < 80; ++column)
      cells[{column, row}] = patches[static_cast<std::size_t>(row / 20 * 4 + column / 20)];
  return std::make_shared<costmap::CostGrid>(costmap::flattened(cells, testing::driveCost()));
}

// Property: no motion that happens to be allowed costs less, straight or bent once, of any length and
// heading, also along the map's border.
TEST(LowerBound, IsBelowRandomMotions) {
  int tried = 0, sharp = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const auto map = ramps(seed);
    const MotionCost cost(map);
    std::mt19937 random(seed);
    const auto place = [&random] {
      return maps::Point{static_cast<double>(random() % 801) / 10, static_cast<double>(random() % 801) / 10};
    };
    for (int g = 0; g < 4; ++g) {
      const maps::Point goal = place();
      LowerBound bound;
      for (int k = 0; k < 500; ++k) {
        const maps::Point start = place();
        const double cost_J = k % 2 == 0 ? cost({start, goal}) : cost.along({start, place(), goal});
        if (!std::isfinite(cost_J)) continue;
        const double bound_J = bound(map, {start, goal}, 0.0);
        ASSERT_LE(bound_J, cost_J * (1 + 1e-9)) << seed << " " << g << " " << k;
        ++tried;
        if (bound_J > 0.85 * cost_J) ++sharp;
      }
    }
  }
  EXPECT_GT(tried, 10'000);
  EXPECT_GT(sharp, 100);
}

TEST(LowerBound, IsWithinTheOctagonOnEvenGround) {
  const auto map = drawn(std::vector<std::string>(200, std::string(200, '.')));
  // Closed form: 10 J/m; the octagon gives away up to 7.6 %, the squares about the ends two cells each.
  const Segment ends{{10.5, 10.5}, {190.5, 80.5}};
  const double best = 10.0 * std::hypot(180.0, 70.0);
  const double bound = LowerBound()(map, ends, 0.0);
  EXPECT_LE(bound, best);
  EXPECT_GT(bound, 0.90 * best);
}

TEST(LowerBound, KnowsThatClimbingIsDear) {
  // Closed form: a ramp of 0.2 costs 43 J/m straight up and 26 J/m down, ten on the flat.
  std::vector<std::string> rows(60, std::string(60, '>'));
  const auto map = drawn(rows);
  const double up = LowerBound()(map, {{5.5, 30.5}, {54.5, 30.5}}, 0.0);
  const double down = LowerBound()(map, {{54.5, 30.5}, {5.5, 30.5}}, 0.0);
  EXPECT_GT(up, 1.3 * down);
}

TEST(LowerBound, ToleranceLowersIt) {
  const auto map = drawn(std::vector<std::string>(60, std::string(60, '.')));
  const Segment ends{{5.5, 5.5}, {50.5, 50.5}};
  EXPECT_LT(LowerBound()(map, ends, 20.0), LowerBound()(map, ends, 0.0));
}

}  // namespace
}  // namespace talus::planner
