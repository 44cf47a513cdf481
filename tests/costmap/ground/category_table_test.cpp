#include <cmath>
#include <numbers>
#include <random>

#include <site_fixture.hpp>

#include <talus/costmap/ground/category_table.hpp>

namespace talus::costmap {
namespace category_table_test {

CategoryTable tableOf(const GroundModel& model) {
  return {model, model.prior(0), model.ground(0, model.prior(0))};
}

// Property: the category is that of the model in the steepest heading, or worse because of the planners'
// rounding.
TEST(CategoryTable, CategoryIsAtLeastThatOfTheWorstHeading) {
  const auto model = testGround();
  const CategoryTable table = tableOf(*model);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> gradient(-0.5, 0.5);
  int same = 0;
  for (int i = 0; i < 2000; ++i) {
    const CellCode cell({gradient(random), gradient(random), 0});
    const double steps = std::ceil(std::hypot(cell.stepsX(), cell.stepsY()));
    const double worst = model->lattice(0)->steepest(steps * CellCode::kStep);
    const RankedCategory expected = model->category(model->prior(0), worst);
    const CategoryTable::Entry seen = table.at(cell);
    ASSERT_GE(seen.category, static_cast<std::uint8_t>(expected.category));
    if (seen.category != static_cast<std::uint8_t>(expected.category)) continue;
    ++same;
    const double sixteenths = 16.0 * expected.probability;
    const bool danger = expected.category == terramech::Category::Dangerous;
    ASSERT_EQ(seen.confidence, danger ? std::round(sixteenths) : std::floor(sixteenths));
  }
  EXPECT_GT(same, 1600);  // nodes are 4 steps apart
}

// Property: the map's category of a cell is at least as bad as its category in any heading. A cell that the
// map shows as safe or marginal is not refused in its worst heading.
TEST(CategoryTable, NoHeadingHasAWorseCategory) {
  const auto model = testGround();
  const CategoryTable table = tableOf(*model);
  const TravelCost cost(model->limits(), std::vector<GroundCost>{model->ground(0, model->prior(0))});
  for (double gradient = 0.01; gradient < 0.45; gradient += 0.0137)
    for (int k = 0; k < 48; ++k) {
      const double heading = k * std::numbers::pi / 24;
      const CellCode cell({.dz_dx = gradient * std::cos(k), .dz_dy = gradient * std::sin(k), .curve = 0});
      const TravelState state = cost.detail(cell, {std::cos(heading), std::sin(heading)});
      const auto seen = static_cast<terramech::Category>(table.at(cell).category);
      EXPECT_GE(seen, state.category) << gradient << ' ' << k;
      if (seen == terramech::Category::Dangerous) continue;
      EXPECT_EQ(cost.detail(cell, worstHeading(cost, cell)).refusal, Refusal::None) << gradient << ' ' << k;
    }
}

TEST(CategoryTable, SteepestRepresentableGradientIsDangerous) {
  const auto model = testGround();
  const CategoryTable table = tableOf(*model);
  // Property: a gradient of 2.8 is dangerous.
  EXPECT_EQ(table.at(CellCode({-2.0, -2.0, 0})).category,
            static_cast<std::uint8_t>(terramech::Category::Dangerous));
}

}  // namespace category_table_test
}  // namespace talus::costmap
