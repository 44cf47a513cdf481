#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <site_fixture.hpp>

#include <talus/costmap/ground/cost_curve_table.hpp>

namespace talus::costmap {

namespace cost_curve_table_test {

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
TEST(GroundKind, RoundingIsConservative) {
  std::mt19937_64 random(3);
  const GroundClass ground{.soil = testSand()};
  for (int i = 0; i < 5000; ++i) {
    const GroundBelief belief = anyBelief(random);
    const GroundKind kind = GroundKind::of(kPrior, 0, 0, belief);
    const GroundBelief worst = kind.belief(kPrior, ground);
    // A difference of a millionth of a step is floating-point rounding.
    GroundBelief a_little_better = belief;
    a_little_better.pull.value += 1e-6;
    a_little_better.pull.std -= 1e-5;
    a_little_better.sinkage.value -= 1e-6;
    ASSERT_TRUE(noBetter(worst, a_little_better)) << i;
    ASSERT_EQ(GroundKind::of(kPrior, 0, 0, worst), kind);
  }
}

// Property: an estimate no worse than the prior of its class is rounded to a value no worse than the prior.
TEST(GroundKind, RoundingNeverFallsBelowThePrior) {
  std::mt19937_64 random(4);
  const GroundClass ground{.soil = testSand()};
  for (int i = 0; i < 2000; ++i) {
    const auto better = [&](double most) {
      return std::uniform_real_distribution<double>(0.0, most)(random);
    };
    const GroundBelief belief{.pull = {kPrior.pull.value + better(0.1), kPrior.pull.std - better(0.05)},
                              .sinkage = {kPrior.sinkage.value - better(0.2), 0.1}};
    ASSERT_TRUE(noBetter(kPrior, GroundKind::of(kPrior, 0, 0, belief).belief(kPrior, ground)));
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
      ASSERT_GE(table.cost()->curves()[number].cost_J_per_m[bin], 0.995F * exact.cost_J_per_m[bin])
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
  EXPECT_EQ(table.cost()->curves()[1].cost_J_per_m,
            model->ground(1, table.priorBelief(1)).curve.cost_J_per_m);
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
  const auto first = book.cost()->curves()[0].cost_J_per_m;
  ASSERT_TRUE(book.setPrior(0, high));
  const auto between = book.cost()->curves()[0].cost_J_per_m;
  ASSERT_TRUE(book.setPrior(0, low));
  EXPECT_FALSE(book.setPrior(0, low));
  EXPECT_EQ(book.cost()->curves()[0].cost_J_per_m, first);
  EXPECT_NE(between, first);
}

}  // namespace cost_curve_table_test

}  // namespace talus::costmap
