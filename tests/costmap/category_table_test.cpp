#include <cmath>
#include <random>

#include <site_fixture.hpp>

#include <talus/costmap/category_table.hpp>

namespace talus::costmap {
namespace {

TEST(CategoryTable, IsTheModelsCategoryAtTheSteepnessOfTheCell) {
  const auto model = testGround();
  const GroundBelief belief = model->prior(0);
  const CategoryTable table(*model, belief);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> gradient(-0.5, 0.5);
  for (int i = 0; i < 2000; ++i) {
    const CellCode cell({gradient(random), gradient(random), 0});
    const double steps = std::round(std::hypot(cell.stepsX(), cell.stepsY()));
    const Ranked expected = model->category(belief, steps * CellCode::kStep);
    const CategoryTable::Entry seen = table.at(cell);
    ASSERT_EQ(seen.category, static_cast<std::uint8_t>(expected.category));
    const double sixteenths = 16.0 * expected.probability;
    const bool danger = expected.category == terramech::Category::Dangerous;
    ASSERT_EQ(seen.confidence, danger ? std::round(sixteenths) : std::floor(sixteenths));
  }
}

TEST(CategoryTable, HoldsTheSteepestGradientThatACellCanHold) {
  const auto model = testGround();
  const CategoryTable table(*model, model->prior(0));
  // Property: nothing climbs a gradient of 2.8.
  EXPECT_EQ(table.at(CellCode({-2.0, -2.0, 0})).category,
            static_cast<std::uint8_t>(terramech::Category::Dangerous));
}

}  // namespace
}  // namespace talus::costmap
