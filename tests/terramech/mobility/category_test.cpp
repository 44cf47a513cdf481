#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <stdexcept>

#include <refused.hpp>

#include <talus/common/common.hpp>
#include <talus/terramech/mobility/category.hpp>

namespace talus::terramech {
namespace category_test {

const CategoryThresholds kLimits{.dp_low = 0.125,
                                 .dp_high = 0.375,
                                 .z_threshold = 0.5,
                                 .z_critical = 0.75,
                                 .t_threshold = 1.0,
                                 .t_critical = 1.5};

Category of(double dp, double z, std::optional<double> t = {}) {
  return categorise({.drawbar_pull_over_load = dp, .sinkage_over_radius = z, .torque_over_load_radius = t},
                    kLimits);
}

double above(double x) {
  return std::nextafter(x, std::numeric_limits<double>::infinity());
}
double below(double x) {
  return std::nextafter(x, -std::numeric_limits<double>::infinity());
}

// Printed in: thesis 3.5, whose inequalities are strict.
TEST(Category, DrawbarPullAtItsThresholdsIsMarginal) {
  EXPECT_EQ(of(below(0.125), 0.0), Category::Dangerous);
  EXPECT_EQ(of(0.125, 0.0), Category::Marginal);
  EXPECT_EQ(of(0.375, 0.0), Category::Marginal);
  EXPECT_EQ(of(above(0.375), 0.0), Category::Safe);
}

TEST(Category, SinkageBetweenThresholdAndCriticalLowersTheCategoryByOne) {
  EXPECT_EQ(of(0.5, below(0.5)), Category::Safe);
  EXPECT_EQ(of(0.5, 0.5), Category::Marginal);
  EXPECT_EQ(of(0.5, 0.75), Category::Marginal);
  EXPECT_EQ(of(0.5, above(0.75)), Category::Dangerous);
  EXPECT_EQ(of(0.25, 0.5), Category::Dangerous);
}

TEST(Category, TorqueLowersTheCategoryAndReductionsAddUp) {
  EXPECT_EQ(of(0.5, 0.0, below(1.0)), Category::Safe);
  EXPECT_EQ(of(0.5, 0.0, 1.0), Category::Marginal);
  EXPECT_EQ(of(0.5, 0.0, 1.5), Category::Marginal);
  EXPECT_EQ(of(0.5, 0.0, above(1.5)), Category::Dangerous);
  EXPECT_EQ(of(0.5, 0.6, 1.2), Category::Dangerous);
}

TEST(Category, NanIsUnknown) {
  const double nan = std::nan("");
  EXPECT_EQ(of(nan, 0.0), Category::Unknown);
  EXPECT_EQ(of(0.5, nan), Category::Unknown);
  EXPECT_EQ(of(0.5, 0.0, nan), Category::Unknown);
}

TEST(Category, IsMonotoneInPullSinkageAndTorque) {
  // Property: the category is monotone in each quantity.
  for (double dp = -0.5; dp < 1.0; dp += 0.0625)
    for (double z = 0.0; z < 1.0; z += 0.0625)
      for (double t = 0.0; t < 2.0; t += 0.125) {
        EXPECT_GE(of(dp, z, t), of(dp + 0.0625, z, t));
        EXPECT_LE(of(dp, z, t), of(dp, z + 0.0625, t));
        EXPECT_LE(of(dp, z, t), of(dp, z, t + 0.125));
      }
}

TEST(Category, ThresholdsFollowFromMissionSlopeAndMargin) {
  const CategoryThresholds t = thresholds({.slope_rad = 15.0 * kDegree, .margin_rad = 5.0 * kDegree});
  // Printed in: thesis 3.5, tan 10 deg and tan 20 deg.
  EXPECT_NEAR(t.dp_low, std::tan(10.0 * kDegree), 1e-15);
  EXPECT_NEAR(t.dp_high, std::tan(20.0 * kDegree), 1e-15);
  EXPECT_THROW(thresholds({.slope_rad = 1.5, .margin_rad = 0.2}), std::invalid_argument);
}

TEST(Category, InvalidThresholdsAreRejected) {
  CategoryThresholds t = kLimits;
  t.dp_low = 0.4;
  EXPECT_THROW(validate(t), std::invalid_argument);
  t = kLimits;
  t.z_critical = std::nan("");
  EXPECT_THROW(validate(t), std::invalid_argument);
  EXPECT_NO_THROW(validate(kLimits));
}

const CategoryThresholds kSpreadLimits{
    .dp_low = 0.17, .dp_high = 0.36, .z_threshold = 0.5, .z_critical = 0.75};

TEST(CategoryProbability, ZeroUncertaintyYieldsTheCategoryWithProbabilityOne) {
  for (const double dp : {0.1, 0.17, 0.3, 0.36, 0.5})
    for (const double z : {0.2, 0.5, 0.6, 0.75, 0.8}) {
      const WheelCondition condition{.drawbar_pull_over_load = dp, .sinkage_over_radius = z};
      const auto p = categoryProbability({{dp, 0.0}, {z, 0.0}}, kSpreadLimits);
      EXPECT_DOUBLE_EQ(p[static_cast<std::size_t>(categorise(condition, kSpreadLimits))], 1.0)
          << dp << " " << z;
    }
}

TEST(CategoryProbability, MatchesMonteCarlo) {
  const auto p = categoryProbability({{0.32, 0.08}, {0.45, 0.12}}, kSpreadLimits);
  std::mt19937_64 random{5};
  std::normal_distribution<double> normal;
  constexpr int kDraws = 200000;
  CategoryProbability counted{};
  for (int k = 0; k < kDraws; ++k) {
    const double a = normal(random), b = normal(random);
    const auto category = categorise(
        {.drawbar_pull_over_load = 0.32 + 0.08 * a, .sinkage_over_radius = 0.45 + 0.12 * b}, kSpreadLimits);
    counted[static_cast<std::size_t>(category)] += 1.0 / kDraws;
  }
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(p[k], counted[k], 5e-3);  // tolerance: four standard errors of the counts
  EXPECT_NEAR(p[0] + p[1] + p[2], 1.0, 1e-15);
}

TEST(CategoryProbability, OneExactValueKeepsTheUncertaintyOfTheOther) {
  EXPECT_NEAR(categoryProbability({{0.36, 0.05}, {0.2, 0.0}}, kSpreadLimits)[0], 0.5,
              1e-9);  // Closed form: the mean is on the edge.
}

TEST(CategoryProbability, InvalidInputsAreRejected) {
  EXPECT_REFUSED(categoryProbability({{0.0, -0.1}, {}}, kSpreadLimits), std::invalid_argument,
                 "drawbar_pull_over_load_std = -0.1, must be >= 0");
  EXPECT_REFUSED(categoryProbability({{}, {std::nan(""), 0.0}}, kSpreadLimits), std::invalid_argument,
                 "sinkage_over_radius = nan, must be finite");
}

double eq321(double torque, double sinkage) {
  return torque - sinkage - 0.1;
}

const CategoryThresholds kFig312{.dp_low = std::tan(0.17453292519943295),
                                 .dp_high = std::tan(0.17453292519943295),
                                 .z_threshold = 0.5,
                                 .z_critical = 0.5};

TEST(TraversabilityPlane, CategoriesMatchThesisFigure312) {
  for (double torque = 0.0125; torque < 1.0; torque += 0.025)
    for (double sinkage = 0.025; sinkage < 1.0; sinkage += 0.05) {
      // Printed in: thesis Fig. 3.12, one line of DP/W = tan 10 deg and one of z/r = 0.5.
      const bool pulls = torque - sinkage - 0.1 > kFig312.dp_high;
      EXPECT_EQ(categorise({.drawbar_pull_over_load = eq321(torque, sinkage), .sinkage_over_radius = sinkage},
                           kFig312),
                pulls && sinkage < 0.5 ? Category::Safe : Category::Dangerous);
    }
}

TEST(TraversabilityPlane, ThesisExampleSoilsAreDangerousByEquation321) {
  // Printed in: thesis 3.5, pairs (0.1, 0.2) "dangerous" and (0.3, 0.4) "safe". Eq. 3.21 gives -0.2 for both;
  // the second pair cannot be reproduced.
  for (const auto& [torque, sinkage] : {std::pair{0.1, 0.2}, {0.3, 0.4}})
    EXPECT_EQ(categorise({.drawbar_pull_over_load = eq321(torque, sinkage), .sinkage_over_radius = sinkage},
                         kFig312),
              Category::Dangerous);
}

}  // namespace category_test
}  // namespace talus::terramech
