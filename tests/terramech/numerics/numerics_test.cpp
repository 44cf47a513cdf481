#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include <talus/terramech/numerics/functions.hpp>
#include <talus/terramech/numerics/gauss_legendre.hpp>
#include <talus/terramech/numerics/lane_math.hpp>

namespace talus::terramech {
namespace numerics_test {

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

template <std::size_t N>
double integralOfPower(int power) {
  constexpr auto rule = gaussLegendre<N>();
  double sum = 0.0;
  for (std::size_t k = 0; k < N; ++k) sum += rule.weight[k] * std::pow(rule.node[k], power);
  return sum;
}

TEST(GaussLegendre, IsExactForPolynomialsOfItsDegree) {
  for (int power = 0; power <= 15; ++power)
    EXPECT_NEAR(integralOfPower<8>(power), 1.0 / (power + 1), 1e-15);  // Closed form.
  EXPECT_GT(std::abs(integralOfPower<8>(16) - 1.0 / 17.0), 1e-13);
  EXPECT_NEAR(integralOfPower<24>(40), 1.0 / 41.0, 1e-15);
}

TEST(GaussLegendre, NodesAreSortedWithinTheIntervalAndWeightsSumToOne) {
  constexpr auto rule = gaussLegendre<24>();
  EXPECT_GT(rule.node.front(), 0.0);
  EXPECT_LT(rule.node.back(), 1.0);
  EXPECT_TRUE(std::is_sorted(rule.node.begin(), rule.node.end()));
  EXPECT_NEAR(std::accumulate(rule.weight.begin(), rule.weight.end(), 0.0), 1.0, 1e-15);
}

class Random {
 public:
  double between(double low, double high) {
    return std::uniform_real_distribution<double>{low, high}(engine_);
  }

 private:
  std::mt19937_64 engine_{3};
};

TEST(LaneMath, MatchesTheStandardLibrary) {
  Random random;
  for (int k = 0; k < 20000; ++k) {
    const double x = random.between(-690.0, 300.0), angle = random.between(1e-6, 1.5707);
    EXPECT_NEAR(lanes::exponential(x) / std::exp(x), 1.0, 2e-12);
    EXPECT_NEAR(lanes::logarithm(std::exp(x)), x, 2e-12);
    EXPECT_NEAR(lanes::sine(angle) / std::sin(angle), 1.0, 3e-11);
    const double half = std::sin(0.5 * angle);
    EXPECT_NEAR(lanes::versine(angle) / (2.0 * half * half), 1.0, 4e-12);
  }
}

TEST(LaneMath, FourLanesAreBitIdenticalToOne) {
  Random random;
  for (int k = 0; k < 2000; ++k) {
    const lanes::Four x{random.between(-30.0, 1.5), random.between(0.01, 1.5), 1.0,
                        random.between(0.01, 1.5)};
    const lanes::Four e = lanes::exponential(x), s = lanes::sine(x);
    for (int lane = 0; lane < 4; ++lane) {  // Property: the same operations in the same order.
      EXPECT_EQ(e[lane], lanes::exponential(static_cast<double>(x[lane])));
      EXPECT_EQ(s[lane], lanes::sine(static_cast<double>(x[lane])));
    }
  }
}

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

}  // namespace numerics_test
}  // namespace talus::terramech
