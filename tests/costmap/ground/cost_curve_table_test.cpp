#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <gtest/gtest.h>
#include <site_fixture.hpp>

#include <talus/costmap/ground/cost_curve_table.hpp>
#include <talus/costmap/ground/wheel_swath.hpp>

namespace talus::costmap {
namespace cost_curve_table_test {

// Closed form, by brute force: each cell is compared with every cell around it.
TEST(ClassBorders, BordersAreCellsWithAnotherClassWithinReach) {
  std::mt19937_64 random(2);
  for (int trial = 0; trial < 60; ++trial) {
    const maps::Grid grid{.width = 1 + static_cast<int>(random() % 15),
                          .height = 1 + static_cast<int>(random() % 15),
                          .resolution_m = 1.0,
                          .south_west = {}};
    maps::Raster<std::uint8_t> classes(grid, 1);
    for (std::uint8_t& c : classes.values())
      if (random() % 20 == 0) c = 2;
    const int reach = 1 + trial % 4;
    const auto border = classBorders(classes, reach);
    for (int row = 0; row < grid.height; ++row)
      for (int column = 0; column < grid.width; ++column) {
        bool other = false;
        for (int dy = -reach; dy <= reach; ++dy)
          for (int dx = -reach; dx <= reach; ++dx) {
            const maps::Cell near{column + dx, row + dy};
            other = other || (grid.contains(near) && classes[near] != classes[{column, row}]);
          }
        ASSERT_EQ(border[grid.index({column, row})], other) << trial << ' ' << column << ' ' << row;
      }
  }
  EXPECT_TRUE(classBorders({}, 2).empty());
}

using Around = std::vector<WheelSwath::Ground>;

WheelSwath::Ground strong() {
  return {0, {.pull = {0.3, 0.05}, .sinkage = {0.1, 0.1}}};
}

WheelSwath::Ground trap() {
  return {1, {.pull = {-0.25, 0.02}, .sinkage = {0.8, 0.1}}};
}

Around all(const WheelSwath& swath, const WheelSwath::Ground& ground) {
  const auto side = static_cast<std::size_t>(2 * swath.reach() + 1);
  return Around(side * side, ground);
}

WheelSwath::Ground& at(Around& around, const WheelSwath& swath, maps::Cell offset) {
  const int side = 2 * swath.reach() + 1;
  return around[static_cast<std::size_t>((offset.row + swath.reach()) * side + offset.column +
                                         swath.reach())];
}

TEST(WheelSwath, PoseErrorExtendsTheReach) {
  const WheelSwath exact(testRover(), 0.25, 0.0), unsure(testRover(), 0.25, 0.6);
  EXPECT_GE(unsure.reach(), exact.reach() + 2);
  Around around = all(unsure, strong());
  for (int row = -unsure.reach(); row <= unsure.reach(); ++row) at(around, unsure, {4, row}) = trap();
  EXPECT_LT(unsure.judged(around).belief.pull.value, 0.3);
}

// Property: for any position of the centre in the cell and any heading, the mean pull of the wheels is at
// least the stated value, up to the step of positions and headings. The stated value is never better than
// the cell's own ground.
TEST(WheelSwath, PullIsTheMinimumOverPositionsAndHeadings) {
  std::mt19937_64 random(5);
  const auto drawn = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const terramech::Rover rover = testRover();
  const double cell_m = 0.5;
  const WheelSwath swath(rover, cell_m, 0.0);
  double missed = 0.0;
  int standings = 0;
  for (int trial = 0; trial < 40; ++trial) {
    Around around = all(swath, strong());
    for (auto& ground : around)
      if (drawn(0.0, 1.0) < 0.3) ground = trap();
    const double said = swath.judged(around).belief.pull.value;
    EXPECT_LE(said, around[around.size() / 2].belief.pull.value);
    for (int k = 0; k < 500; ++k, ++standings) {
      const double x = drawn(-0.5, 0.5) * cell_m, y = drawn(-0.5, 0.5) * cell_m;
      const double heading = drawn(0.0, 2.0 * std::numbers::pi);
      double sum = 0.0;
      for (const double along : {-0.5, 0.5})
        for (const double side : {-0.5, 0.5}) {
          double least = INFINITY;
          for (double across = -0.5; across <= 0.5; across += 0.1) {
            const double a = along * rover.wheelbase_m,
                         b = side * rover.track_m + across * rover.wheel.width_m;
            const double wx = x + a * std::cos(heading) - b * std::sin(heading);
            const double wy = y + a * std::sin(heading) + b * std::cos(heading);
            const maps::Cell offset{static_cast<int>(std::floor(wx / cell_m + 0.5)),
                                    static_cast<int>(std::floor(wy / cell_m + 0.5))};
            ASSERT_LE(std::max(std::abs(offset.column), std::abs(offset.row)), swath.reach());
            least = std::min(least, at(around, swath, offset).belief.pull.value);
          }
          sum += 0.25 * least;
        }
      missed += sum < said - 1e-9;
    }
  }
  // A wheel may touch a corner of a cell between two of the sampled positions and headings.
  EXPECT_LT(missed / standings, 0.01);
}

CategoryTable tableOf(const std::shared_ptr<const GroundModel>& model) {
  return {model, model->prior(0), model->ground(0, model->prior(0))};
}

// Property: the category is that of the model in the steepest heading, or worse because of the planners'
// rounding.
TEST(CategoryTable, CategoryIsAtLeastThatOfTheWorstHeading) {
  const auto model = testGround();
  const CategoryTable table = tableOf(model);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> gradient(-0.5, 0.5);
  int same = 0;
  for (int i = 0; i < 2000; ++i) {
    const CellCode cell({gradient(random), gradient(random), 0});
    const double steps = std::ceil(std::hypot(cell.stepsX(), cell.stepsY()));
    const double worst = model->lattice(0)->steepest(steps * CellCode::kStep);
    const RankedCategory expected = model->category(model->prior(0), worst);
    const CellCategory seen = table.at(cell);
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
  const CategoryTable table = tableOf(model);
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
  const CategoryTable table = tableOf(model);
  // Property: a gradient of 2.8 is dangerous.
  EXPECT_EQ(table.at(CellCode({-2.0, -2.0, 0})).category,
            static_cast<std::uint8_t>(terramech::Category::Dangerous));
}

GroundBelief anyBelief(std::mt19937_64& random) {
  const auto drawn = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  return {.pull = {drawn(-1.0, 1.0), drawn(0.0, 3.0)}, .sinkage = {drawn(0.0, 2.0), 0.1}};
}

const GroundBelief kPrior{.pull = {0.137, 0.09}, .sinkage = {0.23, 0.1}};

bool noBetter(const GroundBelief& belief, const GroundBelief& than) {
  return belief.pull.value <= than.pull.value && belief.pull.std >= than.pull.std &&
         belief.sinkage.value >= than.sinkage.value;
}

// Property: the rounded estimate is no better than the exact one in any quantity, and rounds to itself.
TEST(RoundedGround, RoundingIsConservative) {
  std::mt19937_64 random(3);
  const GroundClass ground{.soil = testSand()};
  for (int i = 0; i < 5000; ++i) {
    const GroundBelief belief = anyBelief(random);
    const GroundBelief worst = rounded(belief, kPrior, ground);
    // A difference of a millionth of a step is floating-point rounding.
    GroundBelief a_little_better = belief;
    a_little_better.pull.value += 1e-6;
    a_little_better.pull.std -= 1e-5;
    a_little_better.sinkage.value -= 1e-6;
    ASSERT_TRUE(noBetter(worst, a_little_better)) << i;
    const GroundBelief again = rounded(worst, kPrior, ground);
    ASSERT_TRUE(noBetter(worst, again) && noBetter(again, worst));
  }
}

// Property: an estimate no worse than the prior of its class is rounded to a value no worse than the prior.
TEST(RoundedGround, RoundingNeverFallsBelowThePrior) {
  std::mt19937_64 random(4);
  const GroundClass ground{.soil = testSand()};
  for (int i = 0; i < 2000; ++i) {
    const auto better = [&](double most) {
      return std::uniform_real_distribution<double>(0.0, most)(random);
    };
    const GroundBelief belief{.pull = {kPrior.pull.value + better(0.1), kPrior.pull.std - better(0.05)},
                              .sinkage = {kPrior.sinkage.value - better(0.2), 0.1}};
    ASSERT_TRUE(noBetter(kPrior, rounded(belief, kPrior, ground)));
  }
}

// Property: the cost of an estimate does not depend on which of several similar estimates was requested
// first.
TEST(CostCurveTable, CostIsIndependentOfRequestOrder) {
  const auto model = testGround();
  const Estimate pull = model->prior(0).pull;
  const GroundBelief sure{.pull = {pull.value - 0.012, 0.48 * pull.std}, .sinkage = {0.6, 0.01}};
  const GroundBelief unsure{.pull = {pull.value - 0.014, 0.49 * pull.std}, .sinkage = {0.6, 0.3}};
  CostCurveTable one(model), other(model);
  const CellCode::Curve a = one.learned(0, sure);
  const CellCode::Curve b = other.learned(0, unsure);
  EXPECT_EQ(one.learned(0, unsure), a) << "alike after rounding";
  EXPECT_EQ(other.learned(0, sure), b);
  int different = 0;
  for (int step = -300; step <= 300; ++step) {
    const CellCode cell({.dz_dx = step / 1024.0});
    const auto x = one.categories(a).at(cell), y = other.categories(b).at(cell);
    different += x.category != y.category || x.confidence != y.confidence;
  }
  EXPECT_EQ(different, 0);
}

// Property: the tabulated cost is never below the cost of the estimate that was requested, at any gradient. Tolerance 0.5 %: energy is not convex in the strength where brakes
// fail, so that a greater standard deviation may lower its expectation.
TEST(CostCurveTable, TabulatedCostIsNeverBelowTheExactCost) {
  std::mt19937_64 random(9);
  const auto drawn = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const auto model = testGround();
  CostCurveTable table(model);
  for (int i = 0; i < 600; ++i) {
    const int index = static_cast<int>(random() % 2);
    const GroundBelief belief{.pull = {drawn(-0.3, 0.6), drawn(0.005, 0.2)},
                              .sinkage = {drawn(0.0, 1.5), 0.1}};
    const CellCode::Curve number = table.learned(index, belief);
    if (i % 10 != 0) continue;
    const TravelCurve exact = model->ground(index, belief).curve;
    for (std::size_t bin = 0; bin < TravelCurve::kBins; ++bin)
      ASSERT_GE(table.cost()->curves()[number].level()[bin], 0.995F * exact.level()[bin])
          << i << " at gradient " << TravelCurve::gradient(static_cast<int>(bin));
  }
}

// Property: a class without a request is refused; after its first request it has the cost of its current
// estimate.
TEST(CostCurveTable, ClassCostIsComputedOnFirstRequest) {
  const auto model = testGround();
  CostCurveTable table(model);
  const CellCode level({.curve = 1});
  EXPECT_EQ(table.cost()->costPerMetre(level, {}), std::numeric_limits<float>::infinity());
  EXPECT_NE(table.cost()->detail(level, {}).refusal, Refusal::None);
  EXPECT_EQ(table.categories(1).at(level).category,
            static_cast<std::uint8_t>(terramech::Category::Dangerous));
  EXPECT_LT(table.cost()->costPerMetre(CellCode({.curve = 0}), {}), 1e6F) << "the first is the default";
  const GroundBelief weaker{.pull = {model->prior(1).pull.value - 0.05, 0.06}, .sinkage = {0.4, 0.1}};
  ASSERT_TRUE(table.setPrior(1, weaker));
  const auto before = table.cost();
  ASSERT_EQ(table.prior(1), 1);
  EXPECT_NE(table.cost(), before);
  EXPECT_EQ(*table.cost()->curves()[1].costs, *model->ground(1, table.priorBelief(1)).curve.costs);
  EXPECT_LE(table.priorBelief(1).pull.value, weaker.pull.value);
}

// Property: an estimate without an index is refused; after a restart there is an index for it.
TEST(CostCurveTable, FullTableRefusesFurtherEstimates) {
  CostCurveTable table(testGround());
  const CellCode::Curve ground = table.prior(0);
  for (int step = 1; table.size() < CostCurveTable::kMost; ++step) table.dearer(ground, step, 0.1 * step);
  const GroundBelief belief{.pull = {0.05, 0.06}, .sinkage = {0.2, 0.1}};
  EXPECT_EQ(table.learned(0, belief), CellCode::kBlocked);
  EXPECT_EQ(table.prior(1), 1) << "a class has its own index";
  table.restart();
  EXPECT_EQ(table.learned(0, belief), 2);
}

// Property: a prior that changes and returns yields the same costs each time.
TEST(CostCurveTable, RestoredPriorReproducesItsCosts) {
  CostCurveTable book(testGround());
  const GroundBelief low{.pull = {0.2, 0.06}, .sinkage = {0.2, 0.1}};
  const GroundBelief high{.pull = {0.21, 0.06}, .sinkage = {0.2, 0.1}};
  ASSERT_TRUE(book.setPrior(0, low));
  const auto first = *book.cost()->curves()[0].costs;
  ASSERT_TRUE(book.setPrior(0, high));
  const auto between = *book.cost()->curves()[0].costs;
  ASSERT_TRUE(book.setPrior(0, low));
  EXPECT_FALSE(book.setPrior(0, low));
  EXPECT_EQ(*book.cost()->curves()[0].costs, first);
  EXPECT_NE(between, first);
}

}  // namespace cost_curve_table_test
}  // namespace talus::costmap
