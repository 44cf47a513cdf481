#include <random>

#include <site_fixture.hpp>

#include <talus/costmap/cost_curve_table.hpp>

namespace talus::costmap {
namespace {

// Property: what a belief costs does not depend on which like it was asked for first.
TEST(CostCurveTable, OrderDoesNotMatter) {
  const GroundBelief sure{.pull = {0.101, 0.031}, .sinkage = {0.6, 0.01}};
  const GroundBelief unsure{.pull = {0.107, 0.033}, .sinkage = {0.6, 0.3}};
  CostCurveTable one(testGround()), other(testGround());
  const std::uint8_t a = one.learned(0, sure);
  const std::uint8_t b = other.learned(0, unsure);
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

// Property: a number's ground costs no less than the belief that it was given for, at any gradient, also when the
// numbers have run out.
TEST(CostCurveTable, NoBeliefIsMadeCheaper) {
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
    const std::uint8_t number = table.learned(index, belief);
    if (i % 10 != 0 || number == CellCode::kBlocked) continue;
    const DriveCurve exact = model->ground(index, belief).curve;
    for (std::size_t bin = 0; bin < DriveCurve::kBins; ++bin)
      ASSERT_GE(table.cost()->curves()[number].cost_J_per_m[bin], (1.0F - 1e-6F) * exact.cost_J_per_m[bin])
          << i << " at gradient " << DriveCurve::gradient(static_cast<int>(bin));
  }
  EXPECT_TRUE(table.overflowed());
}

// Property: a prior that moves to and fro comes to the same each time.
TEST(CostCurveTable, APriorThatComesBackIsTheSame) {
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

}  // namespace
}  // namespace talus::costmap
