#include <limits>
#include <random>

#include <site_fixture.hpp>

#include <talus/costmap/ground/cost_curve_table.hpp>

namespace talus::costmap {
namespace cost_curve_table_test {

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
