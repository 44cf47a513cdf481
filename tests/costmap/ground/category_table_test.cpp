#include <cmath>
#include <numbers>
#include <random>

#include <site_fixture.hpp>

#include <talus/costmap/cost/cross_slope.hpp>
#include <talus/costmap/ground/category_table.hpp>

namespace talus::costmap {
namespace category_table_test {

TEST(CategoryTable, IsTheModelsCategoryOfTheWorstHeading) {
  const auto model = testGround();
  const GroundBelief belief = model->prior(0);
  const CategoryTable table(*model, belief, *model->crossing(0));
  std::mt19937 random(4);
  std::uniform_real_distribution<double> gradient(-0.5, 0.5);
  for (int i = 0; i < 2000; ++i) {
    const CellCode cell({gradient(random), gradient(random), 0});
    const double steps = std::round(std::hypot(cell.stepsX(), cell.stepsY()));
    const double worst = model->crossing(0)->steepest(steps * CellCode::kStep);
    ASSERT_GE(worst, steps * CellCode::kStep);
    const Ranked expected = model->category(belief, worst);
    const CategoryTable::Entry seen = table.at(cell);
    ASSERT_EQ(seen.category, static_cast<std::uint8_t>(expected.category));
    const double sixteenths = 16.0 * expected.probability;
    const bool danger = expected.category == terramech::Category::Dangerous;
    ASSERT_EQ(seen.confidence, danger ? std::round(sixteenths) : std::floor(sixteenths));
  }
}

// Property: no heading is worse than what the picture says of the cell, to a tenth of a degree of steepness.
TEST(CategoryTable, NoHeadingIsWorse) {
  const auto model = testGround();
  const CategoryTable table(*model, model->prior(0), *model->crossing(0));
  const DriveCost cost(model->limits(), std::vector<DriveGround>{model->ground(0, model->prior(0))});
  for (double gradient = 0.01; gradient < 0.45; gradient += 0.0137)
    for (int k = 0; k < 24; ++k) {
      const double heading = k * std::numbers::pi / 24;
      const CellCode cell({.dz_dx = gradient, .dz_dy = 0.0, .curve = 0});
      const DriveState state = cost.detail(cell, {std::cos(heading), std::sin(heading)});
      const CellCode steeper({.dz_dx = gradient + 0.002, .dz_dy = 0.0, .curve = 0});
      EXPECT_GE(table.at(steeper).category, static_cast<std::uint8_t>(state.category))
          << gradient << ' ' << k;
    }
}

TEST(CategoryTable, HoldsTheSteepestGradientThatACellCanHold) {
  const auto model = testGround();
  const CategoryTable table(*model, model->prior(0), *model->crossing(0));
  // Property: nothing climbs a gradient of 2.8.
  EXPECT_EQ(table.at(CellCode({-2.0, -2.0, 0})).category,
            static_cast<std::uint8_t>(terramech::Category::Dangerous));
}

}  // namespace category_table_test
}  // namespace talus::costmap
