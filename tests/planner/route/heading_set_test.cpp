#include <cmath>
#include <numbers>
#include <random>

#include <talus/planner/route/heading_set.hpp>

#include "drawn_map.hpp"

namespace talus::planner {

namespace heading_set_test {

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

bool holds(const HeadingSet& set, double heading) {
  return !set.empty() && std::abs(std::remainder(set.nearest(heading) - heading, HeadingSet::kTurn)) < 1e-12;
}

TEST(HeadingSet, TouchingArcsAreMerged) {
  const HeadingSet set({{6.0, 0.5}, {0.1, 0.4}, {2.0, 0.1}});  // the first reaches 0.2168 beyond 2 pi
  ASSERT_EQ(set.arcs().size(), 2U);
  EXPECT_TRUE(holds(set, 0.4));
  EXPECT_FALSE(holds(set, 0.6));
  EXPECT_NEAR(set.widestGap().end_rad, 2.1, 1e-12);
  EXPECT_NEAR(set.widestGap().width_rad, 3.9, 1e-12);
}

// Closed form, by brute force: each heading is evaluated separately on the cost of random cells, half of
// them gentle.
TEST(HeadingSet, ContainsExactlyTheAllowedHeadings) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> gradient(-0.6, 0.6), angle(0.0, HeadingSet::kTurn);
  const auto cost = testing::driveCost({.max_along = 0.28, .max_across = 0.17});
  HeadingSets sets(*cost);
  int held = 0, refused = 0;
  for (int k = 0; k < 400; ++k) {
    const double scale = k % 2 == 0 ? 0.4 : 1.0;
    const costmap::CellCode cell(
        {.dz_dx = scale * gradient(random), .dz_dy = scale * gradient(random), .curve = 2});
    const HeadingSet& kept = sets.of(cell);
    const HeadingSet set = allowedHeadings(*cost, cell);
    for (int drawn = 0; drawn < 200; ++drawn) {
      const double heading = angle(random);
      const bool allowed = std::isfinite(cost->costPerMetre(cell, {std::cos(heading), std::sin(heading)}));
      (allowed ? held : refused) += 1;
      EXPECT_EQ(holds(kept, heading), allowed) << cell.dzDx() << ' ' << cell.dzDy() << ' ' << heading;
      EXPECT_EQ(holds(set, heading), allowed) << cell.dzDx() << ' ' << cell.dzDy() << ' ' << heading;
    }
  }
  EXPECT_GT(held, 4000);
  EXPECT_GT(refused, 4000);
}

TEST(HeadingSet, IntersectionContainsHeadingsOfBothSets) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> angle(0.0, HeadingSet::kTurn), width(0.0, 2.5);
  for (int k = 0; k < 200; ++k) {
    const HeadingSet a({{angle(random), width(random)}, {angle(random), width(random)}}),
        b({{angle(random), width(random)}});
    const HeadingSet both = a.shared(b);
    for (int drawn = 0; drawn < 50; ++drawn) {
      const double heading = angle(random);
      EXPECT_EQ(holds(both, heading), holds(a, heading) && holds(b, heading));
      EXPECT_EQ(holds(a.reversed(), heading), holds(a, heading + std::numbers::pi));
    }
  }
}

}  // namespace heading_set_test

}  // namespace talus::planner
