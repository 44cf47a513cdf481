#include <cmath>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include <talus/terramech/numerics/functions.hpp>

namespace talus::terramech {

namespace functions_test {

std::string refusal(const std::function<void(const RangeCheck&)>& check) {
  try {
    check(RangeCheck{"rover 'A'"});
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Range, ErrorNamesOwnerFieldValueAndBound) {
  EXPECT_EQ(refusal([](auto& c) { c.atLeast("mass_kg", -0.5, 0.0); }),
            "rover 'A': mass_kg = -0.5, must be >= 0");
  EXPECT_EQ(refusal([](auto& c) { c.above("mass_kg", 0.0, 0.0); }), "rover 'A': mass_kg = 0, must be > 0");
  EXPECT_EQ(refusal([](auto& c) {
              c.within("slip", 1.5, {-1.0, 1.0});
            }),
            "rover 'A': slip = 1.5, must be in [-1, 1]");
}

TEST(Range, BoundsAreInclusiveExceptAbove) {
  EXPECT_EQ(refusal([](auto& c) { c.atLeast("x", 2.0, 2.0); }), "accepted");
  EXPECT_EQ(refusal([](auto& c) { c.within("x", -1.0, {-1.0, 1.0}); }), "accepted");
  EXPECT_EQ(refusal([](auto& c) { c.within("x", 1.0, {-1.0, 1.0}); }), "accepted");
  EXPECT_EQ(refusal([](auto& c) { c.above("x", 2.0 + 1e-15, 2.0); }), "accepted");
  EXPECT_NE(refusal([](auto& c) { c.within("x", -1.1, {-1.0, 1.0}); }), "accepted");
}

TEST(Range, NonFiniteValuesAreRejectedByEveryCheck) {
  for (const double value :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity()}) {
    EXPECT_THAT(refusal([&](auto& c) { c.finite("x", value); }), testing::EndsWith("must be finite"));
    EXPECT_THAT(refusal([&](auto& c) { c.atLeast("x", value, 0.0); }), testing::EndsWith("must be finite"));
    EXPECT_THAT(refusal([&](auto& c) { c.above("x", value, 0.0); }), testing::EndsWith("must be finite"));
    EXPECT_THAT(refusal([&](auto& c) {
                  c.within("x", value, {0.0, 1.0});
                }),
                testing::EndsWith("must be finite"));
  }
}

TEST(ScalarMinimum, FindsTheGlobalMinimum) {
  // Closed form: with u = ln x the slope is 0 where 6 sin(6 u) = (u - 1)/5.
  const auto f = [](double x) {
    const double u = std::log(x);
    return std::cos(6.0 * u) + 0.1 * (u - 1.0) * (u - 1.0);
  };
  const Minimum least = globalMinimum(f, 0.01, 100.0);
  const double u = std::log(least.at);
  EXPECT_NEAR(6.0 * std::sin(6.0 * u), (u - 1.0) / 5.0, 1e-5);
  // Property: no value of a fine scan is lower by more than rounding.
  for (double v = -4.6; v < 4.6; v += 1e-3) EXPECT_GE(f(std::exp(v)), least.value - 1e-12);
}

TEST(ScalarMinimum, FindsAMinimumAtAnIntervalEnd) {
  const Minimum least = globalMinimum([](double x) { return x; }, 2.0, 8.0);
  EXPECT_EQ(least.at, 2.0);
}

TEST(NaturalSpline, IsNaturalAndConstantOutside) {
  const std::vector<double> x{0.0, 1.0, 2.0}, y{0.0, 1.0, 0.0};
  // Closed form: natural cubic through (0,0), (1,1), (2,0) is 1.5 t - 0.5 t^3 on the first piece.
  const NaturalSpline spline{x, y};
  EXPECT_NEAR(spline(0.5), 1.5 * 0.5 - 0.5 * 0.125, 1e-12);
  EXPECT_EQ(spline(-3.0), 0.0);
  EXPECT_EQ(spline(9.0), 0.0);
}

// Closed form: a straight line is its own natural spline; one knot is a constant, none is 0.
TEST(NaturalSpline, ReproducesLinesAndAcceptsFewKnots) {
  const NaturalSpline line{{-2.0, 0.5, 1.0, 4.0}, {-3.0, 2.0, 3.0, 9.0}};
  for (const double x : {-2.0, -1.1, 0.7, 3.3}) EXPECT_NEAR(line(x), 2.0 * x + 1.0, 1e-12) << x;
  EXPECT_EQ(NaturalSpline({1.0}, {5.0})(7.0), 5.0);
  EXPECT_EQ(NaturalSpline()(7.0), 0.0);
}

TEST(NormalDistribution, QuantileInvertsTheDistribution) {
  // Property: quantile and probability are inverse to each other, from the far tail to the upper range.
  for (const double x : {-30.0, -8.0, -2.0, -0.3, 0.0, 0.7, 3.0, 6.0}) {
    const double p = normalProbability(x);
    // Above the median p is rounded to 1e-16.
    const double tolerance = 1e-10 + (x > 0.0 ? 1e-16 / normalDensity(x) : 0.0);
    EXPECT_NEAR(normalQuantile(p), x, tolerance);
  }
}

TEST(NormalDistribution, QuantileAt975PerMilleMatchesReferenceAndZeroIsRejected) {
  // Closed form: 1.959963984540054.
  EXPECT_NEAR(normalQuantile(0.975), 1.959963984540054, 1e-12);
  EXPECT_THROW((void)normalQuantile(0.0), std::invalid_argument);
}

TEST(EvenPoints, FillTheUnitCubeUniformly) {
  // Property: the mean of each coordinate of a Halton sequence is 1/2 to about log(n)/n.
  const auto points = evenPoints(5, 1024);
  for (int row = 0; row < 5; ++row) EXPECT_NEAR(points.row(row).mean(), 0.5, 0.01);
  EXPECT_GT(points.minCoeff(), 0.0);
  EXPECT_LT(points.maxCoeff(), 1.0);
}

}  // namespace functions_test

}  // namespace talus::terramech
